#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "stages/ik.glsl"

LOAD4_BUFFER(BINDING_CHAIN, chains);
STORE2_BUFFER(BINDING_MISS_OUT, missesOut);
#ifdef SWINGS
LOAD4_BUFFER(BINDING_STEP, steps);
LOAD4_BUFFER(BINDING_ARC, arcs);
STORE4_BUFFER(BINDING_FOOT_OUT, feetOut);
#include "stages/swing.glsl"
#else
LOAD4_BUFFER(BINDING_FOOT, feet);
#endif

vec4 footOf(int agent, int record) {
#ifdef SWINGS
  vec4 foot = makeFoot(agent, record);
  if (FEET && PASS != PASS_LISTED) STORE4(feetOut, record, foot);
  return foot;
#else
  return LOAD4(feet, record);
#endif
}

// What body and gait are to know of.
float missOf(vec4 foot, float error) { return foot.w >= 1.0 && error > parameters.missLeast ? error : 0.0; }

void main() {
  int record = recordToSolve();
  if (record < 0) return;
  int agent = agentOfRecord(record, LEGS), leg = legOfRecord(record, LEGS);

  // What is far away in memory is asked for first, and waited for while the rig, which is near, is read.
  Pose pose;
  LOAD_SWINGS(pose.swing, chains, record * chainStride(BONES));
  vec4 orientation = LOAD4(bodies, agent * BODY_STRIDE + 2);
  vec4 foot = footOf(agent, record);
  Limb limb;
  vec4 root = readLimb(leg, limb);
  float reach = root.w;
  forwardKinematics(limb, pose);

#ifdef HURT
  if (!carries(agent, leg)) {
    storeTip(record, orientation, root, pose, 0.0);
    return;
  }
#endif
  Aim aim = aimAt((rotateBack(orientation, foot.xyz) - root.xyz) * (1.0 / reach), pose);
  if (PASS == PASS_QUICK) {
    bool solved = solveQuickly(limb, aim, pose), missed = missOf(foot, aim.error) != 0.0;
    if (!solved || missed) {
      enlist(record);
      return;
    }
  } else {
    solveWhole(limb, agent, aim, pose);
    STORE2(missesOut, missPair(agent, leg, LEGS), vec2(missOf(foot, aim.error), crowdTick));
  }
  storeSolved(record, orientation, root, pose, aim.error);
}
