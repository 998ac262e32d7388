#version 460
#extension GL_GOOGLE_include_directive : require
#include "grid/grid.glsl"

LOAD4_BUFFER(BINDING_BODY, bodies);
layout(set = 0, binding = BINDING_GRID_COUNT, std430) buffer CountBlock { uint counts[]; };

void main() {
  uint agent = gl_GlobalInvocationID.x;
  if (agent >= grid.count || LOAD4(bodies, agent * uint(BODY_STRIDE) + 1u).w != 0.0) return;
  atomicAdd(counts[bucketOf(placeOf(LOAD4(bodies, agent * uint(BODY_STRIDE))))], 1u);
}
