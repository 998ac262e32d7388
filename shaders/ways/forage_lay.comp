#version 460
#extension GL_GOOGLE_include_directive : require
// Each forager's deed in this tick goes into the trail (docs/foraging.md).
#include "lib/load4.glsl"
#include "lib/rarely.glsl"
#include "shared/forage.h"
#include "skitter/records.h"

layout(local_size_x = WORK_GROUP) in;
layout(push_constant) uniform TrailConstantsBlock { TrailConstants trails; };
LOAD4_BUFFER(BINDING_LAY_FORAGER, foragers);
#ifdef LEVELS
LOAD4_BUFFER(BINDING_LAY_RATE, rates);
#endif
layout(set = 0, binding = BINDING_LAY_TRAIL, std430) buffer TrailBlock { uint trail[]; };

void main() {
  uint agent = gl_GlobalInvocationID.x;
  if (agent >= trails.count) return;
#ifdef LEVELS
  // The deed of a tick that was not its own is that of an earlier one.
  if (LOAD4(rates, agent * uint(RATE_STRIDE)).z != trails.tick) return;
#endif
  vec4 deed = LOAD4(foragers, agent * uint(FORAGER_STRIDE) + 1u);
  RARELY(deed.x != 0.0) {
    if (deed.y != 0.0) atomicAdd(trail[TRAIL_CELLS + int(deed.x) - 1], uint(deed.y));
    if (deed.z != 0.0) atomicAdd(trail[int(deed.z)], 1u);
  }
}
