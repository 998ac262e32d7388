#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/ways.h"
#include "shared/eikonal.h"
// A few rounds of fast sweeping (docs/ways.md); a work group solves a field. The cells of a diagonal do not depend
// on each other.
layout(local_size_x = WAY_GROUP) in;
layout(push_constant) uniform WayBlock { WayConstants way; };
layout(set = 0, binding = BINDING_WAY_COST, std430) readonly buffer CostBlock { float costs[]; };
layout(set = 0, binding = BINDING_WAY_TIME, std430) coherent buffer TimeBlock { float times[]; };
layout(set = 0, binding = BINDING_WAY_STATE, std430) buffer StateBlock { uint states[]; };

shared uint changed;

void update(int column, int row, int field) {
  int columns = int(way.columns), rows = int(way.rows);
  int cell = row * columns + column;
  float h = costs[cell];
  if ((h < 0.0) != (way.inside == 1u)) return;
  int at = field * columns * rows + cell;
  float left = column > 0 ? times[at - 1] : WAY_FAR, right = column + 1 < columns ? times[at + 1] : WAY_FAR;
  float below = row > 0 ? times[at - columns] : WAY_FAR, above = row + 1 < rows ? times[at + columns] : WAY_FAR;
  float time = eikonal(min(left, right), min(below, above), abs(h));
  // Beyond WAY_FAR, too, where nothing leads to.
  if (!(time < times[at])) return;
  times[at] = time;
  atomicOr(changed, 1u);
}

// From one corner, which the signs say, to the other.
void sweep(bool fromLast, bool fromTop, int field) {
  int columns = int(way.columns), rows = int(way.rows);
  for (int diagonal = 0; diagonal < columns + rows - 1; ++diagonal) {
    int last = min(diagonal, columns - 1);
    for (int i = max(0, diagonal - rows + 1) + int(gl_LocalInvocationIndex); i <= last; i += WAY_GROUP) {
      int j = diagonal - i;
      update(fromLast ? columns - 1 - i : i, fromTop ? rows - 1 - j : j, field);
    }
    memoryBarrierBuffer();
    barrier();
  }
}

void main() {
  int field = int(way.first + gl_WorkGroupID.x);
  // The same for the whole work group: its first invocation writes it only after the last round.
  bool goesOn = states[field] != 0u;
  barrier();
  for (int round = 0; round < WAY_ROUNDS && goesOn; ++round) {
    if (gl_LocalInvocationIndex == 0u) changed = 0u;
    memoryBarrierShared();
    barrier();
    for (int corner = 0; corner < 4; ++corner) sweep((corner & 1) != 0, (corner & 2) != 0, field);
    memoryBarrierShared();
    barrier();
    goesOn = changed != 0u;
    barrier();
  }
  if (gl_LocalInvocationIndex == 0u) states[field] = goesOn ? 1u : 0u;
}
