#ifndef ACTIVE_SET_GLSL
#define ACTIVE_SET_GLSL
#include "chain.glsl"
// Damped least squares over the swing angles with an active set of limits: a joint that meets its cone is held
// there, and what it could not do is handed to the others (docs/stages.md, ik).

const float UNLIMITED = 1e9;

// A symmetric matrix: its diagonal (xx, yy, zz) and the rest (xy, xz, yz).
struct Symmetric {
  vec3 diagonal, mixed;
};

// By cofactors.
Symmetric inverseOf(Symmetric m) {
  vec3 d = m.diagonal, o = m.mixed;
  vec3 c0 = vec3(d.y * d.z - o.z * o.z, o.y * o.z - o.x * d.z, o.x * o.z - o.y * d.y);
  float k = 1.0 / dot(vec3(d.x, o.x, o.y), c0);
  return Symmetric(k * vec3(c0.x, d.x * d.z - o.y * o.y, d.x * d.y - o.x * o.x),
                   k * vec3(c0.yz, o.x * o.y - d.x * o.z));
}

vec3 times(Symmetric m, vec3 v) {
  return m.diagonal * v + vec3(m.mixed.x * v.y + m.mixed.y * v.z, m.mixed.x * v.x + m.mixed.z * v.z,
                               m.mixed.y * v.x + m.mixed.z * v.y);
}

void addOuter(inout Symmetric m, vec3 c, float weight) {
  vec3 w = weight * c;
  m.diagonal += w * c;
  m.mixed += vec3(w.x * c.yz, w.y * c.z);
}

// From `pose`, whose forward kinematics are done, one step and `chords` chord steps. On return its directions, its
// tip and `error` are the new ones if they are better; joints and parents are not brought up to date. A `lost`
// target, one that is not finite, keeps the pose to the bit.
void activeSet(Limb limb, vec3 target, bool lost, int chords, float restPull, float tolerance, inout Pose pose,
               inout float error, inout float damping) {
  vec3 radial[BONES], tangential[BONES], d[BONES];
  vec2 h[BONES];
  float s[BONES], room[BONES], x0[BONES], x1[BONES], free[BONES];
  vec3 e = target - pose.tip;
  float e2 = dot(e, e);
  Symmetric m = Symmetric(vec3((0.25 * min(e2, 0.25) + 1e-5) * damping), vec3(0.0));
  e *= min(1.0, 0.5 * inversesqrt(max(e2, 1e-20)));
  for (int i = 0; i < BONES; ++i) {
    vec3 b = pose.d[i];
    float s2 = dot(b.xy, b.xy), inverse = inversesqrt(max(s2, 1e-12));
    s[i] = s2 * inverse;
    h[i] = s2 < 1e-12 ? vec2(1.0, 0.0) : b.xy * inverse;
    vec3 u = rotate(pose.parent[i], h[i].x * limb.y[i] - h[i].y * limb.x[i]);
    vec3 w = rotate(pose.parent[i], h[i].x * limb.x[i] + h[i].y * limb.y[i]);
    vec3 r = pose.tip - pose.joint[i];
    float present = limb.bone[i] == 0.0 ? 0.0 : 1.0;
    radial[i] = present * cross(u, r);
    tangential[i] = present * cross(cross(w, u) * (s[i] / max(1.0 + b.z, 1e-6)) - w, r);
    float below = limb.cosLimit[i] * b.z + limb.sinLimit[i] * s[i];
    room[i] = below < 0.1 ? UNLIMITED : (limb.sinLimit[i] * b.z - limb.cosLimit[i] * s[i]) / below;
    x0[i] = -restPull * limb.stiffness[i] * s[i];
    e -= x0[i] * radial[i];
    free[i] = 1.0;
    addOuter(m, radial[i], 1.0);
    addOuter(m, tangential[i], 1.0);
  }
  Symmetric inverse = inverseOf(m);
  vec3 lambda = times(inverse, e);
  // Few chains meet a limit: where none of a subgroup does, the loop ends after one look.
  bool again = true;
  for (int pass = 1; pass < 3 && again; ++pass) {
    again = false;
    for (int i = 0; i < BONES; ++i) {
      bool held = free[i] > 0.0 && x0[i] + dot(radial[i], lambda) > room[i];
      addOuter(m, radial[i], held ? -1.0 : 0.0);
      e -= (held ? room[i] - x0[i] : 0.0) * radial[i];
      x0[i] = held ? room[i] : x0[i];
      free[i] = held ? 0.0 : free[i];
      again = again || held;
    }
    if (again) {
      inverse = inverseOf(m);
      lambda = times(inverse, e);
    }
  }
  for (int i = 0; i < BONES; ++i) x1[i] = 0.0;
  vec3 tip;
  for (int step = 0; step <= chords; ++step) {
    if (step > 0) lambda = times(inverse, target - tip);
    vec4 r = vec4(0.0, 0.0, 0.0, 1.0);
    tip = vec3(0.0);
    for (int i = 0; i < BONES; ++i) {
      x0[i] += free[i] * dot(radial[i], lambda);
      x1[i] += dot(tangential[i], lambda);
      vec3 b = pose.d[i];
      d[i] = clampCone(unit(b + x0[i] * vec3(h[i] * b.z, -s[i]) + x1[i] * vec3(-h[i].y, h[i].x, 0.0)),
                       limb.cosLimit[i], limb.sinLimit[i]);
      r = swung(limb, i, r, d[i]);
      tip += limb.bone[i] * rotate(r, limb.z[i]);
    }
  }
  float after = distance(target, tip);
  // At rest out of reach, rounding alone must not decide.
  bool kept = !lost && !(after > 1.0001 * error && after > tolerance);
  for (int i = 0; i < BONES; ++i) pose.d[i] = kept ? d[i] : pose.d[i];
  pose.tip = kept ? tip : pose.tip;
  error = kept ? after : error;
  damping = lost ? damping : (kept ? max(damping / 10.0, 1.0) : min(16.0 * damping, 4096.0));
}

#endif
