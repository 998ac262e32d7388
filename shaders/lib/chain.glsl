#ifndef CHAIN_GLSL
#define CHAIN_GLSL
#include "limits.glsl"
// A limited chain as the solvers see it (docs/ik.md): lengths in units of the reach, base at the origin. The
// including shader defines BONES, a specialization constant; every loop over it unrolls.

struct Limb {
  vec3 x[BONES], y[BONES], z[BONES];  // bone frames B_i
  float bone[BONES];                  // lengths; 0 pads a shorter limb
  float cosLimit[BONES], sinLimit[BONES];  // of cones
  float stiffness[BONES];
  vec4 ends[BONES];  // an ellipse's half-angles; a hinge's ends and its bone's x and z in its frame
  vec4 kind[BONES];  // kind of limit, twist's ends
};

// A pose: local directions d_i and twists tan(tau_i / 2), and what forward kinematics makes of them.
struct Pose {
  vec3 d[BONES];
  float twist[BONES];
  vec3 joint[BONES];   // p_i, where bone i starts
  vec4 parent[BONES];  // R_(i-1), without R_0
  vec3 tip;
};

vec3 fromStereographic(vec2 s) {
  float k = 2.0 / (1.0 + dot(s, s));
  return vec3(k * s, k - 1.0);
}
vec2 toStereographic(vec3 d) { return d.xy / (1.0 + max(d.z, -0.999999)); }

bool isKind(Limb limb, int i, int kind) {
  return mustBe(i, kind) || (mayBe(i, kind) && limb.kind[i].x == float(kind));
}

vec3 clampLimit(Limb limb, int i, vec3 d) {
  vec3 c = d;
  if (mayBe(i, LIMIT_CONE)) c = clampCone(d, limb.cosLimit[i], limb.sinLimit[i]);
  if (mayBe(i, LIMIT_ELLIPSE)) c = isKind(limb, i, LIMIT_ELLIPSE) ? clampEllipse(d, limb.ends[i]) : c;
  if (mayBe(i, LIMIT_HINGE)) c = isKind(limb, i, LIMIT_HINGE) ? clampHinge(d, limb.ends[i].xy) : c;
  return c;
}

// A bone's direction in the axes that R_i turns.
vec3 boneAxis(Limb limb, int i) {
  if (!mayBe(i, LIMIT_HINGE)) return limb.z[i];
  vec3 hinged = limb.ends[i].z * limb.x[i] + limb.ends[i].w * limb.z[i];
  return isKind(limb, i, LIMIT_HINGE) ? hinged : limb.z[i];
}

// R_i from R_(i-1) and d_i: the shortest rotation of the rest direction onto the bone, then its twist.
vec4 swung(Limb limb, int i, vec4 parent, vec3 d, float twist) {
  vec3 axis = limb.y[i] * d.x - limb.x[i] * d.y;
  vec4 q = vec4(axis, 1.0 + d.z);
  vec4 r = quaternionProduct(parent, q * inversesqrt(max(dot(q, q), 1e-12)));
  if (mayBe(i, LIMIT_TWIST))
    r = quaternionProduct(r, vec4(twist * limb.z[i], 1.0) * inversesqrt(1.0 + twist * twist));
  return r;
}

// FK of bone i: where it starts, and what the next one starts from.
void place(Limb limb, int i, inout vec4 r, inout vec3 p, inout Pose pose) {
  pose.joint[i] = p;
  pose.parent[i] = r;
  r = swung(limb, i, r, pose.d[i], pose.twist[i]);
  p += limb.bone[i] * rotate(r, boneAxis(limb, i));
}

void forwardKinematics(Limb limb, inout Pose pose) {
  vec4 r = vec4(0.0, 0.0, 0.0, 1.0);
  vec3 p = vec3(0.0);
  for (int i = 0; i < BONES; ++i) place(limb, i, r, p, pose);
  pose.tip = p;
}

void keepIf(bool keep, inout Pose best, Pose candidate) {
  for (int i = 0; i < BONES; ++i) {
    best.d[i] = keep ? candidate.d[i] : best.d[i];
    best.twist[i] = keep ? candidate.twist[i] : best.twist[i];
    best.joint[i] = keep ? candidate.joint[i] : best.joint[i];
    best.parent[i] = keep ? candidate.parent[i] : best.parent[i];
  }
  best.tip = keep ? candidate.tip : best.tip;
}

// The rest pose, within the limits; where they do not forbid it nothing is turned.
void restPose(Limb limb, bool legal, inout Pose pose) {
  vec3 p = vec3(0.0);
  for (int i = 0; i < BONES; ++i) {
    pose.d[i] = vec3(0.0, 0.0, 1.0);
    pose.twist[i] = 0.0;
    pose.joint[i] = p;
    pose.parent[i] = vec4(0.0, 0.0, 0.0, 1.0);
    p += limb.bone[i] * boneAxis(limb, i);
    if (!legal) pose.d[i] = clampLimit(limb, i, pose.d[i]);
    if (!legal && mayBe(i, LIMIT_TWIST)) pose.twist[i] = clamp(0.0, limb.kind[i].y, limb.kind[i].z);
  }
  pose.tip = p;
  if (!legal) forwardKinematics(limb, pose);
}

// A straight chain with its target nearer on the same line would never bend: bend it first.
bool deadlocked(vec3 target, Pose pose) {
  vec3 line = unit(pose.tip);
  float off = 0.0;
  for (int i = 1; i < BONES; ++i) {
    vec3 away = cross(line, pose.joint[i]);
    off = max(off, dot(away, away));
  }
  return off < 1e-6 && length(target) < 0.999 * length(pose.tip);
}

void bend(Limb limb, inout Pose pose) {
  for (int i = 0; i < BONES; ++i) {
    vec2 s = toStereographic(pose.d[i]);
    float by = limb.bone[i] == 0.0 ? 0.0 : i == 0 ? -0.025 * float(BONES - 1) : 0.05;
    s += isKind(limb, i, LIMIT_HINGE) ? vec2(0.0, by) : vec2(by, 0.0);
    pose.d[i] = clampLimit(limb, i, fromStereographic(s));
  }
  forwardKinematics(limb, pose);
}

#endif
