#ifndef HERMITE_GLSL
#define HERMITE_GLSL
#include "lib/records.glsl"

// The swing's spline: two cubic Hermite segments through p0, (p0 + p1)/2 + lift, p1 (docs/stages/swing.md).
struct Swing {
  vec3 p0, p1, lift, m0;
};

// The swing of a step, relative to a body's position.
Swing swingOf(Step s, Arc arc, vec3 bodyLocal, vec2 bodyTile) {
  return Swing(fromStep(s.liftOff, s, bodyLocal, bodyTile), fromStep(s.landing, s, bodyLocal, bodyTile), arc.lift,
               arc.startTangent);
}

// Time, eased: a foot leaves the ground from rest and touches it at rest. A step aimed anew is under way at its
// start; its start tangent is not the lift.
float startRate(Swing w) { return w.m0 == w.lift ? 0.0 : 1.0; }
float easedTime(float u, float rate) { return u * (u * (3.0 - 2.0 * u) + rate * (1.0 - u) * (1.0 - u)); }
float easedRate(float u, float rate) { return u * (6.0 - 6.0 * u) + rate * (1.0 + u * (3.0 * u - 4.0)); }

void swingSegment(Swing w, float u, out vec3 a, out vec3 ma, out vec3 b, out vec3 mb, out float s) {
  vec3 middle = 0.5 * (w.p0 + w.p1) + w.lift, mm = 0.5 * (w.p1 - w.p0);
  bool first = u < 0.5;
  s = first ? 2.0 * u : 2.0 * u - 1.0;
  a = first ? w.p0 : middle;
  ma = first ? w.m0 : mm;
  b = first ? middle : w.p1;
  mb = first ? mm : -w.lift;
}

// Weights of A, mA, B, mB at s.
vec4 hermiteBasis(float s) {
  float s2 = s * s, s3 = s2 * s;
  return vec4(2.0 * s3 - 3.0 * s2 + 1.0, s3 - 2.0 * s2 + s, 3.0 * s2 - 2.0 * s3, s3 - s2);
}

vec3 swingPoint(Swing w, float u) {
  vec3 a, ma, b, mb;
  float s;
  swingSegment(w, u, a, ma, b, mb, s);
  vec4 h = hermiteBasis(s);
  return h.x * a + h.y * ma + h.z * b + h.w * mb;
}

vec3 swingTangent(Swing w, float u) {
  vec3 a, ma, b, mb;
  float s;
  swingSegment(w, u, a, ma, b, mb, s);
  float s2 = s * s;
  return (6.0 * s2 - 6.0 * s) * (a - b) + (3.0 * s2 - 4.0 * s + 1.0) * ma + (3.0 * s2 - 2.0 * s) * mb;
}

#endif
