#ifndef COLUMNS_GLSL
#define COLUMNS_GLSL
#include "chain.glsl"
#include "symmetric.glsl"
// How a limited chain's tip moves with its joints, and how joints are moved (docs/ik.md, Jacobian family).

layout(constant_id = CONSTANT_PADDED) const bool PADDED = true;

// Movement of the tip a radian: as a bone's direction goes the ways of X and of Y, and with its twist. A hinge has
// the second alone. Stereographic coordinates keep angles, so the two ways are perpendicular, and no sine or
// cosine of how far and to where the bone leans is needed.
struct Columns {
  vec3 x[BONES], y[BONES], twist[BONES];
};

// A free ball's ways, changed to a radian of its frame's turn: the way around grows without bound in radians of its
// direction as that comes to point against rest.
void evenWays(vec2 s, inout vec3 x, inout vec3 y) {
  float s2 = dot(s, s);
  vec2 around = vec2(-s.y, s.x) * inversesqrt(max(s2, 1e-20));
  vec3 less = (1.0 - inversesqrt(1.0 + s2)) * (around.x * x + around.y * y);
  x -= around.x * less;
  y -= around.y * less;
}

// `end` is the tip, or what stands for it.
void columnsOf(Limb limb, Pose pose, vec3 end, inout Columns c) {
  for (int i = 0; i < BONES; ++i) {
    // Some compilers would cancel the joint where they see how the tip came about, and solve a chain otherwise in
    // one kernel than in another.
    precise vec3 r = end - pose.joint[i];
    if (PADDED) r = limb.bone[i] == 0.0 ? vec3(0.0) : r;
    c.x[i] = isKind(i, LIMIT_HINGE) ? vec3(0.0) : cross(pose.aboutX[i], r);
    c.y[i] = cross(pose.aboutY[i], r);
    if (isFree(i)) evenWays(pose.swing[i], c.x[i], c.y[i]);
    c.twist[i] = isKind(i, LIMIT_TWIST) && limb.twists[i].y > limb.twists[i].x ? cross(pose.aboutBone[i], r) : vec3(0.0);
  }
}

void addOuter(inout Symmetric m, Columns c, int i) {
  if (!isKind(i, LIMIT_HINGE)) addOuter(m, c.x[i], 1.0);
  addOuter(m, c.y[i], 1.0);
  if (isKind(i, LIMIT_TWIST)) addOuter(m, c.twist[i], 1.0);
}

vec2 stepOf(Columns c, int i, vec3 lambda) {
  return vec2(isKind(i, LIMIT_HINGE) ? 0.0 : dot(c.x[i], lambda), dot(c.y[i], lambda));
}

// The step toward rest of a bone at `s`, as far as `share` of its sine.
vec2 towardRest(vec2 s, float share) { return s * (-share * (2.0 / (1.0 + dot(s, s)))); }

// A bone's direction after a step along the columns, not yet divided: n (d.x, d.y), n (1 + d.z), n.
vec4 stepped(vec2 s, vec2 x) {
  float k = 2.0 / (1.0 + dot(s, s)), m = k - k * dot(s, x), n = sqrt(1.0 + dot(x, x));
  return vec4(m * s + x, n + m - 1.0, n);
}

// The same of a free ball: the quaternion of its turn, (1, -Y, X, 0), goes on past the point opposite to rest.
vec4 steppedFree(vec2 s, vec2 x) {
  float s2 = dot(s, s);
  vec2 around = vec2(-s.y, s.x) * inversesqrt(max(s2, 1e-20));
  vec2 xy = s + 0.5 * (x + (sqrt(1.0 + s2) - 1.0) * dot(x, around) * around);
  float w = 1.0 - 0.5 * dot(s, x);
  return vec4(w < 0.0 ? -xy : xy, abs(w), 1.0);
}

vec2 turned(Limb limb, int i, vec2 s, vec2 x) {
  vec4 to = isFree(i) ? steppedFree(s, x) : stepped(s, x);
  return clampSwing(limb, i, to.xy, to.z, to.w);
}

// The damping of the next solve, after Levenberg and Marquardt.
float dampingAfter(bool kept, float damping) {
  return kept ? max(0.1 * damping, 1.0) : min(16.0 * damping, 4096.0);
}

void turnTwist(Limb limb, int i, float x, inout float twist) {
  float t = 0.5 * clamp(x, -1.0, 1.0), below = 1.0 - twist * t;
  float turned = below < 0.1 ? (t > 0.0 ? limb.twists[i].y : limb.twists[i].x) : (twist + t) / max(below, 0.1);
  twist = clamp(turned, limb.twists[i].x, limb.twists[i].y);
}

#endif
