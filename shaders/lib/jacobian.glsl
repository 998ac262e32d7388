#ifndef JACOBIAN_GLSL
#define JACOBIAN_GLSL
#include "columns.glsl"
// The Jacobian family on a limited chain, each step clamped afterwards (docs/ik.md; Buss 2004).

// The larger of a step's parts away from rest and around it.
float largestPart(vec2 s, vec2 x) {
  float s2 = dot(s, s);
  vec2 h = s2 < 1e-13 ? vec2(1.0, 0.0) : s * inversesqrt(max(s2, 1e-20));
  return max(abs(dot(h, x)), abs(h.x * x.y - h.y * x.x));
}

void jacobianIteration(Limb limb, vec3 target, int solver, inout Pose pose) {
  Columns c;
  columnsOf(limb, pose, solver == SOLVER_TARGET_ATTACHED ? target : pose.tip, c);
  vec3 e = target - pose.tip;
  float e2 = dot(e, e), pull = min(0.05, sqrt(e2));
  e *= min(1.0, 0.5 * inversesqrt(max(e2, 1e-20)));
  Symmetric m = Symmetric(vec3(0.0), vec3(0.0));
  vec2 x[BONES];
  for (int i = 0; i < BONES; ++i) {
    addOuter(m, c, i);
    x[i] = solver == SOLVER_PSEUDOINVERSE ? towardRest(pose.swing[i], pull) : vec2(0.0);
    e -= x[i].x * c.x[i] + x[i].y * c.y[i];
  }
  vec3 lambda = lambdaOf(solver, m, e);
  float largest = 0.0;
  for (int i = 0; i < BONES; ++i) {
    x[i] += stepOf(c, i, lambda);
    largest = max(largest, largestPart(pose.swing[i], x[i]));
    if (isKind(i, LIMIT_TWIST)) largest = max(largest, abs(dot(c.twist[i], lambda)));
  }
  float share = 1.0 / max(largest, 1.0);
  for (int i = 0; i < BONES; ++i) {
    vec2 s = turned(limb, i, pose.swing[i], share * x[i]);
    pose.swing[i] = limb.bone[i] > 0.0 ? s : pose.swing[i];
    if (isKind(i, LIMIT_TWIST)) turnTwist(limb, i, share * dot(c.twist[i], lambda), pose.twist[i]);
  }
  forwardKinematics(limb, pose);
}

#endif
