#version 460
#extension GL_GOOGLE_include_directive : require
#include "stages/awake.glsl"
#include "lib/hermite.glsl"

LOAD4_BUFFER(BINDING_BODY, bodies);
LOAD4_BUFFER(BINDING_STEP, steps);
STORE4_BUFFER(BINDING_FOOT_OUT, feetOut);

void main() {
  int record = legAt(int(gl_GlobalInvocationID.x));
  if (record < 0) return;
  int agent = agentOfRecord(record, LEGS);
  int at = agent * BODY_STRIDE, stepAt = record * STEP_STRIDE;
  vec3 local = LOAD4(bodies, at).xyz;
  vec2 tile = LOAD4(bodies, at + 1).xy;
  Step s = unpackStep(LOAD4(steps, stepAt), LOAD4(steps, stepAt + 1), LOAD4(steps, stepAt + 2),
                      LOAD4(steps, stepAt + 3));
  float u = stepProgress(s, constants.tick);
  Swing flight = Swing(fromTile(s.liftOff, s.tile, local, tile), fromTile(s.landing, s.tile, local, tile), s.lift,
                       s.startTangent);
  STORE4(feetOut, record, vec4(u >= 1.0 ? flight.p1 : swingPoint(flight, easedTime(u, startRate(flight))), u));
}
