#ifndef CHAIN_GLSL
#define CHAIN_GLSL
#include "limits.glsl"
// A limited chain as the solvers see it (docs/ik.md): lengths in units of the reach, base at the origin. The
// including shader defines BONES, a specialization constant; every loop over it unrolls. What a solver does not
// use of these structures costs it nothing.

#ifdef ONLY_CONES
const uint PARALLEL = 0u;
#else
layout(constant_id = CONSTANT_PARALLEL) const uint PARALLEL = 0u;
#endif

// Columns of a rotation.
struct Frame {
  vec3 x, y, z;
};

Frame noTurn() { return Frame(vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0), vec3(0.0, 0.0, 1.0)); }
Frame frameOf(vec4 q) { return Frame(rotate(q, vec3(1.0, 0.0, 0.0)), rotate(q, vec3(0.0, 1.0, 0.0)), rotate(q, vec3(0.0, 0.0, 1.0))); }
vec3 rotate(Frame f, vec3 v) { return f.x * v.x + f.y * v.y + f.z * v.z; }
vec3 rotateBack(Frame f, vec3 v) { return vec3(dot(f.x, v), dot(f.y, v), dot(f.z, v)); }

struct Limb {
  Frame rest[BONES];    // B_i
  Frame carry[BONES];   // B_(i-1)^T B_i, of the first bone B_0
  float bone[BONES];    // lengths; 0 pads a shorter limb
  float edge[BONES];    // of cones: tan(alpha / 2)
  float cosine[BONES];  // of cones alone, where there are no other limits: cos(alpha)
  float stiffness[BONES];
  vec4 ends[BONES];     // an ellipse's half-angles; a hinge's ends and its bone's x and z in its frame
  vec2 twists[BONES];   // tan(tau / 2) at both ends
};

// A pose: stereographic directions (X, Y) and twists tan(tau_i / 2), and what forward kinematics makes of them.
struct Pose {
  vec2 swing[BONES];
  float twist[BONES];
  vec3 joint[BONES];                  // p_i, where bone i starts
  Frame frame[BONES];                 // A_i
  vec3 aboutX[BONES], aboutY[BONES];  // what bone i turns about as its direction goes the way of X, and of Y
  vec3 aboutBone[BONES];
  vec3 tip;
};

vec3 fromStereographic(vec2 s) {
  float k = 2.0 / (1.0 + dot(s, s));
  return vec3(k * s, k - 1.0);
}

// (X, Y) within the limit of the direction n (d.x, d.y), n (1 + d.z).
vec2 clampSwing(Limb limb, int i, vec2 xy, float below, float n) {
  return clampToLimit(i, limb.edge[i], limb.ends[i], xy, below, n);
}
vec2 clampSwing(Limb limb, int i, vec3 d) { return clampSwing(limb, i, d.xy, 1.0 + d.z, 1.0); }

// Cosine and sine from the tangent of half the angle.
vec2 cosineSineOf(float tangent) {
  float k = 2.0 / (1.0 + tangent * tangent);
  return vec2(k - 1.0, k * tangent);
}

// A bone's direction, in its turned frame.
vec3 alongBone(Limb limb, int i, Frame f) {
  return isKind(i, LIMIT_HINGE) ? limb.ends[i].z * f.x + limb.ends[i].w * f.z : f.z;
}

// `turn` carried by F_(i-1). From one hinge to another about the same axis that is a turn about it.
Frame carried(int i, Frame f, Frame turn) {
  if ((PARALLEL >> uint(i) & 1u) != 0u)
    return Frame(f.x, turn.y.y * f.y + turn.y.z * f.z, turn.z.y * f.y + turn.z.z * f.z);
  return Frame(rotate(f, turn.x), rotate(f, turn.y), rotate(f, turn.z));
}

vec3 carried(int i, Frame turn, vec3 v) {
  if ((PARALLEL >> uint(i) & 1u) != 0u) return vec3(v.x, turn.y.yz * v.y + turn.z.yz * v.z);
  return rotate(turn, v);
}

// `a` by the shortest rotation of the rest direction onto the bone; k: 2 / (1 + X^2 + Y^2).
Frame swungFrame(Frame a, vec2 s, float k) {
  vec3 w = (s.x * a.x + s.y * a.y + a.z) * k;
  return Frame(a.x - s.x * w, a.y - s.y * w, w - a.z);
}

// F_i from A_i: swung, then twisted.
Frame turnedFrame(int i, Frame a, vec2 s, float twist) {
  Frame f = swungFrame(a, s, 2.0 / (1.0 + dot(s, s)));
  if (isKind(i, LIMIT_TWIST)) {
    vec2 t = cosineSineOf(twist);
    f = Frame(t.x * f.x + t.y * f.y, t.x * f.y - t.y * f.x, f.z);
  }
  return f;
}

