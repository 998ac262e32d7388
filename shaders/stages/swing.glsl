#ifndef SWING_STAGE_GLSL
#define SWING_STAGE_GLSL
// Stage swing, for entry points that make it alone or together with ik; they declare its bindings.
#include "lib/hermite.glsl"

vec4 makeFoot(int agent, int record) {
  int at = agent * BODY_STRIDE;
  Step s = LOAD_STEP(record);
  vec3 local = LOAD4(bodies, at).xyz;
  vec2 tile = LOAD4(bodies, at + 1).xy;
  float u = stepProgress(s, thisTick);
  Swing flight = Swing(fromTile(s.liftOff, s.tile, local, tile), fromTile(s.landing, s.tile, local, tile), s.lift,
                       s.startTangent);
  return vec4(u >= 1.0 ? flight.p1 : swingPoint(flight, easedTime(u, startRate(flight))), u);
}

#endif
