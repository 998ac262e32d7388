#ifndef ROUTE_GLSL
#define ROUTE_GLSL
// The way of a step over what lies between (docs/stages/foothold.md): a grid of WAYS lanes, bowed to the sides,
// by SAMPLES places along each, and the shortest lift vector that clears the ground at all places of its lane.

const int WAYS = 5;
const int SAMPLES = 7;
// Lanes in the order in which ties are decided, the middle first: 0, -1, 1, -2, 2.
float sideOf(int lane) { return float((lane + 1) / 2 * ((lane & 1) == 1 ? -1 : 1)); }
// Where the spline of a step is looked at, u = 1/8 to 7/8: its Hermite weights h01, h11 and h10 of its half.
const float AT[4] = float[](0.25, 0.5, 0.75, 1.0);

// What is above the step's greatest height costs so many times what is below.
const float ROUTE_FORBIDDEN = 100.0;

struct Place {
  vec3 straight;   // without the lift
  float share;     // of the lift vector
  float clearing;  // of the clearance that is asked for: feet stand on the ground at both ends
};

// `m0` counts where the start is not the lift itself.
Place placeOf(vec3 p0, vec3 p1, bool free, vec3 m0, int i) {
  float s = AT[i < 4 ? i : 6 - i];
  float h01 = s * s * (3.0 - 2.0 * s), h10 = s * (s - 1.0) * (s - 1.0), h11 = s * s * (s - 1.0);
  float along = 0.5 * (h01 + h11), share = h01 + h10;
  Place p;
  p.clearing = share;
  bool first = i < 3;
  p.share = first && free ? h01 : share;
  p.straight = mix(p0, p1, first ? along : 1.0 - along) + (first && free ? h10 * m0 : vec3(0.0));
  return p;
}

#endif
