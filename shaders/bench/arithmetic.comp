#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "lib/load4.glsl"

// Multiplications and additions in chains that do not wait for each other: as many as keep a pipeline full, and no
// more than have room in sixteen registers.
layout(local_size_x = 64) in;
// Not a push constant: lavapipe inlines what a loop's length depends on, and rebuilds the kernel in every dispatch.
layout(constant_id = 0) const int ROUNDS = 1;
STORE4_BUFFER(0, sums);

void main() {
  float scale = 0.999, more = 1e-3 + float(gl_LocalInvocationID.x) * 1e-6;
  vec4 a = vec4(1.0, 2.0, 3.0, 4.0) * more, b = a + 1.0, c = b + 1.0;
  for (int i = 0; i < ROUNDS; ++i) {
    // What a loop carries goes through memory at each turn where lanes are masked.
    [[unroll]] for (int k = 0; k < 64; ++k) {
      a = a * scale + more;
      b = b * scale + more;
      c = c * scale + more;
    }
  }
  // The maximum keeps lavapipe's compiler from moving the chains into the loop that stores lane by lane.
  STORE4(sums, gl_GlobalInvocationID.x, max(a + b + c, vec4(-3e38)));
}
