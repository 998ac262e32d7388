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
bool isFree(int bone) { return false; }
#else
// A bone's kind of limit, or whether it has a twist: known when the pipeline is made, so what a bone has not costs nothing.
bool isKind(int bone, int kind) {
  return (((bone < 8 ? LIMITS_LOW : LIMITS_HIGH) >> uint(4 * (bone & 7))) & uint(kind)) != 0u;
}
// A ball without limit.
bool isFree(int bone) { return !isKind(bone, LIMIT_CONE | LIMIT_ELLIPSE | LIMIT_HINGE); }
#endif

// Whether a bone's limit keeps numbers of its own in the bone's record, a limb's `ends`.
bool hasEnds(int bone) { return isKind(bone, LIMIT_ELLIPSE | LIMIT_HINGE); }

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

// (X, Y) within bone i's limit of the direction n (d.x, d.y), n (1 + d.z).
vec2 clampToLimit(int i, float edge, vec4 ends, vec2 xy, float below, float n) {
  if (isKind(i, LIMIT_HINGE)) return clampHinge(xy.y, below, ends.xy);
  float s2 = dot(xy, xy);
  // A free ball keeps its way as long as it has any.
  bool against = isFree(i) ? s2 == 0.0 && below <= 0.0 : isAgainst(s2, below, n);
  if (isKind(i, LIMIT_ELLIPSE)) edge = ellipseEdge(ends, against ? vec2(1.0, 0.0) : xy * inversesqrt(max(s2, 1e-20)));
  return clampBall(xy, below, s2, against, edge);
}

// Room is how far a bone may go down and up a way before it meets its limit: the tangent of the angle left.
const float UNLIMITED = 1e9;

// tan(end - q), q = -2 atan(y).
vec2 hingeRoom(vec2 ends, float y) {
  vec2 to = ends + y, over = 1.0 - ends * y;
  vec2 sines = 2.0 * to * over, cosines = over * over - to * to, least = 0.1 * (over * over + to * to);
  return vec2(cosines.x < least.x ? -UNLIMITED : sines.x / cosines.x,
              cosines.y < least.y ? UNLIMITED : sines.y / cosines.y);
}

// tan(alpha - theta) by half tangents; r: tan(theta / 2).
float coneRoom(float edge, float r) {
  float to = edge - r, over = 1.0 + edge * r;
  float cosine = over * over - to * to;
  return cosine < 0.1 * (over * over + to * to) ? UNLIMITED : 2.0 * to * over / cosine;
}

// Across the ellipse's level line, which `h`, the unit way from rest, is turned to.
float ellipseRoom(vec4 ellipse, float s2, float r, inout vec2 h) {
  float theta = 2.0 * arctangent(r);
  vec2 axes = ellipseAxes(ellipse, h), n = theta * h / (axes * axes);
  float share = sqrt(theta * dot(h, n));
  // theta / sin(theta) turns what is across h.
  vec2 slope = vec2(dot(h, n), (h.x * n.y - h.y * n.x) * theta * (1.0 + s2) * 0.5 / max(r, 1e-6));
  bool small = theta < 1e-3;
  vec2 normal = small ? vec2(1.0, 0.0) : unit(slope);
  h = vec2(normal.x * h.x - normal.y * h.y, normal.x * h.y + normal.y * h.x);
  return small ? UNLIMITED : (1.0 - share) * share * inversesqrt(max(dot(slope, slope), 1e-20));
}

// The way in which bone i at (X, Y) = s is limited, a unit vector in its (X, Y), and the room along it.
void roomOf(int i, float edge, vec4 ends, vec2 s, out vec2 along, out vec2 room) {
  if (isKind(i, LIMIT_HINGE)) {
    along = vec2(0.0, -1.0);
    room = hingeRoom(ends.xy, s.y);
  } else {
    float s2 = dot(s, s), inverse = inversesqrt(max(s2, 1e-20)), r = s2 * inverse;
    along = s2 < 1e-13 ? vec2(1.0, 0.0) : s * inverse;
    room.x = -UNLIMITED;
    if (isKind(i, LIMIT_ELLIPSE))
      room.y = ellipseRoom(ends, s2, r, along);
    else
      room.y = isFree(i) ? UNLIMITED : coneRoom(edge, r);
  }
}

// The room of a twist, tan(tau / 2), down and up; `ends` likewise.
vec2 twistRoom(vec2 ends, float twist) {
  vec2 below = 1.0 + ends * twist, room = 2.0 * (ends - twist) / max(below, vec2(0.1));
  return vec2(below.x < 0.1 ? -UNLIMITED : room.x, below.y < 0.1 ? UNLIMITED : room.y);
}

#endif
