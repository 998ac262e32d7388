#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Chains whose pose is their joints: free ones, and those of the dissertation (docs/ik.md).
#include "ik/batch.glsl"
#include "lib/dissertation.glsl"
#include "lib/free_chain.glsl"

// Each pass of FABRIK moves a joint no farther than the one before it, so that without limits the error never
// grows, and the present pose is the best.
const bool MONOTONE = SOLVER == SOLVER_FABRIK || SOLVER == SOLVER_STRETCH_ALIGN;

void iterate(float bone[BONES], vec3 rest[BONES], float cosLimit[BONES], float sinLimit[BONES], vec3 target, vec3 pole,
             int k, inout FreePose pose) {
  if (SOLVER == SOLVER_CCD) {
    freeCcd(bone, target, pose);
  } else if (SOLVER == SOLVER_TWO_BONE) {
    twoBone(bone, target, pole, pose);
  } else if (SOLVER == SOLVER_DISSERTATION_KEEP || SOLVER == SOLVER_DISSERTATION_EDGE) {
    dissertationIteration(bone, rest, cosLimit, sinLimit, target, SOLVER == SOLVER_DISSERTATION_EDGE, pose);
  } else if (SOLVER >= SOLVER_TRANSPOSE && SOLVER <= SOLVER_TARGET_ATTACHED) {
    freeJacobian(bone, target, SOLVER, rest, pose);
  } else {
    freeFabrik(bone, target, pose);
  }
}

float farthest(FreePose a, FreePose b) {
  float most = 0.0;
  for (int i = 1; i <= BONES; ++i) most = max(most, distance(a.joint[i], b.joint[i]));
  return most;
}

// Turned about the line base-tip, so that the bend points to the pole.
void turnToPole(vec3 pole, inout FreePose pose) {
  vec3 line = unit(pose.joint[BONES]), bend = vec3(0.0);
  for (int i = 1; i < BONES; ++i) bend += pose.joint[i] - line * dot(pose.joint[i], line);
  vec3 w = pole - line * dot(pole, line);
  if (dot(bend, bend) > 1e-10 && dot(w, w) > 1e-10) {
    // Half a turn must be about the line too: of the two forms of the turn, the better conditioned one.
    float c = dot(unit(bend), unit(w)), s = dot(cross(line, unit(bend)), unit(w));
    vec4 turn = c < 0.0 ? vec4((1.0 - c) * line, s) : vec4(s * line, 1.0 + c);
    turn *= inversesqrt(dot(turn, turn));
    for (int i = 1; i < BONES; ++i) pose.joint[i] = rotate(turn, pose.joint[i]);
  }
}

// Held to the target's pace: on the way from `a` to `b`, as far as no joint moves by more than `most`.
void holdTo(float bone[BONES], FreePose a, float moved, float most, inout FreePose b) {
  vec3 from[BONES], to[BONES], u[BONES];
  toDirections(bone, a, from);
  toDirections(bone, b, to);
  float share = most / moved;
  for (int k = 0; k <= PACE_CORRECTIONS; ++k) {
    for (int i = 0; i < BONES; ++i) u[i] = between(from[i], to[i], share);
    fromDirections(bone, u, b);
    float way = 0.0;
    for (int i = 1; i <= BONES; ++i) way = max(way, distance(a.joint[i], b.joint[i]));
    share *= way > most && k + 1 <= PACE_CORRECTIONS ? most / way : 1.0;
  }
}

