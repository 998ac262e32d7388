#ifndef SWING_STAGE_GLSL
#define SWING_STAGE_GLSL
// Stage swing, for entry points that make it alone or together with ik; they declare its bindings.
#include "lib/hermite.glsl"
#include "stages/hurt.glsl"

vec4 makeFoot(int agent, int record) {
#ifdef HURT
  if (!carries(agent, legOfRecord(record, LEGS))) return vec4(0.0);  // it has no target
#endif
  Step s = LOAD_STEP(record);
  vec4 body = LOAD4(bodies, agent * BODY_STRIDE);
  vec3 local = body.xyz;
  vec2 tile = tileOf(body.w);
  float u = stepProgress(s, thisTick);
  Swing flight = swingOf(s, LOAD_ARC(record), local, tile);
  return vec4(u >= 1.0 ? flight.p1 : swingPoint(flight, easedTime(u, startRate(flight))), u);
}

#endif
