#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#define ONLY_CONES  // are what rigs have
#include "stages/awake.glsl"
#include "shared/ik_batch.h"
#include "lib/active_set.glsl"
#include "lib/unheld_step.glsl"
#include "lib/fabrik.glsl"
#include "lib/limb.glsl"
#include "lib/rarely.glsl"
#include "stages/rig_bones.glsl"
// What is there to be compared stays out of what ships: some drivers take long over code that is never run.
#ifdef COMPARED_SOLVERS
#include "lib/ccd.glsl"
#include "lib/jacobian.glsl"
#endif

layout(constant_id = CONSTANT_APPROACH_ITERATIONS) const int APPROACH_ITERATIONS = 4;
layout(constant_id = CONSTANT_SOLVER) const int SOLVER = SOLVER_FABRIK;
layout(constant_id = CONSTANT_POLISH_ITERATIONS) const int POLISH_ITERATIONS = 2;
layout(constant_id = CONSTANT_PASS) const int PASS = PASS_WHOLE;
layout(constant_id = CONSTANT_FEET) const bool FEET = false;
layout(constant_id = CONSTANT_RIG_CHOSEN) const bool RIG_CHOSEN = false;

LOAD4_BUFFER(BINDING_RIG, rig);
LOAD4_BUFFER(BINDING_BODY, bodies);
#ifdef SWINGS
LOAD4_BUFFER(BINDING_STEP, steps);
LOAD4_BUFFER(BINDING_ARC, arcs);
STORE4_BUFFER(BINDING_FOOT_OUT, feetOut);
#include "stages/swing.glsl"
#else
LOAD4_BUFFER(BINDING_FOOT, feet);
#endif
#ifdef PLANTED
LOAD4_BUFFER(BINDING_START, chains);
STORE4_BUFFER(BINDING_FIX_OUT, fixesOut);
#else
LOAD4_BUFFER(BINDING_CHAIN, chains);
STORE2_BUFFER(BINDING_MISS_OUT, missesOut);
#endif
STORE4_BUFFER(BINDING_CHAIN_OUT, chainsOut);
STORE4_BUFFER(BINDING_TIP_OUT, tipsOut);
#include "stages/counters.glsl"
layout(set = 0, binding = BINDING_LIST, std430) buffer ListBlock { uint list[]; };

void approach(Limb limb, vec3 target, inout Pose pose) {
  if (SOLVER == SOLVER_FABRIK) fabrikIteration(limb, target, pose);
#ifdef COMPARED_SOLVERS
  if (SOLVER == SOLVER_CCD) ccdIteration(limb, target, pose);
  if (SOLVER >= SOLVER_TRANSPOSE && SOLVER <= SOLVER_TARGET_ATTACHED) jacobianIteration(limb, target, SOLVER, pose);
#endif
}

void enlist(int record) {
  uint place = atomicAdd(counters[COUNTER_IK_LISTED], 1u);
  list[place] = uint(record);
  atomicMax(counters[COUNTER_IK_DISPATCH_X], place / uint(WORK_GROUP) + 1u);
}

const float SHORT_STEP = 256.0;  // its damping

// What body and gait are to know of.
float missOf(vec4 foot, float error) { return foot.w >= 1.0 && error > parameters.missLeast ? error : 0.0; }

float pullAt(float error) { return POLISH_ITERATIONS > 1 && error < parameters.pullError ? parameters.restPull : 0.0; }

void polish(Limb limb, vec3 target, bool lost, Pose unheld, inout Pose pose, inout float error) {
  // What the first dispatch would have made of it, to the bit, where it could have.
  float unheldError = error, pull = pullAt(error);
  bool clear = PASS == PASS_LISTED && !lost && error <= parameters.approachError &&
               unheldStep(limb, target, POLISH_ITERATIONS - 1, pull, parameters.ikTolerance, unheld, unheldError);
  // A step that leads away was undone: a short one then.
  bool done = false;
  for (int attempt = 0; attempt < 2 && !done; ++attempt) {
    float damping = attempt == 0 ? 1.0 : SHORT_STEP, before = damping;
    activeSet(limb, target, lost, POLISH_ITERATIONS - 1, CHORDS_ALL, pull, parameters.ikTolerance, pose, error, damping);
    done = clear || damping <= before;
  }
  keepIf(clear, pose, unheld);
  error = clear ? unheldError : error;
}

#ifdef PLANTED
vec4 shortestArc(vec3 from, vec3 to) {
  vec4 q = vec4(cross(from, to), 1.0 + dot(from, to));
  return q * inversesqrt(max(dot(q, q), 1e-12));
}
#endif

