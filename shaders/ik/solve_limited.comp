#version 460
#extension GL_GOOGLE_include_directive : require
// Chains with limits (docs/ik.md).
#include "ik/batch.glsl"
#include "lib/active_set.glsl"
#include "lib/ccd.glsl"
#include "lib/fabrik.glsl"
#include "lib/jacobian.glsl"
#include "lib/limb.glsl"

LOAD4_BUFFER(BATCH_SEED, seeds);

const int ATTEMPT = 8;           // iterations an attempt has
const float SLOW = 0.8;          // of the error left by a step: the attempt has stalled
const float IDLE = 0.999;        // of the error left by a step that hardly moves
const int IDLE_STEPS = 4;        // in a row: a last attempt has stalled
const float WORTH_A_JUMP = 0.5;  // of the error, for an attempt to replace a pose that is seen
const float LONGEST_PAUSE = 32.0;
const float PULL_WITHIN = 2e-3;

void iterate(Limb limb, vec3 target, bool lost, inout Pose pose, inout float error, inout float damping) {
  if (SOLVER == SOLVER_ACTIVE_SET) {
    float pull = error < PULL_WITHIN ? constants.restPull : 0.0;
    activeSet(limb, target, lost, 0, pull, constants.tolerance, pose, error, damping);
    return;
  }
  if (SOLVER == SOLVER_FABRIK) fabrikIteration(limb, target, pose);
  if (SOLVER == SOLVER_CCD) ccdIteration(limb, target, pose);
  if (SOLVER >= SOLVER_TRANSPOSE && SOLVER <= SOLVER_TARGET_ATTACHED) jacobianIteration(limb, target, SOLVER, pose);
  error = distance(target, pose.tip);
}

// To which side the chain folds, as far as the pole goes.
float foldOf(vec3 pole, Pose pose) {
  vec3 line = unit(pose.tip), sum = vec3(0.0);
  for (int i = 1; i < BONES; ++i) sum += pose.joint[i] - line * dot(pose.joint[i], line);
  return dot(sum, pole);
}

