#ifndef REACT_GLSL
#define REACT_GLSL
#include "lib/carried.glsl"
// The pieces of stage react (docs/stages/react.md) that others share.

struct Reaction {
  float phase, clock, disturbed, over;
  vec2 velocity;
  float sink, drop;
  vec2 way;  // of the fall
  float tilt, tiltRate;
  vec3 ground;  // its up axis
  float fold;
  float falls, stands, down, downBefore;
};

Reaction unpackReaction(vec4 a, vec4 b, vec4 c, vec4 d, vec4 e) {
  return Reaction(a.x, a.y, a.z, a.w, b.xy, b.z, b.w, c.xy, c.z, c.w, d.xyz, d.w, e.x, e.y, e.z, e.w);
}

// Reads the buffer `reactions`.
#define LOAD_REACTION(agent)                                         \
  unpackReaction(LOAD4(reactions, (agent) * REACTION_STRIDE),        \
                 LOAD4(reactions, (agent) * REACTION_STRIDE + 1),    \
                 LOAD4(reactions, (agent) * REACTION_STRIDE + 2),    \
                 LOAD4(reactions, (agent) * REACTION_STRIDE + 3),    \
                 LOAD4(reactions, (agent) * REACTION_STRIDE + 4))

bool isFallen(float phase) { return phase >= REACTION_FALLING && phase <= REACTION_RIGHTING; }
// It does not stand on its legs, not even as it begins to rise.
bool isLoose(Reaction r) { return isFallen(r.phase) || (r.phase == REACTION_RISING && r.clock == 0.0); }

// Where a load hangs below the body the pendulum is not shorter than so many bodyHeight.
const float LEAST_PENDULUM = 0.25;
float pendulumTime(Parameters q, vec4 load) {
  return sqrt(max(q.bodyHeight + centreShift(q, load).y, LEAST_PENDULUM * q.bodyHeight) / q.gravity);
}

// R_0 of a body that stands on `up`, tipped over toward `way`.
mat3 tippedFrame(vec3 up, vec2 heading, vec2 way, float tilt) {
  vec3 forward = unit(vec3(heading.x, -(up.x * heading.x + up.z * heading.y) / up.y, heading.y));
  vec3 level = vec3(way.x, 0.0, way.y);
  vec3 toward = unit(level - dot(level, up) * up), axis = cross(up, toward);
  float t = 0.5 * tilt, d = 1.0 / (1.0 + t * t), c = (1.0 - t * t) * d, s = 2.0 * t * d;
  vec3 left = cross(up, forward);
  vec3 tippedLeft = c * left + s * cross(axis, left) + (1.0 - c) * dot(axis, left) * axis;
  vec3 tippedForward = c * forward + s * cross(axis, forward) + (1.0 - c) * dot(axis, forward) * axis;
  return mat3(tippedLeft, c * up + s * toward, tippedForward);
}

#endif
