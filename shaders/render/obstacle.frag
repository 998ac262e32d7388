#version 460
#extension GL_GOOGLE_include_directive : require
#include "picture.glsl"
#include "light.glsl"
#include "noise.glsl"
#include "shadow.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 wornNormal;
layout(location = 2) in vec3 at;
layout(location = 3) in vec2 open;
layout(location = 0) out vec4 outColour;

// Hewn rock, paler than the ground's, with soil at its foot.
void main() {
  vec3 toEye = picture.eye.xyz - position;
  float away = length(toEye);
  toEye /= away;
  vec3 sun = picture.sun.xyz;
  vec3 smoothNormal = normalize(wornNormal);
  float footprint = away * picture.eye.w * inversesqrt(max(dot(toEye, smoothNormal), 0.02));

  vec2 metres = at.xy * picture.ground.zw;
  vec3 place = NOISE_AXES * vec3(metres.x, position.y, metres.y);
  vec4 clumps = noise(place * (1.0 / 1.3) + 11.3) * visible(1.3, footprint);
  vec4 clods = noise(place.zxy * (1.0 / 0.27) + 0.5 * clumps.yzw) * visible(0.27, footprint);
  vec4 grains = noise(place.yzx * (1.0 / 0.055) + 0.4 * clods.yzw) * visible(0.055, footprint);

  vec3 albedo = mix(vec3(0.300, 0.280, 0.255), vec3(0.430, 0.395, 0.345), 0.5 + 0.5 * clumps.x);
  albedo *= 1.0 + 0.16 * clods.x + 0.13 * grains.x;
  float above = max(at.z, 0.0);
  albedo = mix(vec3(0.210, 0.150, 0.095), albedo, smoothstep(0.0, 0.22, above + 0.07 * clods.x));

  vec3 bump = (0.10 * clumps.wyz + 0.16 * clods.yzw + 0.13 * grains.wyz) * NOISE_AXES;
  vec3 normal = normalize(smoothNormal * (1.0 + dot(smoothNormal, bump)) - bump);
  float lit = open.y * sunlight(position, smoothNormal, 3.0);
  float openness = open.x * mix(0.5, 1.0, smoothstep(0.0, 0.7, above)) * (1.0 + 0.12 * clods.x);
  vec3 light = albedo * (SUN_LIGHT * (max(dot(normal, sun), 0.0) * lit) + ambientLight(normal) * openness);
  outColour = vec4(developed(hazed(light, -toEye, away, picture.tile.w, sun)), 1.0);
}
