#version 460
#extension GL_GOOGLE_include_directive : require
// Pheromone evaporates (docs/foraging.md).
#include "shared/forage.h"
#include "skitter/records.h"

layout(local_size_x = WORK_GROUP) in;
layout(push_constant) uniform TrailConstantsBlock { TrailConstants trails; };
layout(set = 0, binding = BINDING_LAY_TRAIL, std430) buffer TrailBlock { uint trail[]; };

void main() {
  uint cell = gl_GlobalInvocationID.x;
  if (cell >= trails.count) return;
  uint grains = min(trail[uint(TRAIL_CELLS) + cell], MOST_GRAINS), gone, unused;
  umulExtended(grains, trails.evaporation, gone, unused);
  trail[uint(TRAIL_CELLS) + cell] = grains - min(grains, gone + 1u);
}
