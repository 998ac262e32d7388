#ifndef CCD_GLSL
#define CCD_GLSL
#include "chain.glsl"
#include "free_chain.glsl"
// Cyclic coordinate descent on a limited chain (docs/ik.md, CCD), last joint first: what stands before a joint has not moved
// when its turn comes, and what stands beyond it moves with it.

void ccdIteration(Limb limb, vec3 target, inout Pose pose) {
  vec3 tip = pose.tip;
  for (int i = BONES - 1; i >= 0; --i) {
    vec3 arm = tip - pose.joint[i], to = target - pose.joint[i];
    Frame a = pose.frame[i], before = turnedFrame(i, a, pose.swing[i], pose.twist[i]);
    vec3 d = rotateBack(a, rotate(shortestArc(unit(arm), unit(to)), before.z));
    if (isKind(i, LIMIT_HINGE)) {
      vec2 from = vec2(dot(arm, a.y), dot(arm, a.z)), onto = vec2(dot(to, a.y), dot(to, a.z));
      bool none = dot(from, from) < 1e-12 || dot(onto, onto) < 1e-12;
      from = unit(from);
      onto = unit(onto);
      // The turn of the (y, z) plane that takes the one to the other.
      vec2 by = none ? vec2(1.0, 0.0) : vec2(dot(from, onto), from.x * onto.y - from.y * onto.x);
      vec3 at = fromStereographic(pose.swing[i]);
      d = vec3(0.0, by.x * at.y - by.y * at.z, by.x * at.z + by.y * at.y);
    }
    vec2 s = clampSwing(limb, i, unit(d));
    pose.swing[i] = limb.bone[i] > 0.0 ? s : pose.swing[i];
    Frame after = turnedFrame(i, a, pose.swing[i], pose.twist[i]);
    tip = pose.joint[i] + rotate(after, rotateBack(before, arm));
  }
  forwardKinematics(limb, pose);
}

#endif
