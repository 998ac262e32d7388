#version 460
#extension GL_GOOGLE_include_directive : require
#include "render/bindings.h"
#include "render/splat.h"

layout(push_constant) uniform ConstantBlock { uint width, height; };
layout(set = 0, binding = DRAW_SPLAT_STATE, std430) readonly buffer State { uint state[]; };

// The rows of the canvas that have been drawn into: two triangles.
void main() {
  uint row = (gl_VertexIndex % 3 == 1) != (gl_VertexIndex > 2) ? state[STATE_BOTTOM] : height - state[STATE_TOP];
  bool right = gl_VertexIndex % 3 == 2 || gl_VertexIndex == 3;
  gl_Position = vec4(right ? 1.0 : -1.0, 1.0 - 2.0 * float(row) / float(height), 0.0, 1.0);
}
