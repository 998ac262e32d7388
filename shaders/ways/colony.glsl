// The kernels of the colony begin with this (docs/colony.md).
#include "lib/colony.glsl"

layout(push_constant) uniform ColonyBlock { ColonyConstants colony; };
layout(constant_id = CONSTANT_RULE) const uint RULE = COLONY_MMAS;

layout(set = 0, binding = COLONY_GROUND, std430) readonly buffer GroundBlock { uint grounds[]; };

bool isOnMap(ivec2 at) {
  return all(greaterThanEqual(at, ivec2(0))) && at.x < int(colony.columns) && at.y < int(colony.rows);
}
ivec2 placeOf(uint cell) { return ivec2(cell % colony.columns, cell / colony.columns); }
uint cellOf(ivec2 at) { return uint(at.y) * colony.columns + uint(at.x); }
