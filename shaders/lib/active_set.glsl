#ifndef ACTIVE_SET_GLSL
#define ACTIVE_SET_GLSL
#include "columns.glsl"
// Damped least squares over the joint angles with an active set of limits: a joint that meets its limit is held
// there, and what it could not do is handed to the others (docs/ik.md, Active set).

const float UNLIMITED = 1e9;

// How far bone i may go along its radial column, downward and upward; turns an ellipse's columns to its rim.
vec2 roomOf(Limb limb, Pose pose, int i, inout Columns c, inout vec2 normal) {
  vec3 b = pose.d[i];
  vec2 room = vec2(-UNLIMITED, UNLIMITED);
  if (mayBe(i, LIMIT_CONE)) {
    float below = limb.cosLimit[i] * b.z + limb.sinLimit[i] * c.s[i];
    room.y = below < 0.1 ? UNLIMITED : (limb.sinLimit[i] * b.z - limb.cosLimit[i] * c.s[i]) / below;
  }
  if (mayBe(i, LIMIT_ELLIPSE)) {
    float theta = 2.0 * arctangent(c.s[i] / max(1.0 + b.z, 1e-6));
    vec2 axes = ellipseAxes(limb.ends[i], c.h[i]), n = theta * c.h[i] / (axes * axes);
    float share = sqrt(theta * dot(c.h[i], n));
    vec2 slope = vec2(dot(c.h[i], n), (c.h[i].x * n.y - c.h[i].y * n.x) * theta / max(c.s[i], 1e-6));
    bool ellipse = isKind(limb, i, LIMIT_ELLIPSE), small = theta < 1e-3;
    normal = ellipse && !small ? unit(slope) : vec2(1.0, 0.0);
    float toRim = small ? UNLIMITED : (1.0 - share) * share * inversesqrt(max(dot(slope, slope), 1e-20));
    room.y = ellipse ? toRim : room.y;
    vec3 radial = c.radial[i];
    c.radial[i] = normal.x * radial + normal.y * c.tangential[i];
    c.tangential[i] = normal.x * c.tangential[i] - normal.y * radial;
  }
  if (mayBe(i, LIMIT_HINGE)) {
    // tan(end - q) from the cosines and sines of the ends; q = atan(-d.y, d.z).
    vec2 t = limb.ends[i].xy, k = 1.0 / (1.0 + t * t), cosines = (1.0 - t * t) * k, sines = 2.0 * t * k;
    vec2 along = cosines * b.z - sines * b.y, across = sines * b.z + cosines * b.y;
    vec2 hinged = vec2(along.x < 0.1 ? -UNLIMITED : across.x / along.x,
                       along.y < 0.1 ? UNLIMITED : across.y / along.y);
    room = isKind(limb, i, LIMIT_HINGE) ? hinged : room;
  }
  return room;
}

vec2 twistRoomOf(Limb limb, Pose pose, int i) {
  vec2 ends = limb.kind[i].yz, below = 1.0 + ends * pose.twist[i], room = 2.0 * (ends - pose.twist[i]) / max(below, vec2(0.1));
  return vec2(below.x < 0.1 ? -UNLIMITED : room.x, below.y < 0.1 ? UNLIMITED : room.y);
}

float pullOf(Limb limb, Pose pose, Columns c, int i, float restPull) {
  float z = -restPull * limb.stiffness[i] * c.s[i];
  if (mayBe(i, LIMIT_HINGE)) z = isKind(limb, i, LIMIT_HINGE) ? restPull * limb.stiffness[i] * pose.d[i].y : z;
  return z;
}

// Holds a column whose step leaves its room at that end: x becomes final, and its share of e is done.
void hold(float x, vec2 room, vec3 column, inout float z, inout float free, inout Symmetric m, inout vec3 e,
          inout bool again) {
  bool held = free > 0.0 && (x > room.y || x < room.x);
  float end = x > room.y ? room.y : room.x;
  addOuter(m, column, held ? -1.0 : 0.0);
  e -= (held ? end - z : 0.0) * column;
  z = held ? end : z;
  free = held ? 0.0 : free;
  again = again || held;
}

