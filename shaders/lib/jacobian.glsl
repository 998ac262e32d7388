#ifndef JACOBIAN_GLSL
#define JACOBIAN_GLSL
#include "columns.glsl"
// The Jacobian family on a limited chain, each step clamped afterwards (docs/ik.md; Buss 2004).

void jacobianIteration(Limb limb, vec3 target, int solver, inout Pose pose) {
  Columns c;
  columnsOf(limb, pose, solver == SOLVER_TARGET_ATTACHED ? target : pose.tip, c);
  vec3 e = target - pose.tip;
  float e2 = dot(e, e), pull = min(0.05, sqrt(e2));
  e *= min(1.0, 0.5 * inversesqrt(max(e2, 1e-20)));
  Symmetric m = Symmetric(vec3(0.0), vec3(0.0));
  float own[BONES];
  for (int i = 0; i < BONES; ++i) {
    addOuter(m, c.radial[i], 1.0);
    addOuter(m, c.tangential[i], 1.0);
    if (mayBe(i, LIMIT_TWIST)) addOuter(m, c.twist[i], 1.0);
    own[i] = 0.0;
    if (solver == SOLVER_PSEUDOINVERSE) {
      own[i] = -pull * c.s[i];
      if (mayBe(i, LIMIT_HINGE)) own[i] = isKind(limb, i, LIMIT_HINGE) ? pull * pose.d[i].y : own[i];
      e -= own[i] * c.radial[i];
    }
  }
  vec3 lambda = lambdaOf(solver, m, e);
  float largest = 0.0;
  for (int i = 0; i < BONES; ++i) {
    largest = max(largest, abs(own[i] + dot(c.radial[i], lambda)));
    largest = max(largest, abs(dot(c.tangential[i], lambda)));
    if (mayBe(i, LIMIT_TWIST)) largest = max(largest, abs(dot(c.twist[i], lambda)));
  }
  float share = 1.0 / max(largest, 1.0);
  for (int i = 0; i < BONES; ++i) {
    vec3 d = turned(limb, c, i, pose.d[i], share * (own[i] + dot(c.radial[i], lambda)),
                    share * dot(c.tangential[i], lambda));
    pose.d[i] = limb.bone[i] > 0.0 ? d : pose.d[i];
    if (mayBe(i, LIMIT_TWIST)) turnTwist(limb, i, share * dot(c.twist[i], lambda), pose.twist[i]);
  }
  forwardKinematics(limb, pose);
}

#endif
