#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "grid/grid.glsl"

LOAD4_BUFFER(BINDING_GRID_COUNTED, counts);
LOAD4_BUFFER(BINDING_GRID_SUM, sums);
STORE4_BUFFER(BINDING_GRID_CELL_OUT, cellsOut);

// Those of four buckets; numbers of fours wrap around the table's end.
vec4 agentsIn(uint four) { return LOAD4(counts, four & (grid.buckets / 4u - 1u)) - GRID_EMPTY_NUMBER; }

void main() {
  uint run = gl_GlobalInvocationID.x;
  if (run >= grid.count) return;
  // Agents in earlier runs, and in all.
  float place = 0.0, all = 0.0;
  for (uint i = 0u; i < grid.count / 4u; ++i) {
    vec4 sum = LOAD4(sums, i);
    vec4 earlier = mix(vec4(0.0), sum, lessThan(uvec4(4u * i) + uvec4(0u, 1u, 2u, 3u), uvec4(run)));
    place += earlier.x + earlier.y + (earlier.z + earlier.w);
    all += sum.x + sum.y + (sum.z + sum.w);
  }
  uint fours = grid.run / 4u, first = run * fours;
  vec2 before = agentsIn(first - 1u).zw;
  vec4 own = agentsIn(first);
  for (uint i = first; i < first + fours; ++i) {
    vec4 next = agentsIn(i + 1u);
    float row[8] = float[8](before.x, before.y, own.x, own.y, own.z, own.w, next.x, next.y);
    [[unroll]] for (int k = 0; k < 4; ++k) {
      float begin = place - row[k] - row[k + 1];
      STORE4(cellsOut, 4u * i + uint(k),
             vec4(begin < 0.0 ? begin + all : begin,
                  row[k] + row[k + 1] + (row[k + 2] + row[k + 3]) + row[k + 4], place, all));
      place += row[k + 2];
    }
    before = own.zw;
    own = next;
  }
}
