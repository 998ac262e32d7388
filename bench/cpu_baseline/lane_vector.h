#pragma once

#include "bench/cpu_baseline/lanes.h"
#include "bench/cpu_baseline/vector.h"

namespace skitter::baseline {

template <class F>
Vec3<F> select(const Mask<F>& mask, const Vec3<F>& yes, const Vec3<F>& no) {
  return {select(mask, yes.x, no.x), select(mask, yes.y, no.y), select(mask, yes.z, no.z)};
}
template <class F>
Vec3<F> broadcast(const Vec3<float>& v) {
  return {F(v.x), F(v.y), F(v.z)};
}

// 1 / |v|, of nothing 1e10.
template <class F>
F inverseLength(const Vec3<F>& v) {
  return rsqrt(larger(dot(v, v), F(1e-20f)));
}
template <class F>
F length(const Vec3<F>& v) {
  return squareRoot(dot(v, v));
}
template <class F>
Vec3<F> normalized(const Vec3<F>& v) {
  return v * inverseLength(v);
}

template <class F>
Vec3<float> laneOf(const Vec3<F>& v, int i) {
  return {lane(v.x, i), lane(v.y, i), lane(v.z, i)};
}

// Some unit vector at right angles to the unit vector `line`.
template <class F>
Vec3<F> anyPerpendicular(const Vec3<F>& line) {
  const auto alongX = F(0.9f) < absolute(line.x);
  const Vec3<F> axis{select(alongX, F(0), F(1)), F(0), select(alongX, F(1), F(0))};
  return normalized(axis - line * dot(axis, line));
}

// l normalize(to - from), added to `from`.
template <class F>
Vec3<F> placeToward(const Vec3<F>& from, const Vec3<F>& to, float l) {
  const Vec3<F> gap = to - from;
  return from + gap * (inverseLength(gap) * F(l));
}

// l normalize(v); along X where v is nothing, so that no bone of a result collapses. (What makes that so is
// far below rounding elsewhere.)
template <class F>
Vec3<F> ofLength(Vec3<F> v, float l) {
  v.x = v.x + F(2e-10f);
  return v * (inverseLength(v) * F(l));
}

// True where every joint is within 1e-3 of the line from base to tip.
template <class F>
Mask<F> isStraight(const Vec3<F>* joints, int bones) {
  const Vec3<F> line = normalized(joints[bones - 1]);
  F farthest(0);
  for (int i = 0; i < bones - 1; ++i) {
    const Vec3<F> aside = joints[i] - line * dot(joints[i], line);
    farthest = larger(farthest, dot(aside, aside));
  }
  return farthest <= F(1e-6f);
}

}  // namespace skitter::baseline
