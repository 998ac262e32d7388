#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// ik of controller planted: the clip's pose, with its feet put where they are planted.
#include "stages/ik.glsl"

LOAD4_BUFFER(BINDING_FOOT, feet);
LOAD4_BUFFER(BINDING_START, starts);
STORE4_BUFFER(BINDING_FIX_OUT, fixesOut);
#ifdef HURT
LOAD4_BUFFER(BINDING_CHAIN, chains);
#endif

vec4 shortestArc(vec3 from, vec3 to) {
  vec4 q = vec4(cross(from, to), 1.0 + dot(from, to));
  return q * inversesqrt(max(dot(q, q), 1e-12));
}

void main() {
  int record = recordToSolve();
  if (record < 0) return;
  int agent = agentOfRecord(record, LEGS), leg = legOfRecord(record, LEGS);
  int at = record * startStride(BONES);

  Pose pose;
  LOAD_SWINGS(pose.swing, starts, at);
  vec4 orientation = LOAD4(bodies, agent * BODY_STRIDE + 2);
  vec4 foot = LOAD4(feet, record);
  Limb limb;
  vec4 root = readLimb(leg, limb);
  float reach = root.w;
  forwardKinematics(limb, pose);
  // The clip's pose, which what is solved is held against, and its root.
  root.xyz = LOAD4(starts, at + chainStride(BONES)).xyz;
  vec3 clipJoint[BONES], clipBone[BONES];
  for (int i = 0; i < BONES; ++i) {
    clipJoint[i] = pose.joint[i];
    clipBone[i] = pose.aboutBone[i];
    // What was animated is allowed, whatever the rig's limits are.
    limb.edge[i] = max(limb.edge[i], length(pose.swing[i]));
  }

#ifdef HURT
  // It holds the pose that it had when it was hurt.
  bool held = !carries(agent, leg);
  if (held) {
    LOAD_SWINGS(pose.swing, chains, record * chainStride(BONES));
    forwardKinematics(limb, pose);
    foot.xyz = rotate(orientation, root.xyz + reach * pose.tip);
  }
#endif
  Aim aim = aimAt((rotateBack(orientation, foot.xyz) - root.xyz) * (1.0 / reach), pose);
#ifdef HURT
  if (held) aim.error = 0.0;
  else
#endif
  if (PASS == PASS_QUICK) {
    if (!solveQuickly(limb, aim, pose)) {
      enlist(record);
      return;
    }
  } else {
    solveWhole(limb, agent, aim, pose);
  }

  storeSolved(record, orientation, root, pose, aim.error);
  forwardKinematics(limb, pose);
  for (int i = 0; i < BONES; ++i) {
    vec4 q = shortestArc(clipBone[i], pose.aboutBone[i]);
    vec3 move = root.xyz + reach * pose.joint[i] - rotate(q, root.xyz + reach * clipJoint[i]);
    STORE4_TWO(fixesOut, (record * BONES + i) * FIX_STRIDE, q, vec4(move, 0.0));
  }
}
