#pragma once

#include <type_traits>

namespace skitter::baseline {

template <class F>
struct Vec3 {
  F x, y, z;
};

template <class F>
Vec3<F> operator+(const Vec3<F>& a, const Vec3<F>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class F>
Vec3<F> operator-(const Vec3<F>& a, const Vec3<F>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class F>
Vec3<F> operator*(const Vec3<F>& a, std::type_identity_t<F> s) {
  return {a.x * s, a.y * s, a.z * s};
}
template <class F>
F dot(const Vec3<F>& a, const Vec3<F>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class F>
Vec3<F> cross(const Vec3<F>& a, const Vec3<F>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
// Columns.
template <class F>
struct Mat3 {
  Vec3<F> x, y, z;
};
template <class F>
Vec3<F> operator*(const Mat3<F>& m, const Vec3<F>& v) {
  return {m.x.x * v.x + m.y.x * v.y + m.z.x * v.z, m.x.y * v.x + m.y.y * v.y + m.z.y * v.z,
          m.x.z * v.x + m.y.z * v.y + m.z.z * v.z};
}
// m^T v.
template <class F>
Vec3<F> transposedTimes(const Mat3<F>& m, const Vec3<F>& v) {
  return {dot(m.x, v), dot(m.y, v), dot(m.z, v)};
}

}  // namespace skitter::baseline
