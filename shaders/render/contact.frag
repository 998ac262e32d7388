#version 460
#extension GL_GOOGLE_include_directive : require
#include "render/bindings.h"

layout(location = 0) in vec2 fromMiddle;
layout(location = 1) in float share;
layout(location = 0) out vec4 outColour;
layout(constant_id = CONSTANT_ROOTS) const bool ROOTS = false;

// Blended over the ground, whose roots it dims by the root.
void main() {
  float inside = max(1.0 - dot(fromMiddle, fromMiddle), 0.0);
  float left = 1.0 - share * inside * inside;
  outColour = vec4(0.0, 0.0, 0.0, 1.0 - (ROOTS ? sqrt(left) : left));
}
