#ifndef TANGENT_RULE_GLSL
#define TANGENT_RULE_GLSL

#include "shared/spline_batch.h"

// Tangents by rule (docs/spline.md, Tangents). A side is a segment next to a point: its slope and how long it
// takes. The point's own are `before` and `after`.
struct Side {
  vec3 slope;
  float time;
};

// Barry & Goldman 1988: the parabola through three points.
vec3 parabolaTangent(Side before, Side after) {
  return (after.time * before.slope + before.time * after.slope) / (before.time + after.time);
}

vec3 cardinalTangent(Side before, Side after, float tension) {
  return (1.0 - tension) * (before.time * before.slope + after.time * after.slope) / (before.time + after.time);
}

// Kochanek & Bartels 1984, for the side that is left if `leaving`.
vec3 tcbTangent(Side before, Side after, float tension, float continuity, float bias, bool leaving) {
  float c = leaving ? continuity : -continuity;
  float past = (1.0 - tension) * (1.0 + c) * (1.0 + bias), next = (1.0 - tension) * (1.0 - c) * (1.0 - bias);
  return 0.5 * (past * before.slope + next * after.slope);
}

// Fritsch & Carlson 1980, before it is scaled.
vec3 monotoneMean(vec3 before, vec3 after) {
  return mix(vec3(0.0), 0.5 * (before + after),
             equal(sign(before) * sign(after), vec3(1.0)));
}

// By what a segment of this slope wants the tangents at its ends scaled.
vec3 monotoneScale(vec3 slope, vec3 at, vec3 end) {
  bvec3 flat_ = equal(slope, vec3(0.0));
  vec3 d = mix(slope, vec3(1.0), flat_), alpha = at / d, beta = end / d;
  return mix(min(vec3(1.0), 3.0 * inversesqrt(max(alpha * alpha + beta * beta, vec3(1e-20)))), vec3(1.0), flat_);
}

#endif