void main() {
  int chain = chainHere();
  if (chain >= int(constants.count)) return;
  float bone[BONES], cosLimit[BONES], sinLimit[BONES];
  vec3 rest[BONES];
  for (int i = 0; i < BONES; ++i) {
    vec4 b = LOAD4(rig, RIG_BONE_STRIDE * i + 1);
    bone[i] = LOAD4(rig, RIG_BONE_STRIDE * i).w;
    rest[i] = b.xyz;
    float k = 1.0 / (1.0 + b.w * b.w);
    cosLimit[i] = LOAD4(rig, RIG_BONE_STRIDE * i + 4).x == float(LIMIT_CONE) ? (1.0 - b.w * b.w) * k : -2.0;
    sinLimit[i] = 2.0 * b.w * k;
  }
  int iterations = SOLVER == SOLVER_TWO_BONE ? min(int(constants.iterations), 1) : int(constants.iterations);
  float inverseReach = 1.0 / constants.reach;
  FreePose pose;
  pose.joint[0] = vec3(0.0);
  for (int i = 0; i < BONES; ++i)
    pose.joint[i + 1] = PREVIOUS ? LOAD4(states, chain * BONES + i).xyz * inverseReach : pose.joint[i] + bone[i] * rest[i];
  vec3 base = BASES ? LOAD4(bases, chain * BASE_STRIDE).xyz : vec3(0.0);
  vec4 orientation = BASES ? LOAD4(bases, chain * BASE_STRIDE + 1) : vec4(0.0, 0.0, 0.0, 1.0);
  vec3 given = LOAD4(targets, chain).xyz, pole = vec3(constants.poleX, constants.poleY, constants.poleZ);
  vec3 target = (BASES ? rotateBack(orientation, given - base) : given) * inverseReach;
  bool lost = !finite(target);
  target = nearEnough(target);
  target = lost ? pose.joint[BONES] : target;

  Pace pace = paceOf(PREVIOUS ? LOAD4(paces, chain) : vec4(0.0), target);
  FreePose start;
  for (int i = 0; i <= BONES; ++i) start.joint[i] = pose.joint[i];
  float error = distance(target, pose.joint[BONES]), last = error, startError = error;
  float reason = lost ? STOP_SKIPPED : STOP_TOLERANCE;
  int k = 0;
  bool far = dot(target, target) >= 1.0, open = error > leastError() && iterations > 0;
  reason = error > constants.tolerance && !open ? STOP_CAP : reason;
  // A target out of reach: straight toward it.
  vec3 toward = unit(target), p = vec3(0.0);
  bool reachFor = PASS != PASS_QUICK && open && far;
  for (int i = 0; i < BONES; ++i) {
    p += bone[i] * toward;
    pose.joint[i + 1] = reachFor ? p : pose.joint[i + 1];
  }
  error = reachFor ? distance(target, p) : error;
  reason = reachFor && error > constants.tolerance ? STOP_UNREACHABLE : reason;
  k = reachFor ? 1 : 0;
  open = open && !far;
  RARELY(STRAIGHT && SOLVER != SOLVER_STRETCH_ALIGN && open && freeDeadlocked(target, pose)) {
    freeBend(bone, pole, pose);
    error = last = distance(target, pose.joint[BONES]);
  }
  FreePose best;
  best.joint[0] = vec3(0.0);
  for (int i = 1; i <= BONES; ++i) best.joint[i] = pose.joint[i];
  bool aligned = true;
  if (SOLVER == SOLVER_STRETCH_ALIGN) {
    // Not in an `if` on `open`, which would not skip it on a device that masks lanes.
    aligned = stretchAlign(bone, target, pole, constants.tolerance, PREVIOUS, PASS == PASS_QUICK ? STEPS : 0, pose) || !open;
    last = distance(target, pose.joint[BONES]);
    k = open ? 1 : k;
    bool nearer = open && last < error;
    for (int i = 1; i <= BONES; ++i) pose.joint[i] = nearer ? pose.joint[i] : best.joint[i];
    error = last = nearer ? last : error;
    open = open && error > constants.tolerance;
  }
  if (PASS == PASS_QUICK) {
    bool needsMore = !aligned || far || (open && k < iterations) || (PREVIOUS && (POLE || isHeld(pace, farthest(start, pose))));
    enlist(needsMore, chain);
    if (needsMore) return;
  }
  for (; PASS != PASS_QUICK && open && k < iterations; ++k) {
    iterate(bone, rest, cosLimit, sinLimit, target, pole, k, pose);
    float now = distance(target, pose.joint[BONES]);
    if (!MONOTONE)
      for (int i = 1; i <= BONES; ++i) best.joint[i] = now < error ? pose.joint[i] : best.joint[i];
    error = MONOTONE ? now : min(error, now);
    bool stalled = abs(last - now) < leastProgress() && k + 1 < iterations;
    last = now;
    open = error > constants.tolerance && !stalled;
    reason = error > constants.tolerance && stalled ? STOP_STALL : reason;
  }
  if (MONOTONE)
    for (int i = 1; i <= BONES; ++i) best.joint[i] = pose.joint[i];
  // What a closed form does not reach lies nearer than two bones can fold.
  reason = open && error > constants.tolerance ? (SOLVER == SOLVER_TWO_BONE ? STOP_UNREACHABLE : STOP_CAP) : reason;

  if (POLE && !lost && BONES > 1) turnToPole(pole, best);
  if (PREVIOUS && PASS != PASS_QUICK) {
    float moved = farthest(start, best);
    bool idle = !lost && isIdle(pace, moved, startError - error, error);
    if (idle) {
      for (int i = 1; i <= BONES; ++i) best.joint[i] = start.joint[i];
      error = distance(target, best.joint[BONES]);
    } else if (!lost && isHeld(pace, moved)) {
      holdTo(bone, start, moved, GEAR * pace.pace, best);
      error = distance(target, best.joint[BONES]);
      reason = error > constants.tolerance ? STOP_HELD : STOP_TOLERANCE;
    }
  }
  if (PREVIOUS && !lost) STORE4(pacesOut, chain, vec4(target, pace.pace));
  for (int i = 1; i <= BONES; ++i) {
    vec3 p = constants.reach * best.joint[i];
    // What a lost target keeps is kept to the bit.
    if (PREVIOUS && BASES && !lost) STORE4(statesOut, chain * BONES + i - 1, vec4(p, 0.0));
    if (BASES || !(PREVIOUS && lost))
      STORE4(jointsOut, chain * BONES + i - 1, vec4(BASES ? base + rotate(orientation, p) : p, 0.0));
  }
  if (ROTATIONS) {
    vec4 r = vec4(0.0, 0.0, 0.0, 1.0);
    for (int i = 0; i < BONES; ++i) {
      vec3 u = best.joint[i + 1] - best.joint[i], from = rotate(r, rest[i]);
      vec4 turned = quaternionProduct(shortestArc(from, unit(u)), r);
      r = bone[i] > 0.0 ? turned * inversesqrt(dot(turned, turned)) : r;
      STORE4(rotationsOut, chain * BONES + i, BASES ? quaternionProduct(orientation, r) : r);
    }
  }
  STORE4(reportsOut, chain, vec4(lost ? 0.0 : error, float(k), reason, 0.0));
}
