#ifndef FOOTHOLD_GLSL
#define FOOTHOLD_GLSL
// Point collection (docs/stages/foothold.md): a ladder of rungs from the leg's root toward its predicted
// landing, each rung as wide as its number.

const int RUNGS = 4;
const int PLACES = RUNGS * (RUNGS + 2);
const int AT_ONCE = 3;      // of the places, whose number it divides
const int CENTRE_RUNG = 3;  // its middle is the predicted landing itself

// Relative to the body: the predicted landing, and the ways from a rung to the next and along it to the next place.
struct Ladder {
  vec3 predicted, along, across;
};

// Its height is that of the prediction.
vec3 placeOn(Ladder ladder, int rung, int place) {
  return ladder.predicted + ladder.along * float(rung - CENTRE_RUNG) + ladder.across * float(place);
}

struct Candidate {
  vec3 point;      // relative to the body
  float distance;  // from the root
  float score;
  bool fits;
};

// Distances from the root at which a foothold fits, 1 / reach and 1 / legLength^2.
struct Range {
  float least, most, inverseReach, inverseSquare;
};

Range rangeOf(Parameters q, float reach) {
  return Range(q.reachLeast * reach, q.reachMost * reach, 1.0 / reach, 1.0 / (q.legLength * q.legLength));
}

// Cosine between ground of a gradient and the body's up axis.
float facing(vec2 gradient, vec3 up) {
  return (up.y - gradient.x * up.x - gradient.y * up.z) * inversesqrt(dot(gradient, gradient) + 1.0);
}

Candidate judge(Parameters q, vec3 point, vec3 gradient, vec3 up, vec3 root, vec3 predicted, Range range) {
  Candidate c;
  c.point = point;
  c.distance = distance(point, root);
  float aligned = facing(gradient.yz, up);
  c.fits = c.distance >= range.least && c.distance <= range.most && aligned >= q.slopeLeast;
  vec3 miss = point - predicted;
  float stretched = max(0.0, c.distance * range.inverseReach - q.reachComfort);
  c.score = dot(miss, miss) * range.inverseSquare;
  if (q.nearestOnly == 0.0) c.score += q.slopeWeight * (1.0 - aligned) + q.reachWeight * stretched * stretched;
  return c;
}

#endif
