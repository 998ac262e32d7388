#version 460
#extension GL_GOOGLE_include_directive : require
#include "grid/grid.glsl"

LOAD4_BUFFER(BINDING_GRID_COUNTED, counts);
layout(set = 0, binding = BINDING_GRID_SUM_OUT, std430) writeonly buffer SumBlock { float sums[]; };

void main() {
  uint run = gl_GlobalInvocationID.x;
  if (run >= grid.count) return;
  uint fours = grid.run / 4u;
  vec4 sum = vec4(0.0);
  for (uint i = 0u; i < fours; ++i) sum += LOAD4(counts, run * fours + i) - GRID_EMPTY_NUMBER;
  sums[run] = sum.x + sum.y + (sum.z + sum.w);
}
