#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
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
const float LEAP_GAIN = 0.02;    // that must be less, too, where the target is slow
const float PULL_WITHIN = 0.05;  // and where the last step was not undone
// The active set never leaves a pose for a worse one.
const bool ATTEMPTS_ALONE_IMPROVE = SOLVER == SOLVER_ACTIVE_SET;

void iterate(Limb limb, vec3 target, bool lost, inout Pose pose, inout float error, inout float damping) {
  if (SOLVER == SOLVER_ACTIVE_SET) {
    float pull = PULL && error < PULL_WITHIN && damping <= 1.0 ? constants.restPull : 0.0;
    // What a chord step does not bring there is listed.
    int which = PASS == PASS_QUICK ? CHORDS_NEAR : CHORDS_BETTER;
    activeSet(limb, target, lost, CHORDS, which, pull, constants.tolerance, pose, error, damping);
    forwardKinematics(limb, pose);
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

// How far the farthest joint is from where the bones ended.
float farthest(vec3 ends[BONES], Pose pose) {
  float most = distance(ends[BONES - 1], pose.tip);
  for (int i = 1; i < BONES; ++i) most = max(most, distance(ends[i - 1], pose.joint[i]));
  return most;
}

// Held to the target's pace: on the way from `a` to `b`, as far as no joint moves by more than `most` from where the
// bones ended.
// Balls by their directions, which leads past the point where (X, Y) have none.
void holdTo(Limb limb, Pose a, vec3 ends[BONES], float moved, float most, inout Pose b) {
  Pose to;
  keepIf(true, to, b);
  float share = most / moved;
  for (int k = 0; k <= PACE_CORRECTIONS; ++k) {
    for (int i = 0; i < BONES; ++i) {
      vec3 d = between(fromStereographic(a.swing[i]), fromStereographic(to.swing[i]), share);
      b.swing[i] = isKind(i, LIMIT_HINGE) ? mix(a.swing[i], to.swing[i], share)
                   : limb.bone[i] > 0.0   ? clampSwing(limb, i, d)
                                          : a.swing[i];
      b.twist[i] = mix(a.twist[i], to.twist[i], share);
    }
    forwardKinematics(limb, b);
    float way = farthest(ends, b);
    share *= way > most && k + 1 <= PACE_CORRECTIONS ? most / way : 1.0;
  }
}

// How far an attempt has come.
struct Attempt {
  bool running;
  float last;  // error before the step
  int steps, idle;
};

// One step, until the target is reached, nothing is gained any more or another attempt is worth more.
void advance(Limb limb, vec3 target, bool follows, int most, inout Attempt attempt, inout Pose pose, inout Pose best,
             inout float error, inout float bestError, inout float damping, inout int k) {
  iterate(limb, target, !attempt.running, pose, error, damping);
  k += attempt.running ? 1 : 0;
  if (!ATTEMPTS_ALONE_IMPROVE) {
    keepIf(error < bestError, best, pose);
    bestError = min(error, bestError);
  }
  bool arrived = error <= constants.tolerance;
  attempt.idle = error > IDLE * attempt.last ? attempt.idle + 1 : 0;
  bool stalled = SOLVER == SOLVER_ACTIVE_SET ? !follows && attempt.idle >= IDLE_STEPS
                                             : abs(attempt.last - error) < leastProgress();
  bool ended = arrived || stalled || (follows && (error > SLOW * attempt.last || ++attempt.steps >= ATTEMPT));
  attempt.last = error;
  attempt.running = attempt.running && !ended && k < most;
}

// The seed nearest to the target, or -1: rest.
int seedAt(vec3 target) {
  const int all = SEED_CELLS * SEED_CELLS * SEED_CELLS;
  ivec3 at = clamp(ivec3(floor((target + 1.0) * (0.5 * float(SEED_CELLS)))), 0, SEED_CELLS - 1);
  int cell = AIMED ? int(min(length(target) * float(all), float(all - 1))) : at.x + SEED_CELLS * (at.y + SEED_CELLS * at.z);
  return int(LOAD4(seeds, int(constants.seeds) * seedStride(BONES, TWISTS) + cell / 4)[cell & 3]);
}

// The nearest four, or as many as there are, of the seeds not yet tried, by |tip_s - target|^2 + 0.1 mean |p_s,i - start_i|^2
// without what all seeds have in common, halved. One look at all seeds costs as much as several steps.
void findSeeds(vec3 target, vec3 start[BONES], uvec2 untried, out ivec4 queue, out int queued) {
  vec4 least = vec4(1e30);
  queue = ivec4(0);
  queued = 0;
  float share = 0.1 / float(BONES);
  for (int s = 0; s < int(constants.seeds); ++s) {
    int at = s * seedStride(BONES, TWISTS) + stateStride(BONES, TWISTS);
    float score = 0.0;
    for (int i = 0; i < BONES; ++i) {
      vec4 p = LOAD4(seeds, at + i);
      score += p.w - dot(p.xyz, i + 1 < BONES ? share * start[i] : share * start[i] + target);
    }
    bool fresh = ((s < 32 ? untried.x : untried.y) >> uint(s & 31) & 1u) != 0u;
    queued = min(queued + (fresh ? 1 : 0), 4);
    bvec4 before = lessThan(vec4(fresh ? score : 1e31), least);
    queue = ivec4(before.x ? s : queue.x, before.x ? queue.x : before.y ? s : queue.y,
                  before.y ? queue.y : before.z ? s : queue.z, before.z ? queue.z : before.w ? s : queue.w);
    least = vec4(before.x ? score : least.x, before.x ? least.x : before.y ? score : least.y,
                 before.y ? least.y : before.z ? score : least.z, before.z ? least.z : before.w ? score : least.w);
  }
}

void loadSeed(int seed, inout Pose pose) {
  int at = seed * seedStride(BONES, TWISTS);
  LOAD_SWINGS(pose.swing, seeds, at);
  LOAD_TWISTS(pose.twist, seeds, at + stateTwists(BONES));
}

// What of a joint seeds are compared by: those of a chain with a free base are shapes, which point anywhere.
vec3 compared(vec3 joint) { return AIMED ? vec3(length(joint), 0.0, 0.0) : joint; }

// What an attempt from a shape strives for: the target as far away, and nothing of where.
vec3 goalOf(bool shape, vec3 target, Pose pose) { return shape ? length(target) * unit(pose.tip) : target; }

// The swing of a free base that was at `s` with which the chain's tip points at the target.
vec2 aimed(Limb limb, vec3 target, vec3 tip, vec2 s) {
  vec3 to = rotateBack(limb.rest[0], unit(target)), from = rotateBack(limb.rest[0], unit(tip));
  float w = (dot(s, from.xy) + from.z) * 2.0 / (1.0 + dot(s, s));
  // Against where the tip would be with the base at rest.
  vec2 over = to.xy + s * w - from.xy;
  float below = to.z + w - from.z;
  return clampSwing(limb, 0, below * over, below * below, 0.5 * (below * below + dot(over, over)));
}

// The set of all seeds without one.
uvec2 allBut(int seed) {
  uint bit = 1u << uint(seed & 31);
  return seed < 32 ? uvec2(~bit, 0xffffffffu) : uvec2(0xffffffffu, ~bit);
}

void main() {
  int chain = chainHere();
  if (chain >= int(constants.count)) return;
  Limb limb;
  LOAD_LIMB(limb, rig, 0);
  for (int i = 0; i < BONES; ++i) limb.stiffness[i] = LOAD4(rig, RIG_BONE_STRIDE * i + 2).w;
  int at = chain * stateStride(BONES, TWISTS);
  Pose pose;
  vec2 memory = PREVIOUS ? LOAD4(reports, chain).zw : vec2(0.0, 1.0);
  float pauses = floor(memory.x / STOPS);
  float nextPause = floor(pauses / PAUSES), pause = pauses - PAUSES * nextPause;
  if (PREVIOUS) {
    LOAD_SWINGS(pose.swing, states, at);
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

  Pace pace = paceOf(PREVIOUS ? LOAD4(paces, chain) : vec4(0.0), target);
  vec3 ends[BONES];  // where each bone ended
  for (int i = 0; i < BONES; ++i) ends[i] = i + 1 < BONES ? pose.joint[min(i + 1, BONES - 1)] : pose.tip;
  float error = distance(target, pose.tip), damping = memory.y, startError = error;
  int k = 0, budget = int(constants.iterations), spent = budget - budget / 4;
  bool folded = POLE && foldOf(pole, pose) < -1e-3;
  bool open = (error > leastError() || folded || PULL) && budget > 0 && !lost;
  bool stuck = STRAIGHT && open && deadlocked(target, pose), needsMore = stuck || folded;
  if (PASS != PASS_QUICK && stuck) {
    bend(limb, pose);
    error = distance(target, pose.tip);
  }
  bool follows = SOLVER == SOLVER_ACTIVE_SET && constants.seeds > 0u && pause <= 0.0;
  // What takes the place of a pose that is seen must be worth the jump.
  float worth = PREVIOUS && !folded ? WORTH_A_JUMP : 1.0, leap = pace.slow && !folded ? LEAP_GAIN : 0.0;
  vec3 start[BONES];
  for (int i = 0; i < BONES; ++i) start[i] = compared(ends[i]);
  Pose best;  // of the attempts before; of this one too where a step may make it worse
  keepIf(true, best, pose);
  float bestError = ATTEMPTS_ALONE_IMPROVE ? 1e30 : error;
  uvec2 untried = uvec2(0xffffffffu);
  ivec4 queue = ivec4(0);  // the nearest seeds of those
  int queued = 0;
  bool first = true, inVain = false;
  bool shape = false;   // the attempt is made from a seed that is then aimed
  vec3 goal = target;
  if (!PREVIOUS && PASS != PASS_WHOLE) {
    int nearest = seedAt(target);
    bool seeded = nearest >= 0 && error > constants.tolerance && !folded;
    Pose seed;
    loadSeed(max(nearest, 0), seed);
    keepIf(seeded, pose, seed);
    forwardKinematics(limb, pose);
    shape = AIMED && seeded;
    goal = goalOf(shape, target, pose);
    error = distance(goal, pose.tip);
    untried &= seeded ? allBut(nearest) : untried;
  }
  // A chain folded to the wrong side begins at a seed.
  bool again = open && folded && follows;
  // The steps that most chains need stand in a row: on a device that masks lanes a loop's body is run once more after
  // the last lane has left it, and what it changes is blended twice.
  Attempt attempt = Attempt(open && !again && (PULL || error > leastError()), error, 0, 0);
  if (PASS == PASS_QUICK) {
    [[unroll]] for (int i = 0; i < STEPS; ++i)
      advance(limb, goal, follows, follows ? spent : budget, attempt, pose, best, error, bestError, damping, k);
    if (AIMED && !PREVIOUS) {
      vec2 turned = aimed(limb, target, pose.tip, pose.swing[0]);
      pose.swing[0] = shape ? turned : pose.swing[0];
      forwardKinematics(limb, pose);
      error = distance(target, pose.tip);
    }
    needsMore = needsMore || again || attempt.running || (open && error > constants.tolerance);
  }
  while (PASS != PASS_QUICK && open) {
    while (attempt.running)
      advance(limb, goal, follows, follows ? spent : budget, attempt, pose, best, error, bestError, damping, k);
    if (AIMED) {
      vec2 turned = aimed(limb, target, pose.tip, pose.swing[0]);
      pose.swing[0] = shape ? turned : pose.swing[0];
      forwardKinematics(limb, pose);
      error = distance(target, pose.tip);
    }
    bool better = error < (first ? bestError : min(worth * bestError, bestError - leap));
    // An attempt that arrives without being worth the jump leaves the chain where it was, not there yet.
    open = open && follows && k < budget && (again || error > constants.tolerance || !better);
    if (open) {
      bool keep = !again && better;
      keepIf(keep, best, pose);
      bestError = keep ? error : bestError;
      worth = keep && !first ? 1.0 : worth;
      leap = keep && !first ? 0.0 : leap;
      first = first && again;
      bool worthwhile = bestError > leap;
      if (queued == 0 && worthwhile) findSeeds(compared(target), start, untried, queue, queued);
      int nearest = queue.x;
      bool seeded = worthwhile && queued > 0 && (k < spent || bestError > 1e29);
      queue = queue.yzww;
      queued = max(queued - 1, 0);
      untried &= allBut(nearest);
      loadSeed(nearest, pose);
      // No more attempts: the best pose so far has what is left.
      keepIf(!seeded, pose, best);
      bestError = seeded ? bestError : 1e30;
      follows = seeded;
      inVain = inVain || seeded;
      forwardKinematics(limb, pose);
      shape = AIMED && seeded;
      goal = goalOf(shape, target, pose);
      error = distance(goal, pose.tip);
      damping = 1.0;
      again = false;
      attempt = Attempt(true, error, 0, 0);
    }
  }
  bool jumped = !first && error < min(worth * bestError, bestError - leap) && bestError < 1e30;
  if (PASS != PASS_QUICK && !(error < (first ? bestError : min(worth * bestError, bestError - leap)))) {
    keepIf(true, pose, best);
    forwardKinematics(limb, pose);
    error = distance(target, pose.tip);
  }
  float moved = PREVIOUS ? farthest(ends, pose) : 0.0;
  if (PASS == PASS_QUICK) {
    needsMore = needsMore || (PREVIOUS && isHeld(pace, moved));
    enlist(needsMore, chain);
    if (needsMore) return;
  }
  bool arrived = error <= constants.tolerance;
  float reason = arrived ? STOP_TOLERANCE : (dot(target, target) > 1.0 ? STOP_UNREACHABLE : (k < budget ? STOP_STALL : STOP_CAP));
  bool replaced = pace.known && !folded && (jumped || worth >= 1.0);
  bool idle = PREVIOUS && isIdle(pace, moved, startError - error, error), held = !idle && !replaced && isHeld(pace, moved);
  reason = replaced && !idle ? STOP_JUMPED : reason;
  RARELY(PREVIOUS && PASS != PASS_QUICK && !lost && (idle || held)) {
    Pose origin;
    LOAD_SWINGS(origin.swing, states, at);
    LOAD_TWISTS(origin.twist, states, at + stateTwists(BONES));
    if (held) holdTo(limb, origin, ends, moved, GEAR * pace.pace, pose);
    keepIf(idle, pose, origin);
    forwardKinematics(limb, pose);
    error = distance(target, pose.tip);
    reason = !held ? reason : error > constants.tolerance ? STOP_HELD : STOP_TOLERANCE;
  }
  reason = lost ? STOP_SKIPPED : reason;

  if (PREVIOUS && !lost) {
    STORE4(pacesOut, chain, vec4(target, pace.pace));
    // After attempts in vain, a pause: longer each time, so that a target out of reach costs little.
    bool paused = inVain && !arrived && !jumped && worth < 1.0;
    pause = paused ? nextPause : max(pause - 1.0, 0.0);
    nextPause = arrived || jumped ? 0.0 : (paused ? clamp(2.0 * nextPause, 1.0, LONGEST_PAUSE) : nextPause);
    STORE_SWINGS(statesOut, at, pose.swing, false);
    STORE_TWISTS(statesOut, at + stateTwists(BONES), pose.twist);
  }
  for (int i = 1; i <= BONES; ++i) {
    vec3 p = constants.reach * (i < BONES ? pose.joint[min(i, BONES - 1)] : pose.tip);
    STORE4(jointsOut, chain * BONES + i - 1, vec4(BASES ? base + rotate(orientation, p) : p, 0.0));
  }
  if (ROTATIONS) {
    vec4 r = vec4(0.0, 0.0, 0.0, 1.0);
    for (int i = 0; i < BONES; ++i) {
      r = swung(limb, i, r, pose);
      STORE4(rotationsOut, chain * BONES + i, BASES ? quaternionProduct(orientation, r) : r);
    }
  }
  STORE4(reportsOut, chain, vec4(lost ? 0.0 : error, float(k), reason + STOPS * (pause + PAUSES * nextPause), damping));
}
