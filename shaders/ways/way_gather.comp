#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/ways.h"
// The times of a field as stage navigate looks them up: those of four cells in one vec4. Beside what is impassable they
// lead along it (docs/ways.md).
layout(local_size_x = WAY_GROUP) in;
layout(push_constant) uniform WayBlock { WayConstants way; };
layout(set = 0, binding = BINDING_WAY_COST, std430) readonly buffer CostBlock { float costs[]; };
layout(set = 0, binding = BINDING_WAY_TIME, std430) readonly buffer TimeBlock { float times[]; };
layout(set = 0, binding = BINDING_WAY_OUT, std430) writeonly buffer WayOutBlock { vec4 ways[]; };

// The time of cell i, which is impassable, as it seems beside the passable ones of the four.
float timeBeside(vec4 time, bvec4 passable, int i) {
  int x = i ^ 1, z = i ^ 2, across = i ^ 3;
  if (!passable[x] && !passable[z]) return time[across] + 2.0 * way.beside;
  float most = max(time[passable[x] ? x : z], time[passable[z] ? z : x]);
  if (passable[x] && passable[z] && passable[across]) most = max(most, time[x] + time[z] - time[across]);
  return most + way.beside;
}

void main() {
  int columns = int(way.columns), rows = int(way.rows), cells = columns * rows;
  int cell = int(way.from) + int(gl_GlobalInvocationID.x);
  if (cell >= cells) return;
  int column = cell % columns, row = cell / columns, first = int(way.first) * cells;
  int right = min(column + 1, columns - 1), above = min(row + 1, rows - 1);
  int at[4] = {row * columns + column, row * columns + right, above * columns + column, above * columns + right};
  vec4 time, seen;
  bvec4 passable;
  for (int i = 0; i < 4; ++i) {
    time[i] = times[first + at[i]];
    passable[i] = costs[at[i]] >= 0.0;
  }
  for (int i = 0; i < 4; ++i)
    seen[i] = way.beside > 0.0 && any(passable) && !passable[i] ? timeBeside(time, passable, i) : time[i];
  ways[WAY_TIMES + first + cell] = seen;
}
