#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "stages/awake.glsl"

LOAD4_BUFFER(BINDING_BODY, bodies);
LOAD4_BUFFER(BINDING_STEP, steps);
LOAD4_BUFFER(BINDING_ARC, arcs);
LOAD4_BUFFER(BINDING_MISS, misses);
LOAD4_BUFFER(BINDING_GAIT, gaits);
STORE4_BUFFER(BINDING_GAIT_OUT, gaitsOut);
layout(set = 0, binding = BINDING_LIST, std430) writeonly buffer ListBlock { uint list[]; };
layout(set = 0, binding = BINDING_COUNTERS, std430) buffer CountersBlock { uint counters[]; };
#include "stages/gait.glsl"

void main() {
  int agent = agentAt(int(gl_GlobalInvocationID.x));
  if (agent < 0) return;
  makeGait(agent, LOAD_BODY(agent));
}
