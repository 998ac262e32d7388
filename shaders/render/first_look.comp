#version 460
#extension GL_GOOGLE_include_directive : require
// Lists whom the last picture showed: this one begins with them, who hide others.
#include "picture.glsl"
#include "look.glsl"

void main() {
  uint place = gl_GlobalInvocationID.x;
  for (int i = 0; i < CAMERA_LISTS; ++i) {
    int list = cameraList(i);
    if (place >= countOf(list)) continue;
    uint entry = instances[list * constants.agents + place];
    if (seen[agentOf(entry)] != 0u) append(uint(FIRST_LOOK + i), entry);
  }
}
