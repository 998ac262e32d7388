#ifndef AVOID_GLSL
#define AVOID_GLSL
#include "lib/aside.glsl"
// How an agent keeps clear of its neighbours (docs/stages/avoid.md).

const float AVOID_HORIZON = 0.7, AVOID_PUSH_TIME = 0.5;
const float AVOID_ROOM = 1.55, AVOID_ROOM_GOING = 2.0;  // times the footprints
const float AVOID_TURN = 4.0, AVOID_RIGHT_BIAS = 0.05;
const float AVOID_SOFTNESS = 0.05;
const int AVOID_SWEEPS = 6;
const float AVOID_STEADY_SPEED = 0.05;
// Shares of footprints; seconds; leg lengths a second.
const float AVOID_DEEP = 0.01, AVOID_LOOSE = 0.9;
const float AVOID_EASE = 0.4, AVOID_SLACK = 1e-4, AVOID_FREE = 100.0;
// The share of the room between two agents that who goes second may take; of a gap, each second.
const float AVOID_SECOND = 0.4, AVOID_CREEP = 0.3;
const int AVOID_CELL_SWEEPS = 2;

// 1. The order of neighbours.
bool isBefore(int power, int number, int otherPower, int otherNumber) {
  return power < otherPower || (power == otherPower && number < otherNumber);
}

// 2. How near a neighbour is: 1 within the room of legs, 0 from twice as far.
float closenessOf(float d, float footprints) { return clamp(2.0 - d / (AVOID_ROOM * footprints), 0.0, 1.0); }

// How much an agent turns away from a neighbour ahead, to which p leads: to its right, or to its left (less than 0) where
// the neighbour is on the right.
float turnFrom(vec2 p, float d, vec2 wanted, float speed, float closeness) {
  float size = 1.0 / max(d * speed, 1e-6), across = wanted.x * p.y - wanted.y * p.x;
  return closeness * max(0.0, dot(p, wanted)) * size * clamp(1.0 - AVOID_TURN * across * size, -1.0, 1.0);
}

// 3. Where two agents part that are in one place.
vec2 partingLine(int a, int b) {
  uint drawn = (uint(min(a, b)) * 0x9E3779B1u) ^ (uint(max(a, b)) * 0x85EBCA77u);
  vec2 line = unit(vec2(float(drawn >> 28), float(drawn >> 24 & 15u)) - 7.5);
  return a < b ? line : -line;
}

// A neighbour allows n . v >= bound.
struct HalfPlane {
  vec2 n;
  float bound;
};

// How many times the footprints agents keep apart: the room of their legs, and more of it who gets on as it wants to.
float roomOf(float speed, float wanted) {
  return AVOID_ROOM + AVOID_ROOM_GOING * clamp(2.0 * speed / max(wanted, 1e-6), 0.0, 1.0);
}

// `p` leads to the neighbour, d long; `footprints` of both, apart by `room` times that. `own` is the agent's velocity,
// `v` less the neighbour's; `apart`: where they part if d is 0.
HalfPlane halfPlaneOf(vec2 p, float d, float footprints, float room, vec2 own, vec2 v, float share, vec2 apart) {
  float radii = footprints * room, power = (d - radii) * (d + radii);
  vec2 w = v - p * (1.0 / AVOID_HORIZON);
  float along = dot(w, p), speed2 = dot(w, w), speed = sqrt(speed2);
  vec2 n, change;
  if (power <= 0.0) {
    n = d > 0.0 ? p * (-1.0 / d) : apart;
    float push = max(footprints - d, 0.0) * (1.0 / AVOID_PUSH_TIME) +
                 (radii - max(d, footprints)) * (1.0 / AVOID_HORIZON);
    change = (push - dot(n, v)) * n;
  } else if (along < 0.0 && along * along > radii * radii * speed2) {
    n = w * (1.0 / max(speed, 1e-9));
    change = (radii * (1.0 / AVOID_HORIZON) - speed) * n;
  } else {
    float side = p.x * w.y - p.y * w.x + AVOID_RIGHT_BIAS * d * speed >= 0.0 ? 1.0 : -1.0;
    vec2 tangent = p * sqrt(power), normal = vec2(-p.y, p.x) * radii;
    vec2 edge = (side * tangent + normal) * (1.0 / (d * d));
    n = vec2(-edge.y, edge.x);
    change = dot(v, edge) * edge - v;
  }
  return HalfPlane(n, dot(n, own + share * change));
}