void main() {
  int chain = int(gl_GlobalInvocationID.x);
  if (chain >= int(constants.count)) return;
  Limb limb;
  LOAD_LIMB(limb, rig, 0);
  int at = chain * stateStride(BONES, TWISTS), memoryAt = at + stateMemory(BONES, TWISTS);
  Pose pose;
  vec4 memory = PREVIOUS ? LOAD4(states, memoryAt) : vec4(0.0, 1.0, 0.0, 0.0);
  if (PREVIOUS) {
    LOAD_DIRECTIONS(pose.d, states, at);
    LOAD_TWISTS(pose.twist, states, at + stateTwists(BONES));
  } else {
    for (int i = 0; i < BONES; ++i) {
      pose.d[i] = clampLimit(limb, i, vec3(0.0, 0.0, 1.0));
      pose.twist[i] = TWISTS ? clamp(0.0, limb.kind[i].y, limb.kind[i].z) : 0.0;
    }
  }
  forwardKinematics(limb, pose);
  vec3 base = BASES ? LOAD4(bases, chain * BASE_STRIDE).xyz : vec3(0.0);
  vec4 orientation = BASES ? LOAD4(bases, chain * BASE_STRIDE + 1) : vec4(0.0, 0.0, 0.0, 1.0);
  vec3 given = LOAD4(targets, chain).xyz, pole = vec3(constants.poleX, constants.poleY, constants.poleZ);
  vec3 target = (BASES ? rotateBack(orientation, given - base) : given) / constants.reach;
  bool lost = !finite(target);
  target = lost ? pose.tip : target;

  float error = distance(target, pose.tip), damping = 1.0, reason = lost ? STOP_SKIPPED : STOP_TOLERANCE;
  int k = 0;
  bool pulls = SOLVER == SOLVER_ACTIVE_SET && constants.restPull > 0.0 && !lost;
  bool folded = dot(pole, pole) > 0.0 && foldOf(pole, pose) < -1e-3;
  bool open = (error > constants.tolerance || folded || pulls) && constants.iterations > 0u && !lost;
  reason = error > constants.tolerance && !open && !lost ? STOP_CAP : reason;
  // Rare work stands in loops, which are skipped where no chain of a subgroup needs it.
  for (bool stuck = open && deadlocked(target, pose); stuck; stuck = false) {
    bend(limb, pose);
    error = distance(target, pose.tip);
  }
  Pose best;
  keepIf(true, best, pose);
  vec3 start[BONES];  // where each bone ended
  for (int i = 0; i < BONES; ++i) start[i] = i + 1 < BONES ? pose.joint[min(i + 1, BONES - 1)] : pose.tip;
  float bestError = folded ? 1e9 : error, last = error;
  int budget = int(constants.iterations), spent = budget - budget / 4;
  bool follows = SOLVER == SOLVER_ACTIVE_SET && constants.seeds > 0u && memory.x <= 0.0;
  // What takes the place of a pose that is seen must be worth the jump.
  bool wary = PREVIOUS && !folded, first = true, inVain = false;
  uvec2 untried = uvec2(0xffffffffu);
  // A chain folded to the wrong side begins at a seed.
  bool again = open && folded && follows, goesOn = false;
  int attempt = 0, idle = 0;
  while (open) {
    for (; again; again = false) {
      float least = 1e30;
      int nearest = 0;
      for (int s = 0; s < int(constants.seeds); ++s) {
        int seedAt = s * seedStride(BONES, TWISTS) + stateMemory(BONES, TWISTS);
        vec3 away = LOAD4(seeds, seedAt + BONES - 1).xyz - target;
        float score = dot(away, away), moved = 0.0;
        for (int i = 0; i < BONES; ++i) {
          vec3 by = LOAD4(seeds, seedAt + i).xyz - start[i];
          moved += dot(by, by);
        }
        score += 0.1 * moved / float(BONES);
        bool fresh = ((s < 32 ? untried.x : untried.y) >> uint(s & 31) & 1u) != 0u;
        nearest = fresh && score < least ? s : nearest;
        least = fresh ? min(score, least) : least;
      }
      uint bit = 1u << uint(nearest & 31);
      untried &= nearest < 32 ? uvec2(~bit, 0xffffffffu) : uvec2(0xffffffffu, ~bit);
      if (least < 1e29) {
        int seedAt = nearest * seedStride(BONES, TWISTS);
        LOAD_DIRECTIONS(pose.d, seeds, seedAt);
        LOAD_TWISTS(pose.twist, seeds, seedAt + stateTwists(BONES));
        forwardKinematics(limb, pose);
        error = last = distance(target, pose.tip);
        damping = 1.0;
        attempt = 0;
        first = false;
      } else {
        goesOn = true;
      }
    }
    // No more attempts: the best pose so far has what is left.
    for (; goesOn; goesOn = false) {
      keepIf(true, pose, best);
      forwardKinematics(limb, pose);
      error = last = distance(target, pose.tip);
      damping = 1.0;
      idle = 0;
      follows = false;
      first = true;
    }
    iterate(limb, target, lost, pose, error, damping);
    ++k;
    bool better = error < (wary && !first ? WORTH_A_JUMP * bestError : bestError);
    for (bool keep = better; keep; keep = false) keepIf(true, best, pose);
    wary = wary && !(better && !first);
    bestError = better ? error : bestError;
    bool arrived = bestError <= constants.tolerance;
    idle = error > IDLE * last ? idle + 1 : 0;
    bool ended = follows && !arrived && (error > SLOW * last || ++attempt >= ATTEMPT);
    bool stalled = SOLVER == SOLVER_ACTIVE_SET ? !follows && idle >= IDLE_STEPS : abs(last - error) < leastProgress();
    last = error;
    again = ended && k < spent;
    goesOn = ended && !again;
    inVain = inVain || again;
    // Once on target a pulled chain has one more iteration, for the pull.
    open = k < budget && (!arrived || (pulls && k < 2)) && !(stalled && !arrived);
    reason = stalled ? STOP_STALL : STOP_CAP;
  }
  bool arrived = bestError <= constants.tolerance;
  reason = arrived ? STOP_TOLERANCE : (dot(target, target) > 1.0 ? STOP_UNREACHABLE : reason);
  reason = lost ? STOP_SKIPPED : reason;

  forwardKinematics(limb, best);
  if (PREVIOUS) {
    // After attempts in vain, a pause: longer each time, so that a target out of reach costs little.
    bool paused = inVain && !arrived && wary;
    float left = paused ? memory.y : max(memory.x - 1.0, 0.0);
    float next = arrived ? 1.0 : (paused ? min(2.0 * memory.y, LONGEST_PAUSE) : memory.y);
    STORE_DIRECTIONS(statesOut, at, best.d);
    STORE_TWISTS(statesOut, at + stateTwists(BONES), best.twist);
    STORE4(statesOut, memoryAt, vec4(left, next, 0.0, 0.0));
  }
  for (int i = 1; i <= BONES; ++i) {
    vec3 p = constants.reach * (i < BONES ? best.joint[min(i, BONES - 1)] : best.tip);
    STORE4(jointsOut, chain * BONES + i - 1, vec4(BASES ? base + rotate(orientation, p) : p, 0.0));
  }
  if (ROTATIONS) {
    for (int i = 0; i < BONES; ++i) {
      vec4 r = swung(limb, i, best.parent[i], best.d[i], best.twist[i]);
      STORE4(rotationsOut, chain * BONES + i, BASES ? quaternionProduct(orientation, r) : r);
    }
  }
  STORE4(reportsOut, chain, vec4(lost ? 0.0 : (bestError < 1e8 ? bestError : error), float(k), reason, 0.0));
}
