#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/load4.glsl"

layout(local_size_x = 64) in;
layout(constant_id = 0) const int scale = 1;
layout(push_constant) uniform Push {
  uint count;
  float offset;
} push;

LOAD4_BUFFER(0, source)
STORE4_BUFFER(1, target)

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= push.count) return;
  STORE4(target, i, LOAD4(source, i) * float(scale) + vec4(push.offset));
}
