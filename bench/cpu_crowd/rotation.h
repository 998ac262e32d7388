#pragma once

#include "bench/cpu_crowd/lanes.h"

namespace skitter::cpu_crowd {

template <class F>
Mat3<F> broadcast(const Mat3<float>& m) {
  return {broadcast<F>(m.x), broadcast<F>(m.y), broadcast<F>(m.z)};
}

template <class F>
struct Quaternion {
  F x, y, z, w;
};

template <class F>
Mat3<F> matrixOf(const Quaternion<F>& q) {
  const F x2 = q.x + q.x, y2 = q.y + q.y, z2 = q.z + q.z;
  const F xx = x2 * q.x, yy = y2 * q.y, zz = z2 * q.z, xy = x2 * q.y, xz = x2 * q.z, yz = y2 * q.z;
  const F wx = x2 * q.w, wy = y2 * q.w, wz = z2 * q.w;
  return {{F(1) - yy - zz, xy + wz, xz - wy},
          {xy - wz, F(1) - xx - zz, yz + wx},
          {xz + wy, yz - wx, F(1) - xx - yy}};
}

template <class F>
Quaternion<F> select(const Mask<F>& mask, const Quaternion<F>& yes, const Quaternion<F>& no) {
  return {select(mask, yes.x, no.x), select(mask, yes.y, no.y), select(mask, yes.z, no.z),
          select(mask, yes.w, no.w)};
}

template <class F>
F dot(const Quaternion<F>& a, const Quaternion<F>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w;
}

template <class F>
Quaternion<F> product(const Quaternion<F>& a, const Quaternion<F>& b) {
  return {a.w * b.x + b.w * a.x + (a.y * b.z - a.z * b.y), a.w * b.y + b.w * a.y + (a.z * b.x - a.x * b.z),
          a.w * b.z + b.w * a.z + (a.x * b.y - a.y * b.x), a.w * b.w - (a.x * b.x + a.y * b.y + a.z * b.z)};
}

template <class F>
Vec3<F> rotated(const Quaternion<F>& q, const Vec3<float>& v) {
  const Vec3<F> u{q.x, q.y, q.z}, w = broadcast<F>(v), t = cross(u, w) * 2.0f;
  return w + t * q.w + cross(u, t);
}

// The rotation's quaternion, by the best conditioned of its four forms.
template <class F>
Quaternion<F> quaternionOf(const Mat3<F>& m) {
  const F sx = F(1) + m.x.x - m.y.y - m.z.z, sy = F(1) - m.x.x + m.y.y - m.z.z;
  const F sz = F(1) - m.x.x - m.y.y + m.z.z, sw = F(1) + m.x.x + m.y.y + m.z.z;
  const F xy = m.x.y + m.y.x, zx = m.z.x + m.x.z, yz = m.y.z + m.z.y;
  const F wx = m.y.z - m.z.y, wy = m.z.x - m.x.z, wz = m.x.y - m.y.x;
  Quaternion<F> q{wx, wy, wz, sw};
  F largest = sw;
  const auto consider = [&](const F& size, const Quaternion<F>& other) {
    const auto better = largest < size;
    q = select(better, other, q);
    largest = larger(largest, size);
  };
  consider(sx, {sx, xy, zx, wx});
  consider(sy, {xy, sy, yz, wy});
  consider(sz, {zx, yz, sz, wz});
  const F inverse = rsqrt(larger(dot(q, q), 1e-20f));
  return {q.x * inverse, q.y * inverse, q.z * inverse, q.w * inverse};
}

// About +Y by 2 atan(theta / 2) (docs/stages.md, turn).
template <class F>
struct Turn {
  F cosine, sine;
  explicit Turn(const F& theta) {
    const F t = theta * 0.5f, tt = t * t, scale = reciprocal(F(1) + tt);
    cosine = (F(1) - tt) * scale;
    sine = (t + t) * scale;
  }
  Vec3<F> operator()(const Vec3<F>& v) const {
    return {cosine * v.x + sine * v.z, v.y, cosine * v.z - sine * v.x};
  }
};

}  // namespace skitter::cpu_crowd
