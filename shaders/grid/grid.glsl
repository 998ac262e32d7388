// The kernels of the grid begin with this (docs/stages/avoid.md).
#include "lib/load4.glsl"
#include "shared/bindings.h"
#include "shared/grid.h"
#include "skitter/records.h"

layout(local_size_x = WORK_GROUP) in;
layout(push_constant) uniform GridBlock { GridConstants grid; };

// A body's place, whole numbers of quanta.
vec2 placeOf(vec4 body) {
  vec2 tile = vec2(tileX(body.w), tileZ(body.w));
  return tile * (TILE_SIZE * grid.quanta) + floor(body.xz * grid.quanta);
}

uint bucketOf(vec2 place) {
  vec2 cell = floor(place * grid.cells);
  return uint(int(cell.x) + int(grid.row) * int(cell.y)) & (grid.buckets - 1u);
}
