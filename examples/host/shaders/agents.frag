#version 460
#extension GL_GOOGLE_include_directive : require
#include "light.glsl"
layout(location = 0) in vec3 normal;
layout(location = 1) in vec3 colour;
layout(location = 2) in float away;
layout(location = 0) out vec4 picture;
void main() { picture = vec4(seen(lit(colour, normalize(normal)), away), 1.0); }
