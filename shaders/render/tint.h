// How agents differ in colour: numbers that GLSL and C++ share.
#ifndef SKITTER_RENDER_TINT_H
#define SKITTER_RENDER_TINT_H

#ifdef __cplusplus
namespace skitter::shared {
#define TINT inline constexpr
#else
#define TINT const
#endif

// The last number of an agent's tint, bit by bit; its first three multiply the model's colour.
TINT int TINT_LIGHTNESS = 1;  // of which only the lightness is left
TINT int TINT_VARIED = 2;     // and which does not vary by the agent's number

// Agents vary by number from the least value on, and in warmth to both sides.
TINT float LEAST_VALUE = 0.75f;
TINT float VALUE_RANGE = 0.6f;
TINT float WARMTH_RANGE = 0.35f;

// Rec. 709.
TINT float RED_LIGHTNESS = 0.2126f;
TINT float GREEN_LIGHTNESS = 0.7152f;
TINT float BLUE_LIGHTNESS = 0.0722f;
#undef TINT

#ifdef __cplusplus
}  // namespace skitter::shared
#endif
#endif