// From `pose`, whose forward kinematics are done, one step and `chords` chord steps. On return `pose` and `error`
// are the new ones if they are better. A `lost` target, one that is not finite, keeps the pose to the bit.
void activeSet(Limb limb, vec3 target, bool lost, int chords, float restPull, float tolerance, inout Pose pose,
               inout float error, inout float damping) {
  Columns c;
  columnsOf(limb, pose, pose.tip, c);
  vec2 room[BONES], normal[BONES], twistRoom[BONES];
  float x0[BONES], x1[BONES], x2[BONES], free[BONES], twistFree[BONES];
  vec3 e = target - pose.tip;
  float e2 = dot(e, e);
  Symmetric m = Symmetric(vec3((0.25 * min(e2, 0.25) + 1e-5) * damping), vec3(0.0));
  e *= min(1.0, 0.5 * inversesqrt(max(e2, 1e-20)));
  for (int i = 0; i < BONES; ++i) {
    x0[i] = pullOf(limb, pose, c, i, restPull);
    e -= x0[i] * c.radial[i];
    room[i] = roomOf(limb, pose, i, c, normal[i]);
    free[i] = 1.0;
    addOuter(m, c.radial[i], 1.0);
    addOuter(m, c.tangential[i], 1.0);
    if (mayBe(i, LIMIT_ELLIPSE)) {
      // The pull is radial; in turned columns it has two parts.
      x1[i] = -normal[i].y * x0[i];
      x0[i] = normal[i].x * x0[i];
    } else {
      x1[i] = 0.0;
    }
    if (mayBe(i, LIMIT_TWIST)) {
      x2[i] = 0.0;
      twistRoom[i] = twistRoomOf(limb, pose, i);
      twistFree[i] = 1.0;
      addOuter(m, c.twist[i], 1.0);
    }
  }
  Symmetric inverse = inverseOf(m);
  vec3 lambda = times(inverse, e);
  // Few chains meet a limit: where none of a subgroup does, the loop is skipped.
  bool again = false;
  for (int i = 0; i < BONES; ++i) {
    float x = x0[i] + dot(c.radial[i], lambda);
    again = again || x > room[i].y;
    if (mayBe(i, LIMIT_HINGE)) again = again || x < room[i].x;
    if (mayBe(i, LIMIT_TWIST)) again = again || abs(dot(c.twist[i], lambda)) > 0.0;
  }
  for (int pass = 1; pass < 3 && again; ++pass) {
    again = false;
    for (int i = 0; i < BONES; ++i) {
      hold(x0[i] + dot(c.radial[i], lambda), room[i], c.radial[i], x0[i], free[i], m, e, again);
      if (mayBe(i, LIMIT_TWIST))
        hold(dot(c.twist[i], lambda), twistRoom[i], c.twist[i], x2[i], twistFree[i], m, e, again);
    }
    if (again) {
      inverse = inverseOf(m);
      lambda = times(inverse, e);
    }
  }
  Pose trial;
  for (int step = 0; step <= chords; ++step) {
    if (step > 0) lambda = times(inverse, target - trial.tip);
    vec4 r = vec4(0.0, 0.0, 0.0, 1.0);
    vec3 p = vec3(0.0);
    for (int i = 0; i < BONES; ++i) {
      x0[i] += free[i] * dot(c.radial[i], lambda);
      x1[i] += dot(c.tangential[i], lambda);
      float along = x0[i], around = x1[i];
      if (mayBe(i, LIMIT_ELLIPSE)) {
        along = normal[i].x * x0[i] - normal[i].y * x1[i];
        around = normal[i].y * x0[i] + normal[i].x * x1[i];
      }
      trial.d[i] = turned(limb, c, i, pose.d[i], along, around);
      trial.twist[i] = pose.twist[i];
      if (mayBe(i, LIMIT_TWIST)) {
        x2[i] += twistFree[i] * dot(c.twist[i], lambda);
        turnTwist(limb, i, x2[i], trial.twist[i]);
      }
      place(limb, i, r, p, trial);
    }
    trial.tip = p;
  }
  float after = distance(target, trial.tip);
  // At rest out of reach, rounding alone must not decide; an error that is not a number is no better.
  bool kept = !lost && (after <= 1.0001 * error || after <= tolerance);
  keepIf(kept, pose, trial);
  error = kept ? after : error;
  damping = lost ? damping : (kept ? max(damping / 10.0, 1.0) : min(16.0 * damping, 4096.0));
}

#endif
