#ifndef NAVIGATE_STAGE_GLSL
#define NAVIGATE_STAGE_GLSL
// Stage navigate, for entry points that make it alone or together with body and gait; they declare its bindings.
#include "lib/navigate.glsl"
#include "lib/rarely.glsl"

vec2 makeVelocity(int agent, vec2 position) {
  vec4 ends = LOAD4(goals, agent * GOAL_STRIDE), manner = LOAD4(goals, agent * GOAL_STRIDE + 1);
  vec4 swapped = ends;
  vec2 velocity = navigate(parameters, position, manner, swapped);
  RARELY(swapped != ends) STORE4(goalsOut, agent * GOAL_STRIDE, swapped);
  return velocity;
}

#endif
