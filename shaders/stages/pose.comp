#version 460
#extension GL_GOOGLE_include_directive : require
#include "stages/awake.glsl"
#include "stages/hurt.glsl"

LOAD4_BUFFER(BINDING_RIG, rig);
LOAD4_BUFFER(BINDING_BODY, bodies);
LOAD4_BUFFER(BINDING_CHAIN, chains);
STORE4_BUFFER(BINDING_POSE_OUT, posesOut);

void main() {
  int record = legAt(int(gl_GlobalInvocationID.x));
  if (record < 0) return;
  int agent = agentOfRecord(record, LEGS), leg = legOfRecord(record, LEGS);
  int at = record * chainStride(BONES), rigAt = leg * rigStride(BONES);
  int poseAt = (agent * (1 + LEGS * BONES) + 1 + leg * BONES) * POSE_STRIDE;

  vec4 r = LOAD4(bodies, agent * BODY_STRIDE + 2);
  vec4 root = LOAD4(rig, rigAt);
  vec3 p = rotate(r, root.xyz);
  if (leg == 0) {
    STORE4_TWO(posesOut, poseAt - POSE_STRIDE, r, vec4(0.0));
  }
#ifdef HURT
  int whole = lostFrom(agent, leg);
#endif
  for (int i = 0; i < BONES; ++i) {
#ifdef HURT
    // Lost bones have neither turn nor length: all of their skin is drawn to the stump's end.
    if (i >= whole) {
      STORE4_TWO(posesOut, poseAt + POSE_STRIDE * i, r, vec4(p, 1.0));
      continue;
    }
#endif
    vec4 directions = LOAD4(chains, at + i / 2);
    vec2 s = (i & 1) == 0 ? directions.xy : directions.zw;
    int bone = rigAt + RIG_LEG_STRIDE + RIG_BONE_STRIDE * i;
    vec4 a = LOAD4(rig, bone), b = LOAD4(rig, bone + 1);
    vec3 axis = cross(b.xyz, a.xyz) * s.x - a.xyz * s.y;
    r = quaternionProduct(r, vec4(axis, 1.0) * inversesqrt(1.0 + dot(s, s)));
    STORE4_TWO(posesOut, poseAt + POSE_STRIDE * i, r, vec4(p, 0.0));
    p += root.w * a.w * rotate(r, b.xyz);
  }
}
