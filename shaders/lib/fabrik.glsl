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
  vec4 r = vec4(0.0, 0.0, 0.0, 1.0);
  vec3 p = vec3(0.0);
  for (int i = 0; i < BONES; ++i) {
    vec3 v = q[i] - p;
    float distance = length(v);
    vec3 w = rotateBack(r, v);
    // Unit again at each bone: R grows from d, and what d lacks of length would double along the chain.
    vec3 d = unit(vec3(dot(limb.x[i], w), dot(limb.y[i], w), dot(limb.z[i], w)));
    bool aimed = distance >= 1e-6 && limb.bone[i] > 0.0;
    if (mayBe(i, LIMIT_HINGE) && isKind(limb, i, LIMIT_HINGE)) {
      aimed = aimed && dot(d.yz, d.yz) > 1e-12;
      d = vec3(0.0, unit(d.yz));
    }
    d = clampLimit(limb, i, d);
    pose.d[i] = aimed ? d : pose.d[i];
    place(limb, i, r, p, pose);
  }
  pose.tip = p;
}

#endif
