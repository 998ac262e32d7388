#version 460
#extension GL_GOOGLE_include_directive : require
#include "stages/stage.glsl"
#include "lib/navigate.glsl"

LOAD4_BUFFER(BINDING_GOAL, goals);
STORE4_BUFFER(BINDING_GOAL_OUT, goalsOut);
STORE4_BUFFER(BINDING_STEER_OUT, steersOut);
LOAD4_BUFFER(BINDING_BODY, bodies);

void main() {
  int agent = int(gl_GlobalInvocationID.x);
  if (agent >= int(constants.count)) return;
  vec4 ends = LOAD4(goals, agent * GOAL_STRIDE), manner = LOAD4(goals, agent * GOAL_STRIDE + 1);
  vec4 a = LOAD4(bodies, agent * BODY_STRIDE), b = LOAD4(bodies, agent * BODY_STRIDE + 1);
  vec2 velocity = navigate(parameters, worldOf(a.xyz, b.xy), manner, ends);
  STORE4(goalsOut, agent * GOAL_STRIDE, ends);
  STORE4(goalsOut, agent * GOAL_STRIDE + 1, manner);
  STORE4(steersOut, agent, vec4(velocity, 0.0, 0.0));
}
