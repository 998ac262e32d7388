#ifndef ACTIVE_SET_GLSL
#define ACTIVE_SET_GLSL
#include "columns.glsl"
// Damped least squares over the joint angles with an active set of limits: a joint that meets its limit is held
// there, and what it could not do is handed to the others (docs/ik.md, Active set).

// A way in which a bone is limited: unit, in its (X, Y); how far it may go down and up it; its column.
struct Way {
  vec2 along, room;
  vec3 column;
};

Way wayOf(Limb limb, int i, vec2 s, Columns c) {
  Way way;
  roomOf(i, limb.edge[i], limb.ends[i], s, way.along, way.room);
  if (isKind(i, LIMIT_HINGE))
    way.column = -c.y[i];
  else
    way.column = way.along.x * c.x[i] + way.along.y * c.y[i];
  return way;
}

// Holds a column whose step x leaves its room at that end: its share of e, from `z` to that end, is done.
void hold(float x, float z, vec2 room, vec3 column, inout float end, inout float free, inout Symmetric m, inout vec3 e) {
  bool held = free > 0.0 && (x > room.y || x < room.x);
  end = held ? (x > room.y ? room.y : room.x) : end;
  addOuter(m, column, held ? -1.0 : 0.0);
  e -= (held ? end - z : 0.0) * column;
  free = held ? 0.0 : free;
}

// Which chord steps are made: all; those from near the target but not within the tolerance; of these, up to the first
// that leads away.
const int CHORDS_ALL = 0;
const int CHORDS_NEAR = 1;
const int CHORDS_BETTER = 2;
const float NEAR = 0.1;

// From `pose`, whose forward kinematics are done, one step and at most `chords` chord steps. On return swings, twists and
// tip of `pose`, and `error`, are the new ones if they are better. A `lost` target, one that is not finite, keeps the pose
// to the bit.
void activeSet(Limb limb, vec3 target, bool lost, int chords, int which, float restPull, float tolerance,
               inout Pose pose, inout float error, inout float damping) {
  Columns c;
  columnsOf(limb, pose, pose.tip, c);
  vec2 pull[BONES], x[BONES];
  float twist[BONES], end[BONES], free[BONES], twistEnd[BONES], twistFree[BONES];
  vec3 e = target - pose.tip;
  // Not the error's square: a compiler takes the root back where it sees it, in one kernel and not in another.
  float e2 = dot(e, e);
  // Chord steps from afar would tremble with the second.
  float mu = which == CHORDS_ALL ? 0.25 * min(e2, 0.25) : min(e2 * (0.25 + e2), 1.0);
  Symmetric m = Symmetric(vec3((mu + 1e-5) * damping), vec3(0.0));
  e *= min(1.0, 0.5 * inversesqrt(max(e2, 1e-20)));
  for (int i = 0; i < BONES; ++i) {
    addOuter(m, c, i);
    pull[i] = towardRest(pose.swing[i], restPull * limb.stiffness[i]);
    e -= pull[i].x * c.x[i] + pull[i].y * c.y[i];
    free[i] = twistFree[i] = 1.0;
    end[i] = twistEnd[i] = 0.0;
  }
  Inverse inverse = inverseOf(m);
  vec3 lambda = times(inverse, e);
  Way way[BONES];
  for (int i = 0; i < BONES; ++i) way[i] = wayOf(limb, i, pose.swing[i], c);
  [[unroll]] for (int pass = 1; pass < 3; ++pass) {
    for (int i = 0; i < BONES; ++i) {
      float z = dot(way[i].along, pull[i]);
      hold(z + dot(way[i].column, lambda), z, way[i].room, way[i].column, end[i], free[i], m, e);
      if (isKind(i, LIMIT_TWIST))
        hold(dot(c.twist[i], lambda), 0.0, twistRoom(limb.twists[i], pose.twist[i]), c.twist[i], twistEnd[i], twistFree[i], m, e);
    }
    inverse = inverseOf(m);
    lambda = times(inverse, e);
  }
  Pose trial;
  for (int i = 0; i < BONES; ++i) {
    trial.twist[i] = pose.twist[i];
    x[i] = pull[i] + stepOf(c, i, lambda);
    x[i] += (free[i] > 0.0 ? 0.0 : end[i] - dot(way[i].along, x[i])) * way[i].along;
    trial.swing[i] = turned(limb, i, pose.swing[i], x[i]);
    if (isKind(i, LIMIT_TWIST)) {
      twist[i] = twistFree[i] > 0.0 ? dot(c.twist[i], lambda) : twistEnd[i];
      turnTwist(limb, i, twist[i], trial.twist[i]);
    }
  }
  trial.tip = tipOf(limb, trial);
  bool going = true;
  [[unroll]] for (int chord = 0; chord < chords; ++chord) {
    e = target - trial.tip;
    float left = length(e);
    lambda = times(inverse, which == CHORDS_ALL || (left > tolerance && left <= NEAR) ? e : vec3(0.0));
    Pose next;
    for (int i = 0; i < BONES; ++i) {
      vec2 more = stepOf(c, i, lambda);
      x[i] += more - (free[i] > 0.0 ? 0.0 : dot(way[i].along, more)) * way[i].along;
      next.swing[i] = turned(limb, i, pose.swing[i], x[i]);
      next.twist[i] = pose.twist[i];
      if (isKind(i, LIMIT_TWIST)) {
        twist[i] += twistFree[i] * dot(c.twist[i], lambda);
        turnTwist(limb, i, twist[i], next.twist[i]);
      }
    }
    next.tip = tipOf(limb, next);
    going = which != CHORDS_BETTER || (going && distance(target, next.tip) < left);
    keepIf(going, trial, next);
  }
  float after = distance(target, trial.tip);
  // At rest out of reach, rounding alone must not decide; an error that is not a number is no better.
  bool kept = !lost && (after <= 1.0001 * error || after <= tolerance);
  keepIf(kept, pose, trial);
  error = kept ? after : error;
  damping = lost ? damping : dampingAfter(kept, damping);
}

#endif
