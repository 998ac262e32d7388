#version 460
#extension GL_GOOGLE_include_directive : require
// A shader of somebody else's that steers agents: the example of docs/steering.md.
#include "skitter/records.h"

layout(local_size_x = WORK_GROUP) in;
layout(std430, set = 0, binding = 0) buffer Goals { vec4 goals[]; };
layout(push_constant) uniform Run { uint first, agents; vec2 wind; } run;

void main() {
  if (gl_GlobalInvocationID.x >= run.agents) return;
  uint at = uint(GOAL_STRIDE) * (run.first + gl_GlobalInvocationID.x);
  goals[at].xy = run.wind;                      // m/s
  goals[at + 1u].xz = vec2(2.0, GOAL_VELOCITY); // cut to 2 m/s
}
