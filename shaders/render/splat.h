// Agents that cover few pixels, drawn point by point: what C++ and the shaders of splats share.
#ifndef SKITTER_SPLAT_H
#define SKITTER_SPLAT_H

#ifdef __cplusplus
#include <cstdint>
namespace skitter::shared {
#define SKITTER_SPLAT_CONST inline constexpr int
using uint = uint32_t;
#else
#define SKITTER_SPLAT_CONST const int
#endif

// Sets of points of a kind, for agents of more and more pixels.
SKITTER_SPLAT_CONST SPLAT_LEVELS = 6;
// Invocations that share an agent's points.
SKITTER_SPLAT_CONST SPLAT_GROUP = 64;
// vec4 of a point: offset from its bone's rest start, bone; normal, 0, or the bone's direction, 1; colour.
SKITTER_SPLAT_CONST POINT_STRIDE = 3;
// vec4 of an agent that is splatted: body in picture space, number; its colour's factor, points' first place
// and, from SPLAT_COUNTS on, their number; sunlight, openness to the sky, what haze leaves, glow of the haze.
SKITTER_SPLAT_CONST SPLAT_STRIDE = 3;
SKITTER_SPLAT_CONST SPLAT_COUNTS = 4096;
// uint32 of the state: a VkDrawIndirectCommand that draws the canvas, and then
SKITTER_SPLAT_CONST STATE_BOTTOM = 4;  // the row below the lowest one that was drawn into
SKITTER_SPLAT_CONST STATE_TOP = 5;     // the picture's rows less the uppermost one
SKITTER_SPLAT_CONST STATE_POINTS = 6;
SKITTER_SPLAT_CONST STATE_WORDS = 8;

// A canvas pixel is a depth of 15 bits above a colour of 17: red 6, green 6, blue 5, as square roots. Depth is
// SPLAT_OCTAVES octaves of metres along the camera's axis, from 2^SPLAT_FIRST_OCTAVE on, nearer is greater.
SKITTER_SPLAT_CONST SPLAT_FIRST_OCTAVE = -4;
SKITTER_SPLAT_CONST SPLAT_OCTAVES = 20;
SKITTER_SPLAT_CONST SPLAT_DEPTHS = 32767;

// Push constants of splat_agents.
struct SplatAgentConstants {
  uint agents;      // of the page
  uint firstAgent;  // of the page among its kind's
  uint kind;
  uint width, height;           // of the picture
  float radius;                 // metres
  float pixels[SPLAT_LEVELS];   // the radius in pixels up to which each level serves
  uint first[SPLAT_LEVELS + 1];  // its points
};

// Push constants of splat_points.
struct SplatPointConstants {
  uint palette;        // pose entries an agent
  uint width, height;  // of the picture
  float nearer;        // metres by which points are nearer than they are
};

#ifdef __cplusplus
}  // namespace skitter::shared
#endif
#endif
