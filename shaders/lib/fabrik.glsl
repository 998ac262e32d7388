#ifndef FABRIK_GLSL
#define FABRIK_GLSL
#include "chain.glsl"
// FABRIK (Aristidou & Lasenby 2011) with limits: tip to base free, base to tip within the limits, whose frames
// are carried along the chain (docs/ik.md, FABRIK).

void fabrikIteration(Limb limb, vec3 target, inout Pose pose) {
  vec3 q[BONES];  // where bone i should end
  vec3 end = target;
  for (int i = BONES - 1; i >= 0; --i) {
    q[i] = end;
    end += limb.bone[i] * unit(pose.joint[i] - end);
  }
  Frame f = noTurn();
  vec3 p = vec3(0.0);
  for (int i = 0; i < BONES; ++i) {
    Frame a = carried(i, f, limb.carry[i]);
    vec3 v = q[i] - p, d = unit(rotateBack(a, v));
    bool aimed = length(v) >= 1e-6 && limb.bone[i] > 0.0;
    if (isKind(i, LIMIT_HINGE)) {
      aimed = aimed && dot(d.yz, d.yz) > 1e-12;
      d = vec3(0.0, unit(d.yz));
    }
    vec2 s = clampSwing(limb, i, d);
    pose.swing[i] = aimed ? s : pose.swing[i];
    pose.frame[i] = a;
    f = turnedFrame(i, a, pose.swing[i], pose.twist[i]);
    place(limb, i, f, p, pose);
  }
  pose.tip = p;
}

#endif
