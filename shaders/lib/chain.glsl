#ifndef CHAIN_GLSL
#define CHAIN_GLSL
// A limb as the solvers see it (docs/stages.md, ik): lengths in units of the reach, root at the origin, model
// axes. The including stage defines BONES, a specialization constant; every loop over it unrolls.

struct Limb {
  vec3 x[BONES], y[BONES], z[BONES];  // bone frames B_i; z is the rest direction
  float bone[BONES];                  // lengths; 0 pads a shorter limb
  float cosLimit[BONES], sinLimit[BONES];
  float stiffness[BONES];
};

// A pose: local directions d_i, and what forward kinematics makes of them.
struct Pose {
  vec3 d[BONES];
  vec3 joint[BONES];   // p_i, where bone i starts
  vec4 parent[BONES];  // R_(i-1), without R_0
  vec3 tip;
};

vec3 fromStereographic(vec2 s) {
  float k = 2.0 / (1.0 + dot(s, s));
  return vec3(k * s, k - 1.0);
}
vec2 toStereographic(vec3 d) { return d.xy / (1.0 + max(d.z, -0.999999)); }

vec3 clampCone(vec3 d, float cosLimit, float sinLimit) {
  // Straight against the rest direction every way around is as good: one of them, not what rounding says.
  float s2 = dot(d.xy, d.xy);
  vec2 h = s2 < 1e-6 ? vec2(1.0, 0.0) : d.xy * inversesqrt(max(s2, 1e-6));
  return d.z < cosLimit ? vec3(h * sinLimit, cosLimit) : d;
}

// R_i from R_(i-1) and d_i: the shortest rotation of the rest direction onto the bone.
vec4 swung(Limb limb, int i, vec4 parent, vec3 d) {
  vec3 axis = limb.y[i] * d.x - limb.x[i] * d.y;
  return quaternionProduct(parent, vec4(axis, 1.0 + d.z) * inversesqrt(max(2.0 * (1.0 + d.z), 1e-12)));
}

void forwardKinematics(Limb limb, inout Pose pose) {
  vec4 r = vec4(0.0, 0.0, 0.0, 1.0);
  vec3 p = vec3(0.0);
  for (int i = 0; i < BONES; ++i) {
    pose.joint[i] = p;
    pose.parent[i] = r;
    r = swung(limb, i, r, pose.d[i]);
    p += limb.bone[i] * rotate(r, limb.z[i]);
  }
  pose.tip = p;
}

void keepIf(bool keep, inout Pose best, Pose candidate) {
  for (int i = 0; i < BONES; ++i) {
    best.d[i] = keep ? candidate.d[i] : best.d[i];
    best.joint[i] = keep ? candidate.joint[i] : best.joint[i];
    best.parent[i] = keep ? candidate.parent[i] : best.parent[i];
  }
  best.tip = keep ? candidate.tip : best.tip;
}

#endif
