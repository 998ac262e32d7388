#pragma once

#include "bench/cpu_crowd/avoid/neighbours.h"

// docs/stages/avoid.md, "2. What is wanted" to "7. Result", of the agents of a block. Metres, metres per
// second; x, z.
namespace skitter::cpu_avoid {

constexpr float horizon = 0.7f, pushTime = 0.5f;
constexpr float roomOfLegs = 1.55f, roomGoing = 3.55f;  // times the footprints
constexpr float turnSlope = 4;
constexpr float rightBias = 0.05f;
constexpr float softness = 0.05f;
constexpr int sweeps = 6;
constexpr float deepRoom = 0.01f, looseBelow = 0.9f, easeTime = 0.4f;
constexpr float shareOfSecond = 0.4f, creepRate = 0.3f;
constexpr int cellSweeps = 2;
// leg lengths a second
constexpr float pushSpeed = 0.3f, steadySpeed = 0.05f, slackSpeed = 1e-4f, freeSpeed = 100;

template <class F>
struct Vec2 {
  F x, z;
};
template <class F>
F dot(const Vec2<F>& a, const Vec2<F>& b) {
  return a.x * b.x + a.z * b.z;
}
template <class F>
F lengthOf(const Vec2<F>& a) {
  return squareRoot(dot(a, a));
}

// A neighbour, as an agent sees it.
template <class F>
struct Neighbour {
  Mask<F> isThere;
  Vec2<F> p;  // from the agent to it
  F d;        // |p|
  F radii;    // of both
  F lesser;   // the smaller of both
  Vec2<F> v;  // the agent's velocity less its own
  F share;    // of the change that the agent takes
  Mask<F> goesFirst;
  Vec2<F> part;  // where the agent goes if p is 0
};

// "2. What is wanted"
template <class F>
struct Wish {
  Vec2<F> desired;  // v_n
  F speed;          // |v_n|
  F close = F(0), right = F(0), left = F(0);

