#ifndef TRAIL_GLSL
#define TRAIL_GLSL
// A point's way as measure remembers it (docs/stages/measure.md): positions are local to the body's tile.

struct Trail {
  vec3 at;             // x_(n-1)
  vec3 first, second;  // e1 and e2 of it
  float path, jerk;    // P and Q of the open window
};

// e1, without the change of tile that may lie between: nothing moves half a tile in a tick.
vec3 moved(Trail trail, vec3 here) {
  vec3 e = here - trail.at;
  e.xz -= TILE_SIZE * round(e.xz / TILE_SIZE);
  return e;
}

// The trail one tick on, watched for `watched` ticks before; `place` is the tick's in its window.
Trail advance(Trail trail, vec3 here, uint watched, uint place) {
  vec3 e1 = watched >= 1u ? moved(trail, here) : vec3(0.0);
  vec3 e2 = watched >= 2u ? e1 - trail.first : vec3(0.0);
  vec3 e3 = e2 - trail.second;
  bool known = watched >= 3u, opens = place == 0u;
  float path = opens ? 0.0 : trail.path, jerk = opens ? 0.0 : trail.jerk;
  return Trail(here, e1, e2, known ? path + length(e1) : 0.0, known ? jerk + dot(e3, e3) : 0.0);
}

// W^5 Q and P^2 of a window that closes with this tick and counts; or nothing.
vec2 windowJerk(Trail trail, bool closes, float ticks, float leastPath) {
  float square = ticks * ticks;
  vec2 window = vec2(square * square * ticks * trail.jerk, trail.path * trail.path);
  return closes && trail.path > leastPath ? window : vec2(0.0);
}

#endif
