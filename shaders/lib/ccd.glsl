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
    vec4 before = swung(limb, i, pose.parent[i], pose.d[i], pose.twist[i]);
    vec4 turn = shortestArc(unit(arm), unit(to));
    vec3 z = rotateBack(pose.parent[i], rotate(turn, rotate(before, limb.z[i])));
    vec3 d = vec3(dot(limb.x[i], z), dot(limb.y[i], z), dot(limb.z[i], z));
    if (mayBe(i, LIMIT_HINGE)) {
      vec3 y = rotate(pose.parent[i], limb.y[i]), w = rotate(pose.parent[i], limb.z[i]);
      vec2 a = vec2(dot(arm, y), dot(arm, w)), b = vec2(dot(to, y), dot(to, w));
      bool none = dot(a, a) < 1e-12 || dot(b, b) < 1e-12;
      a = unit(a);
      b = unit(b);
      // The turn of the (y, z) plane that takes a to b.
      vec2 turn2 = vec2(dot(a, b), a.x * b.y - a.y * b.x);
      vec3 hinged = vec3(0.0, turn2.x * pose.d[i].y - turn2.y * pose.d[i].z, turn2.x * pose.d[i].z + turn2.y * pose.d[i].y);
      d = isKind(limb, i, LIMIT_HINGE) ? (none ? pose.d[i] : hinged) : d;
    }
    d = clampLimit(limb, i, unit(d));
    pose.d[i] = limb.bone[i] > 0.0 ? d : pose.d[i];
    vec4 after = swung(limb, i, pose.parent[i], pose.d[i], pose.twist[i]);
    tip = pose.joint[i] + rotate(after, rotateBack(before, arm));
  }
  forwardKinematics(limb, pose);
}

#endif
