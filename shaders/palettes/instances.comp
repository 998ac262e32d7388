#version 460
#extension GL_GOOGLE_include_directive : require
// The transform of each agent, from its model space.
#include "transforms.glsl"

void main() {
  uint transform = gl_GlobalInvocationID.x;
  if (transform >= constants.agents) return;
  int at = int(constants.first + transform) * BODY_STRIDE;
  if (isAbsent(at)) {
    writeNothing(transform);
    return;
  }
  writeRotation(transform, LOAD4(bodies, at + 2), fromOrigin(LOAD4(bodies, at)));
}