// Bone i in its turned frame F_i: p goes from p_i to p_(i+1).
void place(Limb limb, int i, Frame f, inout vec3 p, inout Pose pose) {
  vec2 s = pose.swing[i];
  Frame swung = f;
  if (isKind(i, LIMIT_TWIST)) {
    vec2 t = cosineSineOf(pose.twist[i]);
    swung = Frame(t.x * f.x - t.y * f.y, t.x * f.y + t.y * f.x, f.z);
  }
  pose.joint[i] = p;
  pose.aboutX[i] = swung.y + s.y * f.z;
  pose.aboutY[i] = -swung.x - s.x * f.z;
  pose.aboutBone[i] = f.z;
  p += limb.bone[i] * alongBone(limb, i, f);
}

// Each bone's turn is made in the frame of the bone before, so that none waits for another; then they are carried.
void forwardKinematics(Limb limb, inout Pose pose) {
  Frame f = noTurn();
  vec3 p = vec3(0.0);
  for (int i = 0; i < BONES; ++i) {
    Frame turn = turnedFrame(i, limb.carry[i], pose.swing[i], pose.twist[i]);
    pose.frame[i] = carried(i, f, limb.carry[i]);
    f = i == 0 ? turn : carried(i, f, turn);
    place(limb, i, f, p, pose);
  }
  pose.tip = p;
}

// Where forward kinematics put the tip. From the tip on only one vector is carried along the chain.
vec3 tipOf(Limb limb, Pose pose) {
  vec3 v = vec3(0.0);
  for (int i = BONES - 1; i >= 0; --i) {
    v += limb.bone[i] * alongBone(limb, i, noTurn());
    v = carried(i, turnedFrame(i, limb.carry[i], pose.swing[i], pose.twist[i]), v);
  }
  return v;
}

// What forward kinematics start from, and the tip.
void keepIf(bool keep, inout Pose best, Pose candidate) {
  for (int i = 0; i < BONES; ++i) {
    best.swing[i] = keep ? candidate.swing[i] : best.swing[i];
    best.twist[i] = keep ? candidate.twist[i] : best.twist[i];
  }
  best.tip = keep ? candidate.tip : best.tip;
}

// The rest pose, within the limits; where they do not forbid it nothing is turned.
void restPose(Limb limb, bool legal, inout Pose pose) {
  for (int i = 0; i < BONES; ++i) {
    pose.swing[i] = legal ? vec2(0.0) : clampSwing(limb, i, vec3(0.0, 0.0, 1.0));
    pose.twist[i] = legal || !isKind(i, LIMIT_TWIST) ? 0.0 : clamp(0.0, limb.twists[i].x, limb.twists[i].y);
  }
  forwardKinematics(limb, pose);
}

// R_i from R_(i-1), as quaternions.
vec4 swung(Limb limb, int i, vec4 parent, Pose pose) {
  Frame b = limb.rest[i];
  vec2 s = pose.swing[i];
  vec4 r = quaternionProduct(parent, vec4(b.y * s.x - b.x * s.y, 1.0) * inversesqrt(1.0 + dot(s, s)));
  if (isKind(i, LIMIT_TWIST))
    r = quaternionProduct(r, vec4(pose.twist[i] * b.z, 1.0) * inversesqrt(1.0 + pose.twist[i] * pose.twist[i]));
  return r;
}

// A straight chain with its target nearer on the same line would never bend: bend it first.
// Looks at joints first .. last - 1: true for all of them means true for some.
bool deadlocked(vec3 target, Pose pose, int first, int last) {
  float off = 0.0, span = dot(pose.tip, pose.tip);
  for (int i = first; i < last; ++i) {
    vec3 away = cross(pose.tip, pose.joint[i]);
    off = max(off, dot(away, away));
  }
  return off < 1e-6 * span && dot(target, target) < 0.998001 * span;
}
bool deadlocked(vec3 target, Pose pose) { return deadlocked(target, pose, 1, BONES); }

void bend(Limb limb, inout Pose pose) {
  for (int i = 0; i < BONES; ++i) {
    float by = limb.bone[i] == 0.0 ? 0.0 : i == 0 ? -0.025 * float(BONES - 1) : 0.05;
    vec2 s = pose.swing[i] + (isKind(i, LIMIT_HINGE) ? vec2(0.0, by) : vec2(by, 0.0));
    pose.swing[i] = clampSwing(limb, i, fromStereographic(s));
  }
  forwardKinematics(limb, pose);
}

#endif
