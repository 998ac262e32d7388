#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/ways.h"
// The times of a field as stage navigate looks them up: those of four cells in one vec4.
layout(local_size_x = WAY_GROUP) in;
layout(push_constant) uniform WayBlock { WayConstants way; };
layout(set = 0, binding = BINDING_WAY_TIME, std430) readonly buffer TimeBlock { float times[]; };
layout(set = 0, binding = BINDING_WAY_OUT, std430) writeonly buffer WayOutBlock { vec4 ways[]; };

void main() {
  int columns = int(way.columns), rows = int(way.rows), cells = columns * rows;
  int cell = int(way.from) + int(gl_GlobalInvocationID.x);
  if (cell >= cells) return;
  int column = cell % columns, row = cell / columns, first = int(way.first) * cells;
  int right = min(column + 1, columns - 1), above = min(row + 1, rows - 1);
  ways[WAY_TIMES + first + cell] =
      vec4(times[first + row * columns + column], times[first + row * columns + right],
           times[first + above * columns + column], times[first + above * columns + right]);
}
