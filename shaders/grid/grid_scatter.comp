#version 460
#extension GL_GOOGLE_include_directive : require
#include "grid/grid.glsl"

LOAD4_BUFFER(BINDING_BODY, bodies);
LOAD4_BUFFER(BINDING_GRID_CELL, cells);
layout(set = 0, binding = BINDING_GRID_COUNT, std430) buffer CountBlock { uint counts[]; };
STORE4_BUFFER(BINDING_GRID_PLACE_OUT, placesOut);
STORE4_BUFFER(BINDING_GRID_WALKER_OUT, walkersOut);

void main() {
  uint agent = gl_GlobalInvocationID.x;
  if (agent >= grid.count) return;
  vec4 moving = LOAD4(bodies, agent * uint(BODY_STRIDE) + 1u);
  if (moving.w != 0.0) return;
  vec2 place = placeOf(LOAD4(bodies, agent * uint(BODY_STRIDE)));
  uint bucket = bucketOf(place), number = grid.first + agent;
  // Counts down again: the next tick begins with empty buckets.
  uint others = atomicAdd(counts[bucket], 0xFFFFFFFFu) - GRID_EMPTY - 1u;
  vec4 cell = LOAD4(cells, bucket);
  uint walker = uint(cell.z) + others;
  STORE4(placesOut, number, vec4(float(walker), float(bucket), cell.w, 0.0));
  STORE4(walkersOut, walker, vec4(place, grid.radius, float(number)));
  STORE4(walkersOut, uint(cell.w) + walker, vec4(moving.xy * moving.z, grid.avoids, 0.0));
}
