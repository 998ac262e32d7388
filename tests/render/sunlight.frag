#version 460
#extension GL_GOOGLE_include_directive : require
// The sunlight at points of a line, by two comparisons and by one.
#include "render/picture.glsl"
#include "render/shadow.glsl"

layout(push_constant) uniform LineBlock { vec4 from, to, normal; };  // normal.w: texels off the surface
layout(location = 0) in float along;
layout(location = 0) out vec4 outColour;

void main() {
  vec3 p = mix(from.xyz, to.xyz, along);
  outColour = vec4(sunlight(p, normal.xyz, normal.w), sunlightOnce(p, normal.xyz, normal.w), 0.0, 0.0);
}
