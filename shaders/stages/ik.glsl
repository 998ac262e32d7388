// The solve of a leg, which every entry point of ik has: quickly for the legs that need no more, whole for the
// others.
#ifndef IK_GLSL
#define IK_GLSL
#define ONLY_CONES  // are what rigs have
#include "stages/awake.glsl"
#include "shared/ik_batch.h"
#include "lib/active_set.glsl"
#include "lib/unheld_step.glsl"
#include "lib/fabrik.glsl"
#include "lib/limb.glsl"
#include "lib/rarely.glsl"
#include "stages/rig_bones.glsl"
#include "stages/hurt.glsl"
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
STORE4_BUFFER(BINDING_CHAIN_OUT, chainsOut);
STORE4_BUFFER(BINDING_TIP_OUT, tipsOut);
#include "stages/counters.glsl"
layout(set = 0, binding = BINDING_LIST, std430) buffer ListBlock { uint list[]; };

// The leg record of this invocation, or -1.
int recordToSolve() {
  int place = int(gl_GlobalInvocationID.x);
  if (PASS != PASS_LISTED) return legAt(place);
  if (place >= int(counters[COUNTER_IK_LISTED])) return -1;
  uint entry = list[place];
  if (LEVELS) tickOver(float(1u << (entry / uint(LIST_LEVEL))));
  return int(entry & uint(LIST_LEVEL - 1));
}

void enlist(int record) {
  uint place = atomicAdd(counters[COUNTER_IK_LISTED], 1u);
  list[place] = uint(record) + (LEVELS ? uint(LIST_LEVEL) * uint(findMSB(uint(tickSpan))) : 0u);
  atomicMax(counters[COUNTER_IK_DISPATCH_X], place / uint(WORK_GROUP) + 1u);
}

// The leg's bones; returns its root in the model and its reach.
vec4 readLimb(int leg, out Limb limb) {
  vec4 root;
  if (RIG_CHOSEN) {
    LegBits bits = bitsOfLeg(leg);
    root = chosenRoot(bits);
    for (int i = 0; i < BONES; ++i) {
      setBone(limb, i, chosenBone(bits, i));
      limb.edge[i] = 0.0;  // of what the first dispatch does not do
    }
  } else {
    int rigAt = leg * rigStride(BONES);
    root = LOAD4(rig, rigAt);
    LOAD_LIMB(limb, rig, rigAt + RIG_LEG_STRIDE);
  }
  for (int i = 0; i < BONES; ++i) limb.stiffness[i] = i == 0 ? FIRST_STIFFNESS : 1.0;
  return root;
}

struct Aim {
  vec3 target;  // from the root, in reaches
  bool lost;    // no number: the leg stays where it is
  bool stuck;   // straight, with the target on its line
  float error;  // from tip to target, in reaches
};

Aim aimAt(vec3 target, Pose pose) {
  Aim aim;
  aim.lost = !(dot(target, target) < 1e38);
  aim.target = aim.lost ? pose.tip : target;
  aim.error = distance(aim.target, pose.tip);
  // The first dispatch leaves to the second whatever may be stuck, so one joint in the middle will do, if all limbs have
  // one there.
  bool one = PASS == PASS_QUICK && !PADDED && BONES > 1;
  aim.stuck = one ? deadlocked(aim.target, pose, BONES / 2, BONES / 2 + 1) : deadlocked(aim.target, pose);
  return aim;
}

float pullAt(float error) { return POLISH_ITERATIONS > 1 && error < parameters.pullError ? parameters.restPull : 0.0; }

// Rounds of the active-set step: who ticks in every fourth or eighth tick has farther to go in one.
int roundsOfPolish() { return LEVELS && tickSpan > 2.0 ? 2 : 1; }

// False where the leg is not near its target, may meet a limit, or is led away: it is of no use then.
bool stepQuickly(Limb limb, inout Aim aim, inout Pose pose) {
  bool near = aim.error <= parameters.approachError;
  bool clear = unheldStep(limb, aim.target, POLISH_ITERATIONS - 1, pullAt(aim.error), parameters.ikTolerance, pose, aim.error);
  return near && clear;
}

// The first dispatch's solve, false where the leg needs the second one's, which begins anew: a device that masks lanes
// makes every path for every lane.
bool solveQuickly(Limb limb, inout Aim aim, inout Pose pose) {
  bool solved = stepQuickly(limb, aim, pose);
  for (int round = 1; round < roundsOfPolish(); ++round) {
    forwardKinematics(limb, pose);
    bool again = stepQuickly(limb, aim, pose);
    solved = solved && again;
  }
  return solved && !aim.lost && !aim.stuck;
}

void approach(Limb limb, vec3 target, inout Pose pose) {
  if (SOLVER == SOLVER_FABRIK) fabrikIteration(limb, target, pose);
#ifdef COMPARED_SOLVERS
  if (SOLVER == SOLVER_CCD) ccdIteration(limb, target, pose);
  if (SOLVER >= SOLVER_TRANSPOSE && SOLVER <= SOLVER_TARGET_ATTACHED) jacobianIteration(limb, target, SOLVER, pose);
#endif
}

const float SHORT_STEP = 256.0;  // its damping

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

void solveWhole(Limb limb, int agent, inout Aim aim, inout Pose pose) {
  countForHerd(aim.lost, agent, ROW_NOT_FINITE);
  RARELY(aim.stuck) {
    bend(limb, pose);
    aim.error = distance(aim.target, pose.tip);
  }
  // FABRIK, or the solver that the herd names, brings a chain near that is far from its target (a start, a jump).
  Pose trial;
  keepIf(true, trial, pose);
  forwardKinematics(limb, trial);
  for (int i = 0; i < APPROACH_ITERATIONS && aim.error > parameters.approachError; ++i) {
    approach(limb, aim.target, trial);
    float e = distance(aim.target, trial.tip);
    bool better = e < aim.error;
    keepIf(better, pose, trial);
    aim.error = better ? e : aim.error;
  }
  for (int round = 0; round < roundsOfPolish(); ++round) {
    forwardKinematics(limb, pose);
    if (POLISH_ITERATIONS > 0) polish(limb, aim.target, aim.lost, pose, pose, aim.error);
  }
}

// Where the tip of a pose that nobody solved is.
void storeTip(int record, vec4 orientation, vec4 root, Pose pose, float error) {
  if (FEET) STORE4(tipsOut, record, vec4(rotate(orientation, root.xyz + root.w * pose.tip), error * root.w));
}

void storeSolved(int record, vec4 orientation, vec4 root, Pose pose, float error) {
  STORE_SWINGS(chainsOut, record * chainStride(BONES), pose.swing, chainStride(BONES) % 2 == 0);
  storeTip(record, orientation, root, pose, error);
}
#endif
