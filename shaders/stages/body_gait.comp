#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// body and gait of an agent in one go, which reads its legs' steps once; with NAVIGATES navigate too, which reads its
// body, where nobody may sleep.
#include "stages/awake.glsl"

#ifdef NAVIGATES
LOAD4_BUFFER(BINDING_GOAL, goals);
STORE4_BUFFER(BINDING_GOAL_OUT, goalsOut);
STORE4_BUFFER(BINDING_STEER_OUT, steersOut);
#include "stages/navigate.glsl"
#else
LOAD4_BUFFER(BINDING_STEER, steers);
#endif
LOAD4_BUFFER(BINDING_GAIT, gaits);
LOAD4_BUFFER(BINDING_STEP, steps);
LOAD4_BUFFER(BINDING_ARC, arcs);
LOAD4_BUFFER(BINDING_MISS, misses);
LOAD4_BUFFER(BINDING_BODY, bodies);
STORE4_BUFFER(BINDING_BODY_OUT, bodiesOut);
STORE4_BUFFER(BINDING_GAIT_OUT, gaitsOut);
layout(set = 0, binding = BINDING_LIST, std430) writeonly buffer ListBlock { uint list[]; };
layout(set = 0, binding = BINDING_COUNTERS, std430) buffer CountersBlock { uint counters[]; };
#include "stages/body.glsl"
#include "stages/gait.glsl"

void main() {
  int agent = agentAt(int(gl_GlobalInvocationID.x));
  if (agent < 0) return;
  Body body = LOAD_BODY(agent);
#ifdef NAVIGATES
  vec4 steer = vec4(makeVelocity(agent, worldOf(body.local, body.tile)), 0.0, 0.0);
  STORE4(steersOut, agent, steer);
#else
  vec4 steer = LOAD4(steers, agent);
#endif
  makeGait(agent, makeBody(agent, body, steer));
}
