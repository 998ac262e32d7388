#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "stages/awake.glsl"

LOAD4_BUFFER(BINDING_STEER, steers);
#ifndef BLIND
LOAD4_BUFFER(BINDING_GAIT, gaits);
LOAD4_BUFFER(BINDING_STEP, steps);
LOAD4_BUFFER(BINDING_MISS, misses);
#endif
LOAD4_BUFFER(BINDING_BODY, bodies);
STORE4_BUFFER(BINDING_BODY_OUT, bodiesOut);
#include "stages/body.glsl"

void main() {
  int agent = agentAt(int(gl_GlobalInvocationID.x));
  if (agent >= 0) makeBody(agent, LOAD_BODY(agent), LOAD4(steers, agent));
}
