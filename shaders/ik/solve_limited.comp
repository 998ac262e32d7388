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
LOAD4_BUFFER(BATCH_REPORT, reports);

const int ATTEMPT = 8;           // iterations an attempt has
const float SLOW = 0.8;          // of the error left by a step: the attempt has stalled
const float IDLE = 0.999;        // of the error left by a step that hardly moves
const int IDLE_STEPS = 4;        // in a row: a last attempt has stalled
const float WORTH_A_JUMP = 0.5;  // of the error, for an attempt to replace a pose that is seen
const float PULL_WITHIN = 2e-3;
// The active set never leaves a pose for a worse one.
const bool ATTEMPTS_ALONE_IMPROVE = SOLVER == SOLVER_ACTIVE_SET;

void iterate(Limb limb, vec3 target, bool lost, inout Pose pose, inout float error, inout float damping) {
  if (SOLVER == SOLVER_ACTIVE_SET) {
    float pull = PULL && error < PULL_WITHIN ? constants.restPull : 0.0;
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

// Copies what a pose is made of, without what follows from it.
void copyIf(bool copied, inout Pose to, Pose from) {
  for (int i = 0; i < BONES; ++i) {
    to.d[i] = copied ? from.d[i] : to.d[i];
    if (mayBe(i, LIMIT_TWIST)) to.twist[i] = copied ? from.twist[i] : to.twist[i];
  }
}

void main() {
  int chain = chainHere();
  if (chain >= int(constants.count)) return;
  Limb limb;
  LOAD_LIMB(limb, rig, 0);
  int at = chain * stateStride(BONES, TWISTS);
  Pose pose;
  vec2 memory = PREVIOUS ? LOAD4(reports, chain).zw : vec2(STOPS * PAUSES * FIRST_PAUSE, 1.0);
  float pauses = floor(memory.x / STOPS);
  float nextPause = floor(pauses / PAUSES), pause = pauses - PAUSES * nextPause;
  if (PREVIOUS) {
    LOAD_DIRECTIONS(pose.d, states, at);
    LOAD_TWISTS(pose.twist, states, at + stateTwists(BONES));
    forwardKinematics(limb, pose);
  } else {
    restPose(limb, REST_LEGAL, pose);
  }
  vec3 base = BASES ? LOAD4(bases, chain * BASE_STRIDE).xyz : vec3(0.0);
  vec4 orientation = BASES ? LOAD4(bases, chain * BASE_STRIDE + 1) : vec4(0.0, 0.0, 0.0, 1.0);
  vec3 given = LOAD4(targets, chain).xyz, pole = vec3(constants.poleX, constants.poleY, constants.poleZ);
  vec3 target = (BASES ? rotateBack(orientation, given - base) : given) * (1.0 / constants.reach);
  bool lost = !finite(target);
  target = nearEnough(target);
  target = lost ? pose.tip : target;

  float error = distance(target, pose.tip), damping = memory.y;
  int k = 0, budget = int(constants.iterations), spent = budget - budget / 4;
  bool pulls = PULL;
  bool folded = POLE && foldOf(pole, pose) < -1e-3;
  bool open = (error > constants.tolerance || folded || pulls) && budget > 0 && !lost;
  bool stuck = STRAIGHT && open && deadlocked(target, pose), needsMore = stuck || folded;
  // Rare work stands in loops, which are skipped where no chain of a subgroup needs it.
  for (; PASS != PASS_QUICK && stuck; stuck = false) {
    bend(limb, pose);
    error = distance(target, pose.tip);
  }
  bool follows = SOLVER == SOLVER_ACTIVE_SET && constants.seeds > 0u && pause <= 0.0;
  // What takes the place of a pose that is seen must be worth the jump.
  float worth = PREVIOUS && !folded ? WORTH_A_JUMP : 1.0;
  vec3 start[BONES];  // where each bone ended
  for (int i = 0; i < BONES; ++i) start[i] = i + 1 < BONES ? pose.joint[min(i + 1, BONES - 1)] : pose.tip;
  Pose best;  // of the attempts before; of this one too where a step may make it worse
  copyIf(true, best, pose);
  float bestError = ATTEMPTS_ALONE_IMPROVE ? 1e30 : error;
  uvec2 untried = uvec2(0xffffffffu);
  bool first = true, inVain = false;
  // A chain folded to the wrong side begins at a seed.
  bool again = open && folded && follows;
  while (open) {
    bool running = !again;
    float last = error;
    int attempt = 0, idle = 0;
    while (running) {
      iterate(limb, target, lost, pose, error, damping);
      ++k;
      if (!ATTEMPTS_ALONE_IMPROVE) {
        copyIf(error < bestError, best, pose);
        bestError = min(error, bestError);
      }
      bool arrived = error <= constants.tolerance;
      idle = error > IDLE * last ? idle + 1 : 0;
      bool stalled = SOLVER == SOLVER_ACTIVE_SET ? !follows && idle >= IDLE_STEPS : abs(last - error) < leastProgress();
      bool ended = arrived ? !pulls || k > 1 : stalled || (follows && (error > SLOW * last || ++attempt >= ATTEMPT));
      last = error;
      running = !ended && k < (follows ? spent : budget);
    }
    open = follows && k < budget && (again || error > constants.tolerance);
    needsMore = needsMore || open;
    if (PASS == PASS_QUICK) break;
    for (bool next = open; next; next = false) {
      bool keep = !again && error < (first ? bestError : worth * bestError);
      copyIf(keep, best, pose);
      bestError = keep ? error : bestError;
      worth = keep && !first ? 1.0 : worth;
      first = first && again;
      float least = 1e30;
      int nearest = 0;
      for (int s = 0; s < int(constants.seeds); ++s) {
        int seedAt = s * seedStride(BONES, TWISTS) + stateStride(BONES, TWISTS);
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
      bool seeded = least < 1e29 && (k < spent || bestError > 1e29);
      int seedAt = nearest * seedStride(BONES, TWISTS);
      LOAD_DIRECTIONS(pose.d, seeds, seedAt);
      LOAD_TWISTS(pose.twist, seeds, seedAt + stateTwists(BONES));
      // No more attempts: the best pose so far has what is left.
      copyIf(!seeded, pose, best);
      bestError = seeded ? bestError : 1e30;
      follows = seeded;
      inVain = inVain || seeded;
      forwardKinematics(limb, pose);
      error = distance(target, pose.tip);
      damping = 1.0;
      again = false;
    }
  }
  bool jumped = !first && error < worth * bestError && bestError < 1e30;
  for (bool back = PASS != PASS_QUICK && !(error < (first ? bestError : worth * bestError)); back; back = false) {
    copyIf(true, pose, best);
    forwardKinematics(limb, pose);
    error = distance(target, pose.tip);
  }
  if (PASS == PASS_QUICK) {
    enlist(needsMore, chain);
    if (needsMore) return;
  }
  bool arrived = error <= constants.tolerance;
  float reason = arrived ? STOP_TOLERANCE : (dot(target, target) > 1.0 ? STOP_UNREACHABLE : (k < budget ? STOP_STALL : STOP_CAP));
  reason = lost ? STOP_SKIPPED : reason;

  if (PREVIOUS && !lost) {
    // After attempts in vain, a pause: longer each time, so that a target out of reach costs little.
    bool paused = inVain && !arrived && !jumped && worth < 1.0;
    pause = paused ? nextPause : max(pause - 1.0, 0.0);
    nextPause = arrived || jumped ? FIRST_PAUSE : (paused ? min(2.0 * nextPause, LONGEST_PAUSE) : nextPause);
    STORE_DIRECTIONS(statesOut, at, pose.d);
    STORE_TWISTS(statesOut, at + stateTwists(BONES), pose.twist);
  }
  for (int i = 1; i <= BONES; ++i) {
    vec3 p = constants.reach * (i < BONES ? pose.joint[min(i, BONES - 1)] : pose.tip);
    STORE4(jointsOut, chain * BONES + i - 1, vec4(BASES ? base + rotate(orientation, p) : p, 0.0));
  }
  if (ROTATIONS) {
    for (int i = 0; i < BONES; ++i) {
      vec4 r = swung(limb, i, pose.parent[i], pose.d[i], pose.twist[i]);
      STORE4(rotationsOut, chain * BONES + i, BASES ? quaternionProduct(orientation, r) : r);
    }
  }
  STORE4(reportsOut, chain, vec4(lost ? 0.0 : error, float(k), reason + STOPS * (pause + PAUSES * nextPause), damping));
}
