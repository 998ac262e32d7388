#version 460
#extension GL_GOOGLE_include_directive : require
#include "picture.glsl"
#include "light.glsl"
#include "shadow.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 wornNormal;
layout(location = 2) in vec4 colour;
layout(location = 3) in float hillSun;
layout(location = 0) out vec4 outColour;

void main() {
  vec3 toEye = picture.eye.xyz - position;
  float away = length(toEye);
  toEye /= away;
  vec3 normal = normalize(wornNormal);
  vec3 sun = picture.sun.xyz;
  float facing = max(dot(normal, sun), 0.0);
  float lit = hillSun * sunlight(position, normal, 3.0);

  // A dull sheen of chitin, and a rim of skylight that parts dark creatures from dark ground.
  vec3 halfway = normalize(toEye + sun);
  float sheen = max(dot(normal, halfway), 0.0);
  sheen *= sheen; sheen *= sheen; sheen *= sheen; sheen *= sheen; sheen *= sheen;
  float rim = 1.0 - max(dot(normal, toEye), 0.0);
  rim *= rim * rim;
  vec3 ambient = ambientLight(normal) * colour.a;
  vec3 light = colour.rgb * (SUN_LIGHT * (facing * lit) + ambient) +
               SUN_LIGHT * (0.10 * sheen * lit * smoothstep(0.0, 0.15, facing)) +
               ambient * rim * 0.35;
  outColour = vec4(developed(hazed(light, -toEye, away, picture.tile.w, sun)), 1.0);
}
