#ifndef WALLS_GLSL
#define WALLS_GLSL
// How an agent keeps clear of obstacles (docs/stages/avoid.md).

const float WALL_TIME = 0.5;
const float WALL_SOFTNESS = 0.01;

// 4. Where an obstacle, so far as its edges have been seen, is nearest.
struct NearestEdge {
  vec2 away, way;   // from there to the agent; along the edge
  float distance2;  // squared
  bool inside;      // of all edges
};

NearestEdge noEdge() { return NearestEdge(vec2(0.0), vec2(0.0), 1e30, true); }

void approach(inout NearestEdge nearest, vec2 place, vec4 ends, bool isSolid) {
  vec2 way = ends.zw - ends.xy, from = place - ends.xy;
  float squared = dot(way, way);
  vec2 away = from - clamp(dot(from, way) / max(squared, 1e-20), 0.0, 1.0) * way;
  float distance2 = dot(away, away);
  bool nearer = distance2 < nearest.distance2;
  nearest.away = nearer ? away : nearest.away;
  nearest.way = nearer ? way : nearest.way;
  nearest.distance2 = nearer ? distance2 : nearest.distance2;
  nearest.inside = nearest.inside && isSolid && way.y * from.x < way.x * from.y;
}

// `clear`: how far from the obstacle the agent's middle is to be.
HalfPlane planeBeside(NearestEdge nearest, float clear) {
  float d = sqrt(nearest.distance2), span = length(nearest.way);
  vec2 outward = span > 0.0 ? vec2(nearest.way.y, -nearest.way.x) / span : vec2(1.0, 0.0);
  float side = nearest.inside ? -1.0 : 1.0;
  return HalfPlane(d > 0.0 ? nearest.away * (side / d) : outward, (clear - side * d) * (1.0 / WALL_TIME));
}

// The obstacles that ask for most, in the order in which they came.
struct Walls {
  HalfPlane planes[NEAREST_WALLS];
};

// None; those beyond `look` are not taken.
Walls noWalls(float look) {
  Walls walls;
  [[unroll]] for (int k = 0; k < NEAREST_WALLS; ++k)
    walls.planes[k] = HalfPlane(vec2(0.0), -look * (1.0 / WALL_TIME));
  return walls;
}

// In place of the first of those that ask for least.
void take(inout Walls walls, HalfPlane plane) {
  float least = walls.planes[0].bound;
  [[unroll]] for (int k = 1; k < NEAREST_WALLS; ++k) least = min(least, walls.planes[k].bound);
  if (!(plane.bound > least)) return;
  bool beyond = false;
  [[unroll]] for (int k = 0; k < NEAREST_WALLS; ++k) {
    beyond = beyond || walls.planes[k].bound == least;
    HalfPlane next = k + 1 < NEAREST_WALLS ? walls.planes[min(k + 1, NEAREST_WALLS - 1)] : plane;
    walls.planes[k].n = beyond ? next.n : walls.planes[k].n;
    walls.planes[k].bound = beyond ? next.bound : walls.planes[k].bound;
  }
}

// 5. Nearest to `v`; obstacles have the last word.
vec2 solveAmongWalls(HalfPlane planes[NEIGHBOURS], Walls walls, vec2 v) {
  float push[NEIGHBOURS], hold[NEAREST_WALLS];
  [[unroll]] for (int k = 0; k < NEIGHBOURS; ++k) push[k] = 0.0;
  [[unroll]] for (int k = 0; k < NEAREST_WALLS; ++k) hold[k] = 0.0;
  [[unroll]] for (int sweep = 0; sweep < AVOID_SWEEPS; ++sweep) {
    [[unroll]] for (int k = NEIGHBOURS - 1; k >= 0; --k) {
      float lacking = planes[k].bound - dot(planes[k].n, v) - AVOID_SOFTNESS * push[k];
      float more = max(0.0, push[k] + lacking * (1.0 / (1.0 + AVOID_SOFTNESS)));
      v += (more - push[k]) * planes[k].n;
      push[k] = more;
    }
    [[unroll]] for (int k = 0; k < NEAREST_WALLS; ++k) {
      float lacking = walls.planes[k].bound - dot(walls.planes[k].n, v) - WALL_SOFTNESS * hold[k];
      float more = max(0.0, hold[k] + lacking * (1.0 / (1.0 + WALL_SOFTNESS)));
      v += (more - hold[k]) * walls.planes[k].n;
      hold[k] = more;
    }
  }
  return v;
}

// 6. The velocity, moved to each obstacle that it is beyond; out of one no faster than `most`.
vec2 besideWalls(Walls walls, float most, vec2 v) {
  [[unroll]] for (int k = 0; k < NEAREST_WALLS; ++k)
    v += max(0.0, min(walls.planes[k].bound, most) - dot(walls.planes[k].n, v)) * walls.planes[k].n;
  return v;
}

#endif
