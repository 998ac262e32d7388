#version 460
#extension GL_GOOGLE_include_directive : require
#include "picture.glsl"
#include "light.glsl"
#include "shadow_map.glsl"
#include "chitin.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 wornNormal;
layout(location = 2) in vec4 colour;
layout(location = 3) in float hillSun;
layout(location = 0) out vec4 outColour;

void main() {
  vec3 toEye = picture.eye.xyz - position;
  float away = length(toEye);
  vec3 normal = normalize(wornNormal);
  float lit = hillSun * sunlightOnce(position, normal, 3.0);
  outColour = vec4(chitin(colour, normal, toEye / away, away, lit, 1.0, 0.10), 1.0);
}
