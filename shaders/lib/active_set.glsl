#ifndef ACTIVE_SET_GLSL
#define ACTIVE_SET_GLSL
#include "chain.glsl"
// Damped least squares over the swing angles with an active set of limits: a joint that meets its cone is held
// there, and what it could not do is handed to the others (docs/stages.md, ik).

const float UNLIMITED = 1e9;

// lambda = M^-1 e of a symmetric M = (xx, yy, zz), (xy, xz, yz), by cofactors.
vec3 solveSymmetric(vec3 diagonal, vec3 mixed, vec3 e) {
  vec3 c0 = vec3(diagonal.y * diagonal.z - mixed.z * mixed.z, mixed.y * mixed.z - mixed.x * diagonal.z,
                 mixed.x * mixed.z - mixed.y * diagonal.y);
  float c11 = diagonal.x * diagonal.z - mixed.y * mixed.y, c12 = mixed.x * mixed.y - diagonal.x * mixed.z;
  float c22 = diagonal.x * diagonal.y - mixed.x * mixed.x;
  float determinant = dot(vec3(diagonal.x, mixed.x, mixed.y), c0);
  return vec3(dot(c0, e), dot(vec3(c0.y, c11, c12), e), dot(vec3(c0.z, c12, c22), e)) / determinant;
}

void addOuter(inout vec3 diagonal, inout vec3 mixed, vec3 c, float weight) {
  vec3 w = weight * c;
  diagonal += w * c;
  mixed += vec3(w.x * c.y, w.x * c.z, w.y * c.z);
}

// One step from `pose`, whose forward kinematics are done; the result's are too.
void activeSetStep(Limb limb, vec3 target, inout Pose pose, float damping, float restPull) {
  vec3 radial[BONES], tangential[BONES];
  vec2 h[BONES];
  float s[BONES], room[BONES], pull[BONES], free[BONES];
  vec3 e = target - pose.tip;
  float e2 = dot(e, e);
  float mu = (0.25 * min(e2, 0.25) + 1e-5) * damping;
  vec3 diagonal = vec3(mu), mixed = vec3(0.0);
  e *= min(1.0, 0.5 * inversesqrt(max(e2, 1e-20)));
  for (int i = 0; i < BONES; ++i) {
    vec3 d = pose.d[i];
    s[i] = length(d.xy);
    h[i] = s[i] < 1e-6 ? vec2(1.0, 0.0) : d.xy / s[i];
    vec3 u = rotate(pose.parent[i], h[i].x * limb.y[i] - h[i].y * limb.x[i]);
    vec3 w = rotate(pose.parent[i], h[i].x * limb.x[i] + h[i].y * limb.y[i]);
    vec3 z = cross(w, u);
    vec3 r = pose.tip - pose.joint[i];
    float present = limb.bone[i] == 0.0 ? 0.0 : 1.0;
    radial[i] = present * cross(u, r);
    tangential[i] = present * cross(z * (s[i] / (1.0 + d.z)) - w, r);
    float below = limb.cosLimit[i] * d.z + limb.sinLimit[i] * s[i];
    room[i] = below < 0.1 ? UNLIMITED : (limb.sinLimit[i] * d.z - limb.cosLimit[i] * s[i]) / below;
    pull[i] = -restPull * limb.stiffness[i] * s[i];
    e -= pull[i] * radial[i];
    free[i] = 1.0;
    addOuter(diagonal, mixed, radial[i], 1.0);
    addOuter(diagonal, mixed, tangential[i], 1.0);
  }
  vec3 lambda = solveSymmetric(diagonal, mixed, e);
  for (int pass = 1; pass < 3; ++pass) {
    vec3 handed = vec3(0.0);
    for (int i = 0; i < BONES; ++i) {
      bool held = free[i] > 0.0 && pull[i] + dot(radial[i], lambda) > room[i];
      handed += (held ? room[i] - pull[i] : 0.0) * radial[i];
      addOuter(diagonal, mixed, radial[i], held ? -1.0 : 0.0);
      free[i] = held ? 0.0 : free[i];
    }
    e -= handed;
    lambda = solveSymmetric(diagonal, mixed, e);
  }
  for (int i = 0; i < BONES; ++i) {
    float x0 = free[i] > 0.0 ? pull[i] + dot(radial[i], lambda) : room[i];
    float x1 = dot(tangential[i], lambda);
    vec3 d = pose.d[i];
    d += x0 * vec3(h[i] * d.z, -s[i]) + x1 * vec3(-h[i].y, h[i].x, 0.0);
    pose.d[i] = clampCone(unit(d), limb.cosLimit[i], limb.sinLimit[i]);
  }
  forwardKinematics(limb, pose);
}

#endif
