#ifndef CUBIC_GLSL
#define CUBIC_GLSL

// One cubic Hermite segment over s in [0, 1] (docs/spline.md).
struct Cubic {
  vec3 p, a, c, e;  // P = p + s (a + s (c + s e))
};

// From p0 with tangent a to p1 with tangent b, both over s.
Cubic cubicOf(vec3 p0, vec3 a, vec3 p1, vec3 b) {
  vec3 d = p1 - p0;
  return Cubic(p0, a, 3.0 * d - 2.0 * a - b, a + b - 2.0 * d);
}

vec3 cubicPoint(Cubic w, float s) { return w.p + s * (w.a + s * (w.c + s * w.e)); }
// dP/ds
vec3 cubicTangent(Cubic w, float s) { return w.a + s * (2.0 * w.c + 3.0 * s * w.e); }

// Gauss-Legendre, 8 nodes: of the speed on middle +- reach.
float cubicSpeedSum(Cubic w, float middle, float reach) {
  const vec4 node = vec4(0.1834346424956498, 0.5255324099163290, 0.7966664774136267, 0.9602898564975363);
  const vec4 weight = vec4(0.3626837833783620, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763);
  vec4 at = reach * node;
  vec4 low = vec4(length(cubicTangent(w, middle - at.x)), length(cubicTangent(w, middle - at.y)),
                  length(cubicTangent(w, middle - at.z)), length(cubicTangent(w, middle - at.w)));
  vec4 high = vec4(length(cubicTangent(w, middle + at.x)), length(cubicTangent(w, middle + at.y)),
                   length(cubicTangent(w, middle + at.z)), length(cubicTangent(w, middle + at.w)));
  return reach * dot(weight, low + high);
}

// Arc length from 0 to s: each half of it on its own.
float cubicLength(Cubic w, float s) {
  return cubicSpeedSum(w, 0.25 * s, 0.25 * s) + cubicSpeedSum(w, 0.75 * s, 0.25 * s);
}

// Where the arc length from 0 is `wanted`, of `whole` = cubicLength(w, 1): Newton's method within a bracket.
float cubicAtLength(Cubic w, float wanted, float whole) {
  float s = clamp(wanted / max(whole, 1e-30), 0.0, 1.0), low = 0.0, high = 1.0;
  for (int k = 0; k < 24; ++k) {
    float off = cubicLength(w, s) - wanted;
    if (!(abs(off) > 1e-6 * whole)) break;
    if (off < 0.0) low = s; else high = s;
    float next = s - off / length(cubicTangent(w, s));
    s = next > low && next < high ? next : 0.5 * (low + high);
  }
  return s;
}

#endif
