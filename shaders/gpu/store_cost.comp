#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/load4.glsl"

// Writes records as the stages do: two vec4 in a row an invocation, records side by side.
layout(local_size_x = 64) in;
STORE4_BUFFER(0, records);

void main() {
  float id = float(gl_GlobalInvocationID.x);
  vec4 a = vec4(id, id + 1.0, id + 2.0, id + 3.0);
  STORE4_TWO(records, 2 * gl_GlobalInvocationID.x, a, a * 0.5);
}
