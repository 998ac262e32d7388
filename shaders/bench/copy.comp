#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/load4.glsl"

// Reads and writes a vec4 an invocation, as the stages do.
layout(local_size_x = 64) in;
layout(push_constant) uniform Block { uint count; };
LOAD4_BUFFER(0, from);
STORE4_BUFFER(1, to);

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i < count) STORE4(to, i, LOAD4(from, i));
}
