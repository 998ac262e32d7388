#version 460
#extension GL_GOOGLE_include_directive : require
#include "grid/grid.glsl"
#include "lib/cells.glsl"
#include "lib/rarely.glsl"
#include "lib/sum64.glsl"

LOAD4_BUFFER(BINDING_GRID_CELL, cells);
LOAD4_BUFFER(BINDING_GRID_WALKER, walkers);
layout(set = 0, binding = BINDING_GRID_CROWDING, std430) buffer CrowdingBlock { uint crowding[]; };

// How far an agent overlaps those of higher numbers: each pair counts once.
void main() {
  int walker = int(gl_GlobalInvocationID.x);
  if (walker >= int(LOAD4(cells, 0).w)) return;
  vec4 self = LOAD4(walkers, walker);
  Runs runs = LOAD_RUNS(int(bucketOf(self.xy)), int(grid.row), int(grid.buckets));
  uint sum = 0u, most = 0u, pairs = 0u;
  for (int i = 0; i < runs.count; ++i) {
    vec4 other = LOAD4(walkers, walkerIn(runs, i));
    int x = abs(int(other.x - self.x)), z = abs(int(other.y - self.y)), radii = int(other.z + self.z);
    // Where x or z is beyond reach, the square may be beyond an int.
    bool overlaps = other.w > self.w && max(x, z) < radii && x * x + z * z < radii * radii;
    float share = (float(radii) - sqrt(float(overlaps ? x * x + z * z : 0))) / (2.0 * min(self.z, other.z));
    uint shares = overlaps ? uint(share * CROWDING_SHARES + 0.5) : 0u;
    sum += shares;
    most = max(most, shares);
    pairs += overlaps ? 1u : 0u;
  }
  RARELY(pairs > 0u) {
    ADD64(crowding, CROWDING_OVERLAP, sum);
    ADD64(crowding, CROWDING_PAIRS, pairs);
    atomicMax(crowding[CROWDING_MOST], most);
  }
}
