#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/load4.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2D heights;
STORE4_BUFFER(1, target)

void main() {
  ivec2 size = textureSize(heights, 0);
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  for (int x = at.x; x < size.x; x += 8) {
    for (int y = at.y; y < size.y; y += 8) {
      STORE4(target, y * size.x + x, vec4(texelFetch(heights, ivec2(x, y), 0).x, x, y, 1));
    }
  }
}
