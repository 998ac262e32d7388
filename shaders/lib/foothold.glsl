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

#endif
