#ifndef LIMITS_GLSL
#define LIMITS_GLSL
#include "math.glsl"
// What each kind of limit allows (docs/ik.md, Chain). Angles stay half-angle tangents and cosines: only an
// ellipse needs trigonometry, in polynomials of our own, as Vulkan's may be off by 5e-4.

layout(constant_id = CONSTANT_LIMITS_LOW) const uint LIMITS_LOW = 0x11111111u;
layout(constant_id = CONSTANT_LIMITS_HIGH) const uint LIMITS_HIGH = 0x11111111u;

#ifdef ONLY_CONES
// Known to every compiler, where specialization alone leaves the other kinds' code to drivers that do not unroll.
bool isKind(int bone, int kind) { return kind == LIMIT_CONE; }
#else
// A bone's kind of limit, or whether it has a twist: known when the pipeline is made, so what a bone has not costs nothing.
bool isKind(int bone, int kind) {
  return (((bone < 8 ? LIMITS_LOW : LIMITS_HIGH) >> uint(4 * (bone & 7))) & uint(kind)) != 0u;
}
#endif

// Abramowitz & Stegun 4.4.49, error 2e-8 within [0, 1].
float arctangent(float x) {
  float y = x > 1.0 ? 1.0 / x : x, z = y * y;
  float p = 0.0028662257;
  p = p * z - 0.0161657367;
  p = p * z + 0.0429096138;
  p = p * z - 0.0752896400;
  p = p * z + 0.1065626393;
  p = p * z - 0.1420889944;
  p = p * z + 0.1999355085;
  p = p * z - 0.3333314528;
  p = (p * z + 1.0) * y;
  return x > 1.0 ? 1.57079632679 - p : p;
}

// Abramowitz & Stegun 4.3.97 and 4.3.99, error 2e-9 within [0, pi/2].
vec2 cosineSine(float x) {
  float z = x * x;
  float c = ((((-0.0000002605 * z + 0.0000247609) * z - 0.0013888397) * z + 0.0416666418) * z - 0.4999999963) * z;
  float s = ((((-0.0000000239 * z + 0.0000027526) * z - 0.0001984090) * z + 0.0083333315) * z - 0.1666666664) * z;
  return vec2(c + 1.0, (s + 1.0) * x);
}

vec2 ellipseAxes(vec4 ellipse, vec2 lean) {
  return vec2(lean.x < 0.0 ? ellipse.z : ellipse.x, lean.y < 0.0 ? ellipse.w : ellipse.y);
}

// tan(theta_max / 2) toward `lean`.
float ellipseEdge(vec4 ellipse, vec2 lean) {
  vec2 n = lean / ellipseAxes(ellipse, lean), half_ = cosineSine(0.5 * inversesqrt(max(dot(n, n), 0.1)));
  return half_.y / half_.x;
}

// Directions are divided into (X, Y) here: `xy` and `below` are n (d.x, d.y) and n (1 + d.z), n not 0. Straight against
// the rest direction every way to lean is as good: one of them, not what rounding says.
bool isAgainst(float s2, float below, float n) { return s2 < 1e-6 * n * n && below < n; }

// `edge`: tan(theta_max / 2) toward where the direction leans; s2: of `xy`.
vec2 clampBall(vec2 xy, float below, float s2, bool against, float edge) {
  bool outside = s2 > edge * edge * below * below;
  float over = outside ? sqrt(max(s2, 1e-20)) : max(below, 1e-6);
  return against ? vec2(edge, 0.0) : xy * ((outside ? edge : 1.0) / over);
}

// `range`: tangents of half the least and the greatest angle.
vec2 clampHinge(float y, float below, vec2 range) {
  return vec2(0.0, clamp(y / max(below, 1e-6), -range.y, -range.x));
}

#endif
