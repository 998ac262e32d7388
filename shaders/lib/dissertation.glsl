#ifndef DISSERTATION_GLSL
#define DISSERTATION_GLSL
#include "free_chain.glsl"
// FABRIK as the dissertation has it: positions alone, cones about each joint's constraint point in both passes, and
// one of two rules for a joint outside (docs/ik.md).

vec3 withinCone(vec3 u, vec3 axis, float cosLimit, float sinLimit) {
  float along = dot(u, axis);
  return along < cosLimit ? axis * cosLimit + unit(u - axis * along) * sinLimit : u;
}

// The direction of a bone between two joints, of one without length the one that it would have at rest.
vec3 directionOr(vec3 axis, vec3 v) { return dot(v, v) > 1e-20 ? unit(v) : axis; }

void dissertationIteration(float bone[BONES], vec3 rest[BONES], float cosLimit[BONES], float sinLimit[BONES],
                           vec3 target, bool edge, inout FreePose pose) {
  vec3 before[BONES + 1], beyond = vec3(0.0);
  for (int i = 0; i <= BONES; ++i) before[i] = pose.joint[i];
  pose.joint[BONES] = target;
  for (int i = BONES - 1; i >= 0; --i) {
    vec3 u = unit(pose.joint[i + 1] - pose.joint[i]), clamped = u, axis = u;
    bool outside = false;
    if (i < BONES - 1) {
      int next = min(i + 1, BONES - 1);
      axis = rotate(shortestArc(rest[next], beyond), rest[i]);
      outside = dot(u, axis) < cosLimit[next];
      clamped = withinCone(u, axis, cosLimit[next], sinLimit[next]);
    }
    vec3 moved = pose.joint[i + 1] - bone[i] * clamped;
    pose.joint[i] = outside && !edge ? before[i] : moved;
    beyond = directionOr(axis, pose.joint[i + 1] - pose.joint[i]);
  }
  for (int i = 0; i <= BONES; ++i) before[i] = pose.joint[i];
  pose.joint[0] = vec3(0.0);
  vec3 last = vec3(0.0);
  for (int i = 0; i < BONES; ++i) {
    vec3 u = unit(before[i + 1] - pose.joint[i]), axis = rest[i];
    if (i > 0) axis = rotate(shortestArc(rest[max(i - 1, 0)], last), rest[i]);
    bool outside = dot(u, axis) < cosLimit[i];
    vec3 moved = pose.joint[i] + bone[i] * withinCone(u, axis, cosLimit[i], sinLimit[i]);
    pose.joint[i + 1] = outside && !edge ? before[i + 1] : moved;
    last = directionOr(axis, pose.joint[i + 1] - pose.joint[i]);
  }
}

#endif
