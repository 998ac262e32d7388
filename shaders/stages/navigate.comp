#version 460
#extension GL_GOOGLE_include_directive : require
#ifdef LISTED
#include "stages/awake.glsl"
#else
#include "stages/stage.glsl"
layout(constant_id = CONSTANT_SLEEP) const int SLEEP = SLEEP_NEVER;
#endif

LOAD4_BUFFER(BINDING_GOAL, goals);
STORE4_BUFFER(BINDING_GOAL_OUT, goalsOut);
STORE4_BUFFER(BINDING_STEER_OUT, steersOut);
LOAD4_BUFFER(BINDING_BODY, bodies);
LOAD4_BUFFER(BINDING_GAIT, gaits);
#ifdef WAYS
#include "shared/ways.h"
LOAD4_BUFFER(BINDING_WAY, ways);
#endif
#ifdef FORAGES
LOAD4_BUFFER(BINDING_FORAGER, foragers);
STORE4_BUFFER(BINDING_FORAGER_OUT, foragersOut);
layout(set = 0, binding = BINDING_FORAGE_GROUND, std430) readonly buffer GroundBlock { uint grounds[]; };
layout(set = 0, binding = BINDING_TRAIL, std430) readonly buffer TrailBlock { uint trail[]; };
#include "stages/forage.glsl"
#endif
#include "stages/navigate.glsl"
#include "stages/absent.glsl"

// Nothing of it changes any more but by a goal or by the ground.
bool asleep(int agent, vec2 velocity) {
  vec4 gait = LOAD4(gaits, agent * GAIT_STRIDE), cycle = LOAD4(gaits, agent * GAIT_STRIDE + 1);
  float still = LOAD4(bodies, agent * BODY_STRIDE + 3).y;
  bool breathedOut = SLEEP != SLEEP_BREATHED_OUT || gait.x < float(constants.every) * parameters.dt / cycle.y;
  bool stands = gait.y == 0.0 && cycle.z == 0.0;
  return length(velocity) < 1e-2 * parameters.legLength && still >= constants.sleepTime && stands && breathedOut;
}

void main() {
#ifdef LISTED
  int agent = agentAt(int(gl_GlobalInvocationID.x));
  if (agent < 0) return;
#else
  int agent = int(gl_GlobalInvocationID.x);
  if (agent >= int(constants.count)) return;
#endif
  if (absent(agent)) {
    STORE4(steersOut, agent, vec4(0.0, 0.0, 1.0, 0.0));
#ifdef FORAGES
    STORE4_TWO(foragersOut, agent * FORAGER_STRIDE, vec4(0.0), vec4(0.0));
#endif
    return;
  }
  vec4 body = LOAD4(bodies, agent * BODY_STRIDE);
#ifdef FORAGES
  vec2 velocity = forage(agent, body);
#else
  vec2 velocity = makeVelocity(agent, worldOf(body.xyz, tileOf(body.w)));
#endif
  STORE4(steersOut, agent, vec4(velocity, SLEEP != SLEEP_NEVER && asleep(agent, velocity) ? 1.0 : 0.0, 0.0));
}
