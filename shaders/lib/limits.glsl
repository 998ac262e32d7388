#ifndef LIMITS_GLSL
#define LIMITS_GLSL
#include "math.glsl"
// What each kind of limit allows (docs/ik.md, Chain). Angles stay half-angle tangents and cosines: only an
// ellipse needs trigonometry, in polynomials of our own, as Vulkan's may be off by 5e-4.

layout(constant_id = CONSTANT_LIMITS_LOW) const uint LIMITS_LOW = 0x11111111u;
layout(constant_id = CONSTANT_LIMITS_HIGH) const uint LIMITS_HIGH = 0x11111111u;

#ifdef ONLY_CONES
// Known to every compiler, where specialization alone leaves the other kinds' code to drivers that do not unroll.
bool mayBe(int bone, int kind) { return (kind & LIMIT_CONE) != 0; }
bool mustBe(int bone, int kind) { return kind == LIMIT_CONE; }
#else
// Whether a kind may occur at a bone: known when the pipeline is made, so what cannot occur costs nothing.
bool mayBe(int bone, int kind) {
  return (((bone < 8 ? LIMITS_LOW : LIMITS_HIGH) >> uint(4 * (bone & 7))) & uint(kind)) != 0u;
}
bool mustBe(int bone, int kind) {
  return (((bone < 8 ? LIMITS_LOW : LIMITS_HIGH) >> uint(4 * (bone & 7))) & 7u) == uint(kind);
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

// The way a direction leans; straight against the rest direction every way is as good: one of them, not what
// rounding says.
vec2 leanOf(vec3 d) {
  float s2 = dot(d.xy, d.xy);
  return s2 < 1e-6 ? vec2(1.0, 0.0) : d.xy * inversesqrt(max(s2, 1e-6));
}

vec3 clampCone(vec3 d, float cosLimit, float sinLimit) {
  return d.z < cosLimit ? vec3(leanOf(d) * sinLimit, cosLimit) : d;
}

vec2 ellipseAxes(vec4 ellipse, vec2 lean) {
  return vec2(lean.x < 0.0 ? ellipse.z : ellipse.x, lean.y < 0.0 ? ellipse.w : ellipse.y);
}

vec3 clampEllipse(vec3 d, vec4 ellipse) {
  vec2 lean = leanOf(d), n = lean / ellipseAxes(ellipse, lean);
  vec2 half_ = cosineSine(0.5 * inversesqrt(dot(n, n)));
  vec2 limit = vec2(half_.x * half_.x - half_.y * half_.y, 2.0 * half_.x * half_.y);
  return clampCone(d, limit.x, limit.y);
}

// `range`: tangents of half the least and the greatest angle.
vec3 clampHinge(vec3 d, vec2 range) {
  float t = clamp(-d.y / (1.0 + max(d.z, -0.999999)), range.x, range.y), k = 1.0 / (1.0 + t * t);
  return vec3(0.0, -2.0 * t * k, (1.0 - t * t) * k);
}

#endif
