#version 460
#extension GL_GOOGLE_include_directive : require
#include "stages/stage.glsl"
#include "lib/navigate.glsl"

LOAD4_BUFFER(BINDING_GOAL, goals);
STORE4_BUFFER(BINDING_GOAL_OUT, goalsOut);
STORE4_BUFFER(BINDING_STEER_OUT, steersOut);
LOAD4_BUFFER(BINDING_BODY, bodies);
LOAD4_BUFFER(BINDING_GAIT, gaits);
layout(constant_id = CONSTANT_SLEEP) const int SLEEP = SLEEP_NEVER;

// Nothing of it changes any more but by a goal or by the ground.
bool asleep(int agent, vec2 velocity) {
  vec4 gait = LOAD4(gaits, agent * GAIT_STRIDE), cycle = LOAD4(gaits, agent * GAIT_STRIDE + 1);
  float still = LOAD4(bodies, agent * BODY_STRIDE + 3).y;
  bool breathedOut = SLEEP != SLEEP_BREATHED_OUT || gait.x < parameters.dt / cycle.y;
  bool stands = gait.y == 0.0 && cycle.z == 0.0;
  return length(velocity) < 1e-2 * parameters.legLength && still >= constants.sleepTime && stands && breathedOut;
}

void main() {
  int agent = int(gl_GlobalInvocationID.x);
  if (agent >= int(constants.count)) return;
  vec4 ends = LOAD4(goals, agent * GOAL_STRIDE), manner = LOAD4(goals, agent * GOAL_STRIDE + 1);
  vec4 a = LOAD4(bodies, agent * BODY_STRIDE), b = LOAD4(bodies, agent * BODY_STRIDE + 1);
  vec4 swapped = ends;
  vec2 velocity = navigate(parameters, worldOf(a.xyz, b.xy), manner, swapped);
  // A loop, because an `if` would not skip the store on a device that masks lanes; few arrive in a tick.
  for (bool arrived = swapped != ends; arrived; arrived = false) STORE4(goalsOut, agent * GOAL_STRIDE, swapped);
  STORE4(steersOut, agent, vec4(velocity, SLEEP != SLEEP_NEVER && asleep(agent, velocity) ? 1.0 : 0.0, 0.0));
}
