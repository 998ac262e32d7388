#ifndef GROUND_MAP_GLSL
#define GROUND_MAP_GLSL
#include "fold.glsl"

layout(set = 0, binding = DRAW_GROUND) uniform sampler2D groundMap;

// Gradient, openness to the sky, and the share of sunlight that hills leave, at a place among the height samples.
vec4 groundMapAt(vec2 at) {
  vec2 size = vec2(textureSize(groundMap, 0));
  Folded folded = foldedAt(at, size - 1.0);
  vec4 ground = textureLod(groundMap, (folded.at + 0.5) / size, 0.0);
  // A mirror image's hills cast their shadows the wrong way.
  return vec4(ground.xy * folded.way, ground.z, mix(ground.w, 1.0, folded.beyond));
}

#endif
