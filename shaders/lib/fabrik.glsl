#ifndef FABRIK_GLSL
#define FABRIK_GLSL
#include "chain.glsl"
// FABRIK (Aristidou & Lasenby 2011) with cones: tip to base free, base to tip within the limits, whose frames
// are carried along the chain (docs/stages.md, ik).

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
    s.x += i == 0 ? -0.025 * float(BONES - 1) : 0.05;
    pose.d[i] = clampCone(fromStereographic(s), limb.cosLimit[i], limb.sinLimit[i]);
  }
  forwardKinematics(limb, pose);
}

void fabrikIteration(Limb limb, vec3 target, inout Pose pose) {
  vec3 q[BONES];  // where bone i should end
  vec3 end = target;
  for (int i = BONES - 1; i >= 0; --i) {
    q[i] = end;
    end += limb.bone[i] * unit(pose.joint[i] - end);
  }
  vec4 r = vec4(0.0, 0.0, 0.0, 1.0);
  vec3 p = vec3(0.0);
  for (int i = 0; i < BONES; ++i) {
    vec3 v = q[i] - p;
    float distance = length(v);
    vec3 w = rotateBack(r, v);
    // Unit again at each bone: R grows from d, and what d lacks of length would double along the chain.
    vec3 d = unit(vec3(dot(limb.x[i], w), dot(limb.y[i], w), dot(limb.z[i], w)));
    d = clampCone(d, limb.cosLimit[i], limb.sinLimit[i]);
    pose.d[i] = distance < 1e-6 || limb.bone[i] == 0.0 ? pose.d[i] : d;
    pose.joint[i] = p;
    pose.parent[i] = r;
    r = swung(limb, i, r, pose.d[i]);
    p += limb.bone[i] * rotate(r, limb.z[i]);
  }
  pose.tip = p;
}

#endif
