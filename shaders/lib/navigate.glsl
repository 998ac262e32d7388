#ifndef NAVIGATE_GLSL
#define NAVIGATE_GLSL

// At the edge of the map.
vec2 turnedBack(Parameters q, vec2 position, vec2 velocity) {
  bvec2 beyond = greaterThan(abs(position), vec2(q.halfExtentX, q.halfExtentZ) - q.edgeMargin);
  bvec2 outward = greaterThan(velocity * position, vec2(0.0));
  return vec2(beyond.x && outward.x ? -velocity.x : velocity.x, beyond.y && outward.y ? -velocity.y : velocity.y);
}

// Desired velocity toward the goal, or as given; `ends` is swapped on arrival where the goal is to cross (docs/stages/navigate.md).
vec2 navigate(Parameters q, vec2 position, vec4 manner, inout vec4 ends) {
  float speed = manner.x, arrival = manner.y, kind = manner.z;
  bool given = kind == GOAL_VELOCITY;
  vec2 delta = ends.xy - (given ? vec2(0.0) : position);
  if (kind == GOAL_CROSS && dot(delta, delta) < arrival * arrival) {
    ends = ends.zwxy;
    delta = ends.xy - position;
  }
  float distance = sqrt(dot(delta, delta));
  vec2 velocity = delta * (speed / max(distance, 1e-6));
  if (kind == GOAL_POINT) velocity *= distance < arrival ? 0.0 : min(1.0, distance / q.slowRadius);
  if (given && distance < speed) velocity = delta;
  if (kind == GOAL_NONE) velocity = vec2(0.0);
  return turnedBack(q, position, velocity);
}

#endif
