#version 460
#extension GL_GOOGLE_include_directive : require
#include "picture.glsl"
#include "light.glsl"
#include "hash.glsl"
#include "terrain.glsl"
#include "shadow.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 nearAt;
layout(location = 2) in vec3 farAt;
layout(location = 3) in vec4 groundHere;
layout(location = 4) in float broadHere;
layout(location = 0) out vec4 outColour;
// The host knows of each patch what it needs of them (render/terrain.cpp): a software device pays for detail
// that fades to nothing as for any other.
layout(constant_id = CONSTANT_DETAIL) const int DETAIL = 2;
const bool CLODS = DETAIL > 0, GRAINS = DETAIL > 1;
layout(constant_id = CONSTANT_SHADED) const bool SHADED = true;

// A flat dome that stays inside its cell.
struct Pebble {
  float on, beside;  // shares
  vec2 fromCentre;   // in radii
  float lightness;
};

// There is one in some cells, and none on a steep slope.
Pebble pebbleAt(vec2 metres, float slope, float footprint) {
  const float CELL = 0.31;
  vec2 cell = floor(metres / CELL), inCell = metres / CELL - cell;
  uint h = hashed(uvec2(ivec2(cell)) + 77u);
  float radius = 0.035 + 0.12 * unitOf(h * 0x85EBCA77u) * unitOf(h * 0x85EBCA77u);
  radius *= 1.0 - smoothstep(0.08, 0.28, slope);
  vec2 centre = vec2(unitOf(h), unitOf(h * 0x9E3779B1u)) * (1.0 - 2.0 * radius) + radius;
  vec2 fromCentre = (inCell - centre) / max(radius, 1e-3);
  float reach = dot(fromCentre, fromCentre);
  float stone = (unitOf(h * 0xC2B2AE3Du) < 0.55 ? 1.0 : 0.0) * visible(radius * CELL, footprint);
  float on = stone * clamp((1.0 - reach) * 8.0, 0.0, 1.0);
  return Pebble(on, stone * clamp(1.45 - reach, 0.0, 1.0) * (1.0 - on), fromCentre,
                0.55 + 0.7 * unitOf(h * 0x27D4EB2Fu));
}

void main() {
  vec3 toEye = picture.eye.xyz - position;
  float away = length(toEye);
  toEye /= away;
  vec3 sun = picture.sun.xyz;

  vec2 metres = position.xz - picture.ground.xy;
  vec4 ground = groundHere;
  if (!DENSE) ground = groundMapAt(metres / picture.ground.zw);
  vec2 gradient = ground.xy;
  float slope = dot(gradient, gradient);
  vec3 smoothNormal = normalize(vec3(-gradient.x, 1.0, -gradient.y));
  float footprint = away * picture.eye.w * inversesqrt(max(dot(toEye, smoothNormal), 0.02));

  vec3 place = noisePlace(position);
  float broad = broadHere;
  if (!DENSE) broad = broadNoise(place);
  vec4 clumps = noise(place.yzx * (1.0 / 1.7) + 31.7) * visible(1.7, footprint);
  // Each is bent by the one before, so that no lattice shows.
  vec4 clods = vec4(0.0), grains = vec4(0.0);
  if (CLODS) clods = noise(place * (1.0 / 0.31) + 0.4 * clumps.yzw) * visible(0.31, footprint);
  if (GRAINS) grains = noise(place.yzx * (1.0 / 0.062) + 0.4 * clods.yzw) * visible(0.062, footprint);
  Pebble pebble = Pebble(0.0, 0.0, vec2(0.0), 0.0);
  if (GRAINS) pebble = pebbleAt(metres, slope, footprint);

  float dryness = clamp(0.5 + 0.64 * broad + 0.40 * clumps.x - 0.6 * slope, 0.0, 1.0);
  float rock = smoothstep(0.25, 0.75, slope + 0.14 * clumps.x + 0.09 * clods.x);
  vec3 soil = mix(vec3(0.175, 0.118, 0.070), vec3(0.340, 0.245, 0.150), dryness);
  soil = mix(soil, vec3(0.150, 0.150, 0.062), 0.55 * smoothstep(0.1, 0.8, 1.16 * clumps.x - 1.04 * broad));
  vec3 albedo = mix(soil, vec3(0.275, 0.245, 0.215), rock);
  if (GRAINS) albedo = mix(albedo, vec3(0.24, 0.205, 0.165) * pebble.lightness, pebble.on);
  albedo *= 1.0 + 0.11 * clods.x + 0.15 * grains.x + 0.12 * clumps.x;

  vec3 bump = (0.08 * clumps.wyz + 0.11 * clods.yzw + 0.18 * grains.wyz) * NOISE_AXES;
  bump *= 1.0 - 0.45 * rock;  // where the sun goes along a wall it would look pitted
  if (GRAINS) bump = mix(bump, vec3(-1.1, 0.0, -1.1) * pebble.fromCentre.xxy, pebble.on);
  vec3 normal = normalize(smoothNormal * (1.0 + dot(smoothNormal, bump)) - bump);
  float openness = ground.z * (1.0 - 0.45 * pebble.beside) * (1.0 + 0.12 * clods.x);

  // Who takes the sunlight away takes some of the sky with it, so that feet are tied to ground that faces
  // away from the sun as well.
  float open = SHADED ? sunlightAt(position, nearAt, farAt) : 1.0;
  float lit = ground.w * open;
  openness *= 0.62 + 0.38 * open;
  vec3 light = albedo * (SUN_LIGHT * (max(dot(normal, sun), 0.0) * lit) + ambientLight(normal) * openness);
  outColour = vec4(developed(hazed(light, -toEye, away, picture.tile.w, sun)), 1.0);
}
