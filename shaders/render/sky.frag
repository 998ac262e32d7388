#version 460
#extension GL_GOOGLE_include_directive : require
#include "picture.glsl"
#include "light.glsl"

layout(location = 0) in vec3 direction;
layout(location = 0) out vec4 outColour;

void main() {
  vec3 d = normalize(direction);
  vec3 sun = picture.sun.xyz;
  outColour = vec4(developed(skyColour(d, sun) + sunDisc(d, sun)), 1.0);
}
