#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

// Velocities in half-planes and a disc. The method is incremental linear programming in two dimensions (de
// Berg et al., Computational Geometry, chapter 4): half-planes come one after another, and where one forbids
// the best velocity so far, the best one is on its edge. Numbers are double: in scalar code that costs little
// more than float, and half-planes that are nearly parallel lose nothing.
namespace skitter::cpu_avoid {

struct Velocity {
  double x = 0, z = 0;
};
inline double dot(const Velocity& a, const Velocity& b) { return a.x * b.x + a.z * b.z; }

// Allows v with n . v >= bound; n is a unit vector.
struct Allowed {
  Velocity n;
  double bound = 0;

  double violation(const Velocity& v) const { return bound - dot(n, v); }
};

// What is best: the nearest to `v`, or the farthest along `v`, a unit vector.
struct Aim {
  enum class Kind { nearest, farthest } kind = Kind::nearest;
  Velocity v;
};

// The sine of an angle below which edges are parallel: what is lost is this share of the speed.
constexpr double parallel = 1e-9;

// The best velocity on the edge of the last half-plane that the ones before it and the disc allow. False, and
// `v` as it was, where there is none.
inline bool solveOnEdge(std::span<const Allowed> planes, double speed, const Aim& aim, Velocity& v) {
  const Allowed& last = planes.back();
  const double squared = speed * speed - last.bound * last.bound;
  if (squared < 0) return false;
  const Velocity along{-last.n.z, last.n.x};
  double high = std::sqrt(squared), low = -high;
  for (const Allowed& other : planes.first(planes.size() - 1)) {
    const double slope = dot(other.n, along), lacking = other.bound - last.bound * dot(other.n, last.n);
    if (std::abs(slope) <= parallel) {
      if (lacking > 0) return false;
      continue;
    }
    const double crossing = lacking / slope;
    if (slope > 0)
      low = std::max(low, crossing);
    else
      high = std::min(high, crossing);
    if (low > high) return false;
  }
  const double wanted = dot(aim.v, along);
  const double at = aim.kind == Aim::Kind::nearest ? std::clamp(wanted, low, high) : wanted > 0 ? high : low;
  v = {last.bound * last.n.x + at * along.x, last.bound * last.n.z + at * along.z};
  return true;
}

// How many half-planes, from the first on, can be had at once: all of them, or those before the first that
// cannot. `v` is the best velocity in these and in the disc.
inline size_t solveProgram(std::span<const Allowed> planes, double speed, const Aim& aim, Velocity& v) {
  const double length = std::sqrt(dot(aim.v, aim.v));
  const double scale = aim.kind == Aim::Kind::farthest ? speed : length > speed ? speed / length : 1;
  v = {aim.v.x * scale, aim.v.z * scale};
  for (size_t i = 0; i < planes.size(); ++i)
    if (planes[i].violation(v) > 0 && !solveOnEdge(planes.first(i + 1), speed, aim, v)) return i;
  return planes.size();
}

// The three-dimensional program: of the velocities in the disc one for which the largest violation is least.
// `v` is the best one in the half-planes before the `begin`-th, which cannot be had beside them. Where a
// half-plane is violated more than all before it, it is violated most at the optimum, too: no other one is
// violated more where (n_j - n) . v >= bound_j - bound, and its own violation falls along n.
template <size_t most>
void solveLeastViolation(std::span<const Allowed> planes, size_t begin, double speed, Velocity& v) {
  Allowed bisectors[most];
  double worst = 0;
  for (size_t i = begin; i < planes.size(); ++i) {
    if (planes[i].violation(v) <= worst) continue;
    size_t count = 0;
    for (const Allowed& other : planes.first(i)) {
      const Velocity way{other.n.x - planes[i].n.x, other.n.z - planes[i].n.z};
      const double length = std::sqrt(dot(way, way));
      if (length <= parallel) continue;
      bisectors[count++] = {{way.x / length, way.z / length}, (other.bound - planes[i].bound) / length};
    }
    Velocity better;
    const std::span<const Allowed> all(bisectors, count);
    if (solveProgram(all, speed, {Aim::Kind::farthest, planes[i].n}, better) == count) v = better;
    worst = planes[i].violation(v);
  }
}

}  // namespace skitter::cpu_avoid
