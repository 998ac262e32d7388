#version 460
#extension GL_GOOGLE_include_directive : require
// The host's own steering: writes the goal of each agent of a herd, before the crowd's tick. Agents walk around a
// point, each on a ring of its own.
#include "skitter/records.h"

layout(local_size_x = 64) in;
layout(std430, binding = 0) buffer Goals { vec4 goals[]; };
layout(std430, binding = 1) readonly buffer Bodies { vec4 bodies[]; };
layout(push_constant) uniform Constants {
  vec2 centre;       // world metres, x and z
  float least, most; // radii of the rings, metres
  uint first;        // the herd's first agent, in the page
  uint agents;
};

const float AHEAD = 5.0;  // metres from an agent to its goal: further than it brakes

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= agents) return;
  uint agent = first + i;
  vec4 place = bodies[agent * BODY_STRIDE];
  vec2 world = TILE_SIZE * vec2(tileX(place.w), tileZ(place.w)) + place.xz;
  vec2 out_ = world - centre;
  float radius = max(length(out_), 1e-3);
  out_ /= radius;
  // Areas of rings are equal, so agents are equally dense.
  float share = fract(float(i) * 0.61803399);
  float ring = sqrt(mix(least * least, most * most, share));
  vec2 way = normalize(vec2(-out_.y, out_.x) + out_ * clamp(0.5 * (ring - radius), -2.0, 2.0));
  vec4 how = goals[agent * GOAL_STRIDE + 1];  // speed and arrival radius stay
  goals[agent * GOAL_STRIDE] = vec4(world + AHEAD * way, 0.0, 0.0);
  goals[agent * GOAL_STRIDE + 1] = vec4(how.xy, GOAL_POINT, 0.0);
}
