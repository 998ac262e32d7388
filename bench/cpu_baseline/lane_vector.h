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

}  // namespace skitter::baseline
