#ifndef SYMMETRIC_GLSL
#define SYMMETRIC_GLSL
#include "shared/ik_batch.h"

// A symmetric matrix: its diagonal (xx, yy, zz) and the rest (xy, xz, yz).
struct Symmetric {
  vec3 diagonal, mixed;
};

// The inverse, by cofactors: `over` times a symmetric matrix, for what is multiplied by that need not wait for the
// division.
struct Inverse {
  Symmetric adjugate;
  float over;
};

Inverse inverseOf(Symmetric m) {
  vec3 d = m.diagonal, o = m.mixed;
  vec3 c0 = vec3(d.y * d.z - o.z * o.z, o.y * o.z - o.x * d.z, o.x * o.z - o.y * d.y);
  return Inverse(Symmetric(vec3(c0.x, d.x * d.z - o.y * o.y, d.x * d.y - o.x * o.x), vec3(c0.yz, o.x * o.y - d.x * o.z)),
                 1.0 / dot(vec3(d.x, o.x, o.y), c0));
}

vec3 times(Symmetric m, vec3 v) {
  return m.diagonal * v + vec3(m.mixed.x * v.y + m.mixed.y * v.z, m.mixed.x * v.x + m.mixed.z * v.z,
                               m.mixed.y * v.x + m.mixed.z * v.y);
}

vec3 times(Inverse m, vec3 v) { return times(m.adjugate, v) * m.over; }

void addOuter(inout Symmetric m, vec3 c, float weight) {
  vec3 w = weight * c;
  m.diagonal += w * c;
  m.mixed += vec3(w.x * c.yz, w.y * c.z);
}

// What the Jacobian family multiplies its columns by; m is J J^T (docs/ik.md; Buss 2004).
vec3 lambdaOf(int solver, Symmetric m, vec3 e) {
  if (solver == SOLVER_TRANSPOSE) {
    vec3 me = times(m, e);
    float below = dot(me, me);
    return below < 1e-20 ? vec3(0.0) : e * (dot(e, me) / max(below, 1e-20));
  }
  float trace = m.diagonal.x + m.diagonal.y + m.diagonal.z;
  m.diagonal += vec3(solver == SOLVER_PSEUDOINVERSE ? 1e-6 * trace : 0.01);
  return times(inverseOf(m), e);
}

#endif
