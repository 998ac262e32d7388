#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/load4.glsl"

// Reads records as the stages do: a few vec4 in a row an invocation, records side by side.
layout(local_size_x = 64) in;
layout(constant_id = 0) const uint RECORDS = 1;  // a power of two
layout(constant_id = 1) const int STRIDE = 1;    // vec4 a record
LOAD4_BUFFER(0, records);
STORE4_BUFFER(1, sums);

void main() {
  uint at = (gl_GlobalInvocationID.x & (RECORDS - 1u)) * uint(STRIDE);
  vec4 sum = vec4(0.0);
  for (int i = 0; i < STRIDE; ++i) sum += LOAD4(records, at + uint(i));
  // The records are zeros, which no compiler knows: nothing is stored, and all are read.
  if (sum != vec4(0.0)) STORE4(sums, 0, sum);
}