  explicit Wish(const Vec2<F>& of) : desired(of), speed(lengthOf(of)) {}
  void see(const Neighbour<F>& other) {
    const F c = select(other.isThere, clamp(F(2) - other.d / (F(roomOfLegs) * other.radii), 0, 1), F(0));
    close = larger(close, c);
    const F size = F(1) / larger(other.d * speed, F(1e-6f));
    const F sine = (desired.x * other.p.z - desired.z * other.p.x) * size;
    const F turn = c * larger(F(0), dot(other.p, desired)) * size * clamp(F(1) - F(turnSlope) * sine, -1, 1);
    right = larger(right, turn);
    left = larger(left, F(0) - turn);
  }
  // v_0, of an agent that goes at speed s.
  Vec2<F> wanted(const F& s) const {
    const F t = (right - left) * larger(F(0), F(1) - s / larger(speed, F(1e-6f)));
    // Without neighbours it is v_n to the last bit, however the root is rounded.
    const Mask<F> turns = F(0) < t * t;
    if (!any(turns)) return desired;
    const F norm = F(1) / squareRoot(F(1) + t * t);
    return {select(turns, (desired.x - t * desired.z) * norm, desired.x),
            select(turns, (desired.z + t * desired.x) * norm, desired.z)};
  }
};

template <class F>
struct HalfPlane {
  Vec2<F> n;
  F bound;
};

// "3. Half-planes": m, of an agent that goes at speed s.
template <class F>
F roomOf(const F& s, const F& wanted) {
  return F(roomOfLegs) + F(roomGoing - roomOfLegs) * clamp(F(2) * s / larger(wanted, F(1e-6f)), 0, 1);
}

// A bound needs no more of a neighbour's u than n . u, so u is that number here.
template <class F>
HalfPlane<F> halfPlaneOf(const Neighbour<F>& other, const Vec2<F>& own, const F& room, float look) {
  const auto& [isThere, p, d, footprints, lesser, v, share, goesFirst, part] = other;
  const F radii = smaller(footprints * room, footprints + F(look)), power = (d - radii) * (d + radii);
  const Vec2<F> w{v.x - p.x * F(1 / horizon), v.z - p.z * F(1 / horizon)};
  const F along = dot(w, p), speed2 = dot(w, w), speed = squareRoot(speed2);
  // one of the cone's sides
  const F a = p.x * w.z - p.z * w.x + F(rightBias) * d * speed;
  const F side = select(F(0) <= a, F(1), F(-1)), l = side * squareRoot(larger(power, F(0)));
  const F inverse2 = F(1) / larger(d * d, F(1e-20f));
  Vec2<F> n{-(p.z * l + p.x * radii) * inverse2, (p.x * l - p.z * radii) * inverse2};
  F u = -dot(n, v);
  // its round end
  const Mask<F> round = (along < F(0)) & (radii * radii * speed2 < along * along);
  if (any(round)) {
    const F inverse = F(1) / larger(speed, F(1e-9f));
    n = {select(round, w.x * inverse, n.x), select(round, w.z * inverse, n.z)};
    u = select(round, radii * F(1 / horizon) - speed, u);
  }
  const Mask<F> overlaps = power <= F(0);
  if (any(overlaps)) {
    const F inverse = F(-1) / larger(d, F(1e-20f));
    const Mask<F> apart = F(0) < d;
    const Vec2<F> away{select(apart, p.x * inverse, part.x), select(apart, p.z * inverse, part.z)};
    n = {select(overlaps, away.x, n.x), select(overlaps, away.z, n.z)};
    const F push =
        larger(F(0), footprints - d) * F(1 / pushTime) + (radii - larger(d, footprints)) * F(1 / horizon);
    u = select(overlaps, push - dot(away, v), u);
  }
  // Who is not there forbids nothing.
  return {{select(isThere, n.x, F(0)), select(isThere, n.z, F(0))},
          select(isThere, dot(n, own) + share * u, F(-1))};
}

template <class F>
bool isForbidden(const HalfPlane<F>* planes, int count, const Vec2<F>& v) {
  bool forbidden = false;
  for (int k = 0; k < count; ++k) forbidden = forbidden || any(dot(planes[k].n, v) < planes[k].bound);
  return forbidden;
}

// "5. Solution", without obstacles.
template <class F>
Vec2<F> solved(const HalfPlane<F>* planes, int count, Vec2<F> v) {
  F lambda[mostNeighbours];
  for (int k = 0; k < count; ++k) lambda[k] = F(0);
  for (int sweep = 0; sweep < sweeps; ++sweep)
    for (int k = count - 1; k >= 0; --k) {
      const auto& [n, bound] = planes[k];
      const F lacking = bound - dot(n, v) - F(softness) * lambda[k];
      const F more = larger(F(0), lambda[k] + lacking * F(1 / (1 + softness)));
      const F step = more - lambda[k];
      v = {v.x + step * n.x, v.z + step * n.z};
      lambda[k] = more;
    }
  return v;
}

// "6. Cells": velocities of at most these numbers along n.
template <class F>
struct CellSide {
  Vec2<F> n;
  F near, deep, eased;
};

template <class F>
CellSide<F> cellSideOf(const Neighbour<F>& other, const Vec2<F>& own, float dt, float legLength) {
  // A neighbour that is not there has no distance.
  const F d = select(other.isThere, other.d, F(1)), inverse = F(1) / larger(d, F(1e-9f));
  const Vec2<F> n{select(other.isThere, other.p.x * inverse, F(0)),
                  select(other.isThere, other.p.z * inverse, F(0))};
  const F gap = d - other.radii, room = d - F(roomOfLegs) * other.radii;
  const F lacking = select(other.goesFirst, larger(F(0), F(0) - room), F(0));
  const F back = smaller(lacking * F(1 / easeTime), F(pushSpeed * legLength));
  const F leaves = larger(F(0), dot(n, own) - dot(n, other.v));
  const F loose = larger(F(0), F(looseBelow) * other.radii - d);
  const F wish =
      select(F(0.75f) < other.share, F(1), select(other.goesFirst, F(shareOfSecond), F(1 - shareOfSecond)));
  const F near = larger(F(0), room) * wish + loose;
  const F deep = larger(F(0), gap - F(deepRoom) * other.lesser) * other.share + loose;
  const F aTick(1 / dt), aTime(1 / easeTime), slack(slackSpeed * legLength);
  const F creep = F(creepRate) * other.share * larger(F(0), gap);
  return {n, smaller(near * aTick, near * aTime + leaves) - back + creep, deep * aTick + slack,
          smaller(deep * aTick, deep * aTime + leaves) + slack};
}

// The body's speed along its heading. Who is not there has n = 0, and so forbids nothing.
template <class F>
F speedAlong(const CellSide<F>* sides, int count, const Vec2<F>& heading, float legLength) {
  F most(freeSpeed * legLength);
  for (int k = 0; k < count; ++k)
    most = smaller(most, sides[k].eased / larger(dot(sides[k].n, heading), F(1e-6f)));
  return most;
}

template <class F>
Vec2<F> withinCell(const CellSide<F>* sides, int count, Vec2<F> v) {
  for (int sweep = 0; sweep < cellSweeps; ++sweep)
    for (int k = count - 1; k >= 0; --k) {
      const F back = larger(F(0), dot(sides[k].n, v) - sides[k].near);
      v = {v.x - back * sides[k].n.x, v.z - back * sides[k].n.z};
    }
  F part(1);
  for (int k = 0; k < count; ++k) {
    const F toward = dot(sides[k].n, v);
    part = select(sides[k].deep < toward, smaller(part, sides[k].deep / toward), part);
  }
  return {v.x * part, v.z * part};
}

// "7. Result", of an agent that does not sleep.
template <class F>
Vec2<F> resultOf(const Vec2<F>& v, const Wish<F>& wish, const Vec2<F>& heading, float legLength) {
  const F most = larger(wish.speed, F(pushSpeed * legLength)), length = lengthOf(v);
  const F cut = select(most < length, most / larger(length, F(1e-6f)), F(1)), m = smaller(length, most);
  const F steady = F(steadySpeed * legLength) * wish.close;
  const F share = m / larger(m + steady, F(1e-6f));
  const Mask<F> isAmongOthers = F(0) < wish.close;
  const Vec2<F> kept{v.x * cut, v.z * cut};
  return {select(isAmongOthers, (kept.x + steady * heading.x) * share, kept.x),
          select(isAmongOthers, (kept.z + steady * heading.z) * share, kept.z)};
}

}  // namespace skitter::cpu_avoid
