#version 460
#extension GL_GOOGLE_include_directive : require
#include "stages/awake.glsl"
#include "lib/loop.glsl"
#include "stages/hurt.glsl"

LOAD4_BUFFER(BINDING_RIG, rig);
LOAD4_BUFFER(BINDING_BODY, bodies);
LOAD4_BUFFER(BINDING_GAIT, gaits);
STORE4_BUFFER(BINDING_FOOT_OUT, feetOut);

void main() {
  int record = legAt(int(gl_GlobalInvocationID.x));
  if (record < 0) return;
  int agent = agentOfRecord(record, LEGS), leg = legOfRecord(record, LEGS);
  Body body = LOAD_BODY(agent);
  vec4 home = LOAD4(rig, leg * rigStride(BONES) + 1);
  vec4 gait = LOAD4(gaits, agent * GAIT_STRIDE);
  float cycle = LOAD4(gaits, agent * GAIT_STRIDE + 1).y;
  float groups = float(GROUPS);
#ifdef HURT
  Hurt hurt = hurtOf(agent);
  if (!carries(agent, leg)) {
    STORE4(feetOut, record, vec4(0.0));
    return;
  }
  vec4 own = HURT_LEG(agent, leg);
  home = vec4(home.xyz + hurt.shift, own.x);
  groups = hurt.groups;
  gait.w = slowTicks(gait.w, own.w);
#endif
  float speed = body.surfaceSpeed + abs(body.turnRate) * parameters.homeRadius;
  float lift = parameters.stepHeight * min(1.0, speed / (0.1 * parameters.legLength));
  LoopFoot foot = loopFoot(home.xyz, body.turnRate, body.surfaceSpeed, fract(gait.x + home.w / groups), cycle,
                           gait.w * parameters.dt, lift);
  STORE4(feetOut, record, vec4(rotate(body.orientation, foot.place), foot.u));
}
