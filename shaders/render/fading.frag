#version 460
#extension GL_GOOGLE_include_directive : require
// What is left of an agent, or of its shadow, that goes over to splats.
#include "fade.glsl"

layout(location = FADE_LOCATION) flat in uint fade;
#ifndef SHADOW
layout(location = 0) in vec3 colour;
layout(location = 0) out vec4 outColour;
#endif

void main() {
  if (isFaded(uvec2(gl_FragCoord.xy), fade)) discard;
#ifndef SHADOW
  outColour = vec4(colour, 1.0);
#endif
}
