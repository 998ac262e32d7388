#version 460
#extension GL_GOOGLE_include_directive : require
#include "picture.glsl"
#include "light.glsl"
#include "hash.glsl"

layout(location = 0) in vec3 direction;
layout(location = 0) out vec4 outColour;

layout(constant_id = CONSTANT_STARS) const bool STARS = false;

// In some cells of a cube about the eye; fewer near the horizon, where the air is thick.
vec3 starsIn(vec3 d) {
  const float CELLS = 90.0;  // along a face's half
  vec3 size = abs(d);
  float largest = max(size.x, max(size.y, size.z));
  vec3 on = d / largest;
  bool isX = size.x == largest, isY = !isX && size.y == largest;
  vec2 face = CELLS * (isX ? on.yz : isY ? on.xz : on.xy);
  uint side = (isX ? 0u : isY ? 2u : 4u) + ((isX ? on.x : isY ? on.y : on.z) > 0.0 ? 1u : 0u);
  vec2 cell = floor(face), within = face - cell - 0.5;
  uint h = hashed(uvec2(ivec2(cell) + 1024) + 4099u * side);
  vec2 place = 0.6 * vec2(unitOf(h * 0x9E3779B1u), unitOf(h * 0x85EBCA77u)) - 0.3;
  float bright = unitOf(h * 0xC2B2AE3Du);
  bright = unitOf(h) < 0.13 ? 0.08 + bright * bright * bright * bright : 0.0;
  // At least a pixel wide, or it would twinkle as the camera turns.
  float radius = max(0.07, CELLS * picture.eye.w * 1.2);
  float shape = max(1.0 - dot(within - place, within - place) / (radius * radius), 0.0);
  vec3 tint = mix(vec3(1.0, 0.86, 0.72), vec3(0.80, 0.90, 1.1), unitOf(h * 0x27D4EB2Fu));
  return tint * (1.6 * bright * shape * shape * smoothstep(0.02, 0.30, d.y));
}

void main() {
  vec3 d = normalize(direction);
  vec3 sun = picture.sun.xyz;
  vec3 light = skyColour(d, sun) + sunDisc(d, sun);
  if (STARS) light += starsIn(d);
  outColour = vec4(developed(light), 1.0);
}
