#pragma once

#include "bench/cpu_baseline/lane_vector.h"

namespace skitter::baseline {

// The matrix of normal equations, symmetric.
template <class F>
struct Normal {
  F xx, xy, xz, yy, yz, zz;

  void add(const Vec3<F>& c) {
    xx = xx + c.x * c.x;
    xy = xy + c.x * c.y;
    xz = xz + c.x * c.z;
    yy = yy + c.y * c.y;
    yz = yz + c.y * c.z;
    zz = zz + c.z * c.z;
  }
  void remove(const Vec3<F>& a, const Vec3<F>& c) {
    xx = xx - a.x * c.x;
    xy = xy - a.x * c.y;
    xz = xz - a.x * c.z;
    yy = yy - a.y * c.y;
    yz = yz - a.y * c.z;
    zz = zz - a.z * c.z;
  }
  Normal inverse() const {
    const F a = yy * zz - yz * yz, b = yz * xz - xy * zz, c = xy * yz - xz * yy;
    const F k = F(1) / (xx * a + xy * b + xz * c);
    return {k * a, k * b, k * c, k * (xx * zz - xz * xz), k * (xy * xz - xx * yz), k * (xx * yy - xy * xy)};
  }
  Vec3<F> operator*(const Vec3<F>& v) const {
    return {xx * v.x + xy * v.y + xz * v.z, xy * v.x + yy * v.y + yz * v.z, xz * v.x + yz * v.y + zz * v.z};
  }
  // M^-1 e by L D L^T. In exact numbers no pivot is below the damping; in single precision it is held there,
  // which keeps a chain that can move in one direction only from dividing by what rounding left.
  Vec3<F> solve(const Vec3<F>& e, const F& damping) const {
    const F d0 = F(1) / larger(xx, damping), l1 = xy * d0, l2 = xz * d0;
    const F d1 = F(1) / larger(yy - l1 * xy, damping), rest = yz - l2 * xy, l3 = rest * d1;
    const F d2 = F(1) / larger(zz - l2 * xz - l3 * rest, damping);
    const F y = e.y - l1 * e.x, z = (e.z - l2 * e.x - l3 * y) * d2;
    const F second = y * d1 - l3 * z;
    return {e.x * d0 - l1 * second - l2 * z, second, z};
  }
};

}  // namespace skitter::baseline
