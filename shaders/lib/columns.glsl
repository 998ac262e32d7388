#ifndef COLUMNS_GLSL
#define COLUMNS_GLSL
#include "chain.glsl"
#include "symmetric.glsl"
// How a limited chain's tip moves with its joints, and how joints are moved (docs/ik.md, Jacobian family).

// Movement of the tip a radian. Balls: away from rest, around rest, twist. Hinges: the turn alone.
struct Columns {
  vec3 radial[BONES], tangential[BONES], twist[BONES];
  vec2 h[BONES];  // the way each bone leans from rest
  float s[BONES];  // the sine of its angle
};

// `end` is the tip, or what stands for it.
void columnsOf(Limb limb, Pose pose, vec3 end, inout Columns c) {
  for (int i = 0; i < BONES; ++i) {
    vec3 b = pose.d[i];
    float s2 = dot(b.xy, b.xy), inverse = inversesqrt(max(s2, 1e-12));
    c.s[i] = s2 * inverse;
    c.h[i] = s2 < 1e-12 ? vec2(1.0, 0.0) : b.xy * inverse;
    vec3 u = rotate(pose.parent[i], c.h[i].x * limb.y[i] - c.h[i].y * limb.x[i]);
    vec3 w = rotate(pose.parent[i], c.h[i].x * limb.x[i] + c.h[i].y * limb.y[i]);
    vec3 r = end - pose.joint[i];
    float present = limb.bone[i] == 0.0 ? 0.0 : 1.0;
    c.radial[i] = present * cross(u, r);
    c.tangential[i] = present * cross(cross(w, u) * (c.s[i] / max(1.0 + b.z, 1e-6)) - w, r);
    if (mayBe(i, LIMIT_HINGE)) {
      bool hinge = isKind(limb, i, LIMIT_HINGE);
      c.radial[i] = hinge ? present * cross(rotate(pose.parent[i], limb.x[i]), r) : c.radial[i];
      c.tangential[i] = hinge ? vec3(0.0) : c.tangential[i];
    }
    if (mayBe(i, LIMIT_TWIST)) {
      vec3 z = rotate(swung(limb, i, pose.parent[i], b, pose.twist[i]), limb.z[i]);
      bool free = limb.kind[i].z > limb.kind[i].y;
      c.twist[i] = free ? present * cross(z, r) : vec3(0.0);
    }
  }
}

void turnTwist(Limb limb, int i, float x, inout float twist) {
  float t = 0.5 * clamp(x, -1.0, 1.0), below = 1.0 - twist * t;
  float turned = below < 0.1 ? (t > 0.0 ? limb.kind[i].z : limb.kind[i].y) : (twist + t) / max(below, 0.1);
  twist = clamp(turned, limb.kind[i].y, limb.kind[i].z);
}

// Bone i turned by its steps x0, x1, x2 along the columns, and back within its limit. `d` and the columns are
// those of the pose that the step started from.
vec3 turned(Limb limb, Columns c, int i, vec3 d, float x0, float x1) {
  vec3 to = d + x0 * vec3(c.h[i] * d.z, -c.s[i]) + x1 * vec3(-c.h[i].y, c.h[i].x, 0.0);
  if (mayBe(i, LIMIT_HINGE))
    to = isKind(limb, i, LIMIT_HINGE) ? vec3(0.0, d.y - x0 * d.z, d.z + x0 * d.y) : to;
  return clampLimit(limb, i, unit(to));
}

#endif
