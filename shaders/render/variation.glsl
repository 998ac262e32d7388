#ifndef VARIATION_GLSL
#define VARIATION_GLSL
#include "hash.glsl"
#include "tint.h"

layout(constant_id = CONSTANT_TINTED) const bool TINTED = false;
LOAD4_BUFFER(DRAW_TINT, tints)

// No two agents are alike: a little lighter or darker, redder or greyer, and as their tints say.
struct Variation {
  vec3 times;
  bool lightness;  // of the model's colour only the lightness counts
};

// `agent` counts on the page, and `number` among the kind's agents.
Variation variationOf(uint agent, uint number, uint kind) {
  uint h = hashed(uvec2(number, kind));
  float value = LEAST_VALUE + VALUE_RANGE * unitOf(h), warmth = unitOf(h * 0x9E3779B1u) - 0.5;
  vec4 tint = vec4(1.0, 1.0, 1.0, 0.0);
  if (TINTED) tint = LOAD4(tints, int(agent));
  int flags = int(tint.w);
  if ((flags & TINT_VARIED) != 0) value = 1.0, warmth = 0.0;
  return Variation(tint.xyz * value * vec3(1.0 + WARMTH_RANGE * warmth, 1.0, 1.0 - WARMTH_RANGE * warmth),
                   (flags & TINT_LIGHTNESS) != 0);
}

vec3 varied(Variation variation, vec3 colour) {
  if (variation.lightness) colour = vec3(dot(colour, vec3(RED_LIGHTNESS, GREEN_LIGHTNESS, BLUE_LIGHTNESS)));
  return colour * variation.times;
}

#endif
