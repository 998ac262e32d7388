#ifndef FOOTHOLD_GLSL
#define FOOTHOLD_GLSL
// Point collection (docs/stages.md, foothold): a ladder of rungs from the leg's root toward its predicted
// landing, each rung as wide as its number.

const int RUNGS = 4;
const int CENTRE_RUNG = 3;  // its middle is the predicted landing itself

struct Candidate {
  vec3 point;      // relative to the body
  float distance;  // from the root
  float score;
  bool fits;
};

Candidate judge(Parameters q, vec3 point, vec3 gradient, vec3 up, vec3 root, vec3 predicted, float reach) {
  Candidate c;
  c.point = point;
  c.distance = distance(point, root);
  float aligned = dot(unit(vec3(-gradient.y, 1.0, -gradient.z)), up);
  c.fits = c.distance >= q.reachLeast * reach && c.distance <= q.reachMost * reach && aligned >= q.slopeLeast;
  vec3 miss = (point - predicted) / q.legLength;
  float stretched = max(0.0, c.distance / reach - q.reachComfort);
  c.score = dot(miss, miss);
  if (q.nearestOnly == 0.0) c.score += q.slopeWeight * (1.0 - aligned) + q.reachWeight * stretched * stretched;
  return c;
}

// Height of the lift that clears the ground between, sampled where the spline of a fresh step has 5/8, all and
// 5/8 of its lift.
const vec3 LIFT_AT = vec3(3.0 / 16.0, 0.5, 13.0 / 16.0);
const vec3 LIFT_SHARE = vec3(5.0 / 8.0, 1.0, 5.0 / 8.0);

float liftHeight(Parameters q, vec3 gaps, float upright, float share) {
  float c = q.stepHeight * share;
  for (int i = 0; i < 3; ++i) {
    float needed = (gaps[i] * upright + q.stepClearance) / LIFT_SHARE[i];
    c = gaps[i] > -q.stepClearance ? max(c, needed) : c;
  }
  return min(c, q.stepHeightMax);
}

#endif
