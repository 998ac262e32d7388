#ifndef TERRAIN_GLSL
#define TERRAIN_GLSL
// The parts of the ground's look that vary slowly are computed at pixels, or at the vertices of dense patches alone.
#include "ground_map.glsl"
#include "noise.glsl"

// Whether vertices are dense enough for them (render/terrain.cpp).
layout(constant_id = CONSTANT_DENSE) const bool DENSE = false;

vec3 noisePlace(vec3 position) {
  return NOISE_AXES * vec3(position.x - picture.ground.x, position.y, position.z - picture.ground.y);
}

float broadNoise(vec3 place) { return noise(place * (1.0 / 9.7)).x; }

#endif