void main() {
  int record = int(gl_GlobalInvocationID.x);
  if (PASS == PASS_LISTED) {
    if (record >= int(counters[COUNTER_IK_LISTED])) return;
    record = int(list[record]);
  } else {
    record = legAt(record);
    if (record < 0) return;
  }
  int agent = agentOfRecord(record, LEGS), leg = legOfRecord(record, LEGS);
  int rigAt = leg * rigStride(BONES);
#ifdef PLANTED
  int at = record * startStride(BONES);
#else
  int at = record * chainStride(BONES);
#endif

  // What is far away in memory is asked for first, and waited for while the rig, which is near, is read.
  Pose pose;
  LOAD_SWINGS(pose.swing, chains, at);
  vec4 orientation = LOAD4(bodies, agent * BODY_STRIDE + 2);
#ifdef SWINGS
  vec4 foot = makeFoot(agent, record);
  if (FEET && PASS != PASS_LISTED) STORE4(feetOut, record, foot);
#else
  vec4 foot = LOAD4(feet, record);
#endif
  Limb limb;
  vec4 root;
  if (RIG_CHOSEN) {
    LegBits bits = bitsOfLeg(leg);
    root = chosenRoot(bits);
    for (int i = 0; i < BONES; ++i) {
      setBone(limb, i, chosenBone(bits, i));
      limb.edge[i] = 0.0;  // of what the first dispatch does not do
    }
  } else {
    root = LOAD4(rig, rigAt);
    LOAD_LIMB(limb, rig, rigAt + RIG_LEG_STRIDE);
  }
  for (int i = 0; i < BONES; ++i) limb.stiffness[i] = i == 0 ? FIRST_STIFFNESS : 1.0;
  float reach = root.w;
  forwardKinematics(limb, pose);
#ifdef PLANTED
  // The clip's pose, which what is solved is held against, and its root.
  root.xyz = LOAD4(chains, at + chainStride(BONES)).xyz;
  vec3 clipJoint[BONES], clipBone[BONES];
  for (int i = 0; i < BONES; ++i) {
    clipJoint[i] = pose.joint[i];
    clipBone[i] = pose.aboutBone[i];
    // What was animated is allowed, whatever the rig's limits are.
    limb.edge[i] = max(limb.edge[i], length(pose.swing[i]));
  }
#endif

  vec3 target = (rotateBack(orientation, foot.xyz) - root.xyz) * (1.0 / reach);
  bool lost = !(dot(target, target) < 1e38);  // nor where no number is
  target = lost ? pose.tip : target;
  float error = distance(target, pose.tip);
  // Who may be is left to the second dispatch, so one joint in the middle will do, if all limbs have one there.
  bool one = PASS == PASS_QUICK && !PADDED && BONES > 1;
  bool stuck = one ? deadlocked(target, pose, BONES / 2, BONES / 2 + 1) : deadlocked(target, pose);

  if (PASS == PASS_QUICK) {
    // What few chains need is left to the second dispatch, which begins anew: a device that masks lanes makes every
    // path for every lane.
    bool near = !lost && !stuck && error <= parameters.approachError;
    bool clear = unheldStep(limb, target, POLISH_ITERATIONS - 1, pullAt(error), parameters.ikTolerance, pose, error);
#ifndef PLANTED
    clear = clear && missOf(foot, error) == 0.0;
#endif
    if (!(near && clear)) {
      enlist(record);
      return;
    }
  } else {
    countForHerd(lost, agent, ROW_NOT_FINITE);
    RARELY(stuck) {
      bend(limb, pose);
      error = distance(target, pose.tip);
    }
    // FABRIK, or the solver that the herd names, brings a chain near that is far from its target (a start, a jump).
    Pose trial;
    keepIf(true, trial, pose);
    forwardKinematics(limb, trial);
    for (int i = 0; i < APPROACH_ITERATIONS && error > parameters.approachError; ++i) {
      approach(limb, target, trial);
      float e = distance(target, trial.tip);
      bool better = e < error;
      keepIf(better, pose, trial);
      error = better ? e : error;
    }
    forwardKinematics(limb, pose);
    if (POLISH_ITERATIONS > 0) polish(limb, target, lost, pose, pose, error);
  }

  STORE_SWINGS(chainsOut, record * chainStride(BONES), pose.swing, chainStride(BONES) % 2 == 0);
  if (FEET) STORE4(tipsOut, record, vec4(rotate(orientation, root.xyz + reach * pose.tip), error * reach));
#ifdef PLANTED
  forwardKinematics(limb, pose);
  for (int i = 0; i < BONES; ++i) {
    vec4 q = shortestArc(clipBone[i], pose.aboutBone[i]);
    vec3 move = root.xyz + reach * pose.joint[i] - rotate(q, root.xyz + reach * clipJoint[i]);
    STORE4_TWO(fixesOut, (record * BONES + i) * FIX_STRIDE, q, vec4(move, 0.0));
  }
#else
  if (PASS != PASS_QUICK)
    STORE2(missesOut, missPair(agent, leg, LEGS), vec2(missOf(foot, error), thisTick));
#endif
}
