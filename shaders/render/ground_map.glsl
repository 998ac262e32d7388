#ifndef GROUND_MAP_GLSL
#define GROUND_MAP_GLSL
// What varies slowly along the ground: looked up and computed at each pixel, or at the vertices of dense patches alone.
#include "fold.glsl"
#include "noise.glsl"

layout(set = 0, binding = DRAW_GROUND) uniform sampler2D groundMap;
// Whether pixels get it from the vertices, which are dense enough for both (render/terrain.cpp).
layout(constant_id = CONSTANT_DENSE) const bool DENSE = false;

// Gradient, openness to the sky, and the share of sunlight that hills leave.
vec4 groundMapAt(vec2 at) {
  vec2 size = vec2(textureSize(groundMap, 0));
  Folded folded = foldedAt(at, size - 1.0);
  vec4 ground = textureLod(groundMap, (folded.at + 0.5) / size, 0.0);
  // A mirror image's hills cast their shadows the wrong way.
  return vec4(ground.xy * folded.way, ground.z, mix(ground.w, 1.0, folded.beyond));
}

vec3 noisePlace(vec3 position) {
  return NOISE_AXES * vec3(position.x - picture.ground.x, position.y, position.z - picture.ground.y);
}

float broadNoise(vec3 position) { return noise(noisePlace(position) * (1.0 / 9.7)).x; }

#endif
