#ifndef NAVIGATE_STAGE_GLSL
#define NAVIGATE_STAGE_GLSL
// Stage navigate, for entry points that make it alone or together with body and gait; they declare its bindings.
#include "lib/navigate.glsl"
#include "lib/rarely.glsl"

#ifdef WAYS
#include "lib/ways.glsl"

// The number of the field of that goal; that of the fields where it has none.
int fieldOf(vec2 target) {
  int fields = int(LOAD4(ways, 0).x), found = fields;
  for (int k = 0; k < fields; ++k)
    if (LOAD4(ways, WAY_HEADS + k).xy == target) found = k;
  return found;
}

// `straight`, or the velocity along the way where a field leads to the goal; whether the place of a series is
// behind the agent.
vec2 alongWay(vec2 position, vec4 manner, vec4 ends, vec2 straight, out bool passed) {
  vec4 shape = LOAD4(ways, 0);
  int field = fieldOf(ends.xy);
  bool series = manner.z == GOAL_SERIES;
  passed = false;
  if (series && field >= int(shape.x)) return vec2(0.0);
  if ((manner.z != GOAL_POINT && !series) || field >= int(shape.x)) return straight;
  vec2 stop = LOAD4(ways, WAY_HEADS + field).zw;
  vec2 apart = stop - position;
  vec4 near = vec4(stop, ends.zw);
  if (dot(apart, apart) < WAY_STRAIGHT * WAY_STRAIGHT * shape.w * shape.w) {
    passed = series;
    return navigate(parameters, position, vec4(manner.xy, GOAL_POINT, 0.0), near);
  }
  vec2 u = clamp((position - LOAD4(ways, 1).xy) / shape.w - 0.5, vec2(0.0), shape.yz - 1.0);
  vec2 i = min(floor(u), shape.yz - 2.0);
  int cells = int(shape.y) * int(shape.z), cell = int(i.y) * int(shape.y) + int(i.x);
  vec4 times = LOAD4(ways, WAY_TIMES + field * cells + cell);
  float time;
  vec2 velocity = downhill(parameters, manner.xy, times, u - i, time);
  passed = series && time < WAY_PASSED * manner.y;
  return turnedBack(parameters, position, velocity);
}

// The goal of an agent in a series once it is past `place`, which the goal has.
vec4 onward(vec4 ends, vec4 place) {
  vec2 next = drawnNext(ends.w, place.z, place.w);
  return vec4(LOAD4(ways, WAY_PLACES + int(next.x)).xy, next);
}
#endif

vec2 makeVelocity(int agent, vec2 position) {
  vec4 ends = LOAD4(goals, agent * GOAL_STRIDE), manner = LOAD4(goals, agent * GOAL_STRIDE + 1);
  vec4 swapped = ends;
  vec2 velocity = navigate(parameters, position, manner, swapped);
#ifdef WAYS
  // A place may have moved.
  vec4 place = vec4(0.0);
  if (manner.z == GOAL_SERIES) place = LOAD4(ways, WAY_PLACES + int(ends.z));
  vec4 led = manner.z == GOAL_SERIES ? vec4(place.xy, ends.zw) : ends;
  bool passed;
  velocity = alongWay(position, manner, led, velocity, passed);
  if (manner.z == GOAL_SERIES) swapped = passed && place.w > 0.0 ? onward(led, place) : led;
#endif
  RARELY(swapped != ends) STORE4(goalsOut, agent * GOAL_STRIDE, swapped);
  return velocity;
}

#endif