// 5. Nearest to `v`.
vec2 solvePlanes(HalfPlane planes[NEIGHBOURS], vec2 v) {
  float push[NEIGHBOURS];
  [[unroll]] for (int k = 0; k < NEIGHBOURS; ++k) push[k] = 0.0;
  [[unroll]] for (int sweep = 0; sweep < AVOID_SWEEPS; ++sweep)
    [[unroll]] for (int k = NEIGHBOURS - 1; k >= 0; --k) {
      float lacking = planes[k].bound - dot(planes[k].n, v) - AVOID_SOFTNESS * push[k];
      float more = max(0.0, push[k] + lacking * (1.0 / (1.0 + AVOID_SOFTNESS)));
      v += (more - push[k]) * planes[k].n;
      push[k] = more;
    }
  return v;
}

// 6. The side of the agent's cell toward a neighbour: velocities v, m/s, with n . v <= near for its wish, n . v <= deep
// for what it gets, and n . v <= eased for the body's speed.
struct CellSide {
  vec2 n;
  float near, deep, eased;
};

// Which of two agents goes first. `turn` counts turns, which have orders of their own, so that nobody waits for long.
bool goesFirst(int number, int other, float turn) {
  uint order = uint(turn) * 0x9E3779B1u;
  return (uint(number) ^ order) < (uint(other) ^ order);
}

// `lesser`: the smaller footprint; `moves`: the neighbour's velocity; `avoids`: it takes its share of the room, too;
// `yields`: the agent makes room for it.
CellSide cellSideOf(vec2 p, float d, float radii, float lesser, vec2 moves, bool avoids, bool yields, Parameters q) {
  vec2 n = p * (1.0 / max(d, 1e-9));
  float share = avoids ? 0.5 : 1.0, wish = avoids ? (yields ? AVOID_SECOND : 1.0 - AVOID_SECOND) : 1.0;
  float gap = d - radii, room = d - AVOID_ROOM * radii, away = max(0.0, dot(n, moves));
  float back = yields ? clamp(room * (1.0 / AVOID_EASE), -AVOID_PUSH_SPEED * q.legLength, 0.0) : 0.0;
  float loose = max(0.0, AVOID_LOOSE * radii - d);
  float near = max(0.0, room) * wish + loose, deep = max(0.0, gap - AVOID_DEEP * lesser) * share + loose;
  float slack = AVOID_SLACK * q.legLength, atOnce = deep / q.dt;
  float most = min(near / q.dt, near * (1.0 / AVOID_EASE) + away) + back + AVOID_CREEP * share * max(0.0, gap);
  return CellSide(n, most, atOnce + slack, min(atOnce, deep * (1.0 / AVOID_EASE) + away) + slack);
}

// The speed along a unit vector at which the body stays on that side. It reaches what is free before the divisor is 0.
float speedToward(CellSide side, vec2 along) { return side.eased / max(dot(side.n, along), 1e-6); }

// The velocity, moved to each side that it is beyond, the nearest neighbour's last.
vec2 ontoSides(CellSide sides[NEIGHBOURS], vec2 v) {
  [[unroll]] for (int k = NEIGHBOURS - 1; k >= 0; --k)
    v -= max(0.0, dot(sides[k].n, v) - sides[k].near) * sides[k].n;
  return v;
}

// The velocity, so much shorter that no side is crossed.
vec2 shortened(CellSide sides[NEIGHBOURS], vec2 v) {
  float part = 1.0;
  [[unroll]] for (int k = 0; k < NEIGHBOURS; ++k) {
    float toward = dot(sides[k].n, v);
    part = toward > sides[k].deep ? min(part, sides[k].deep / toward) : part;
  }
  return part * v;
}

#endif
