#pragma once

#include "bench/cpu_baseline/refill.h"

namespace skitter::baseline {

template <class F>
struct SineCosine {
  F sine, cosine;
};

// For an angle within 0 .. 3.1, by Taylor's series about pi / 2: off by 6e-8 at most.
template <class F>
SineCosine<F> sineCosine(const F& angle) {
  const F y = angle - F(1.57079633f), yy = y * y;
  const F sine =
      y *
      (F(1) + yy * (F(-1.66666667e-1f) +
                    yy * (F(8.33333333e-3f) +
                          yy * (F(-1.98412698e-4f) + yy * (F(2.75573192e-6f) + yy * F(-2.50521084e-8f))))));
  const F cosine =
      F(1) +
      yy * (F(-0.5f) +
            yy * (F(4.16666667e-2f) +
                  yy * (F(-1.38888889e-3f) +
                        yy * (F(2.48015873e-5f) + yy * (F(-2.75573192e-7f) + yy * F(2.0876757e-9f))))));
  return {cosine, -sine};
}

// The angle of sine `s` >= 0 and cosine `c`, within 0 .. pi; Cephes' polynomial of atan below tan(pi / 8).
template <class F>
F angleOf(const F& s, const F& c) {
  const F size = absolute(c), least = smaller(s, size), most = larger(larger(s, size), F(1e-20f));
  const auto steep = F(0.41421356f) * most < least;  // turned by pi / 4 to be below it
  const F x = select(steep, least - most, least) / select(steep, least + most, most), xx = x * x;
  F angle = x + x * xx *
                    (F(-3.33329491539e-1f) +
                     xx * (F(1.99777106478e-1f) + xx * (F(-1.38776856032e-1f) + xx * F(8.05374449538e-2f))));
  angle = select(steep, angle + F(0.785398163f), angle);
  angle = select(size < s, F(1.57079633f) - angle, angle);
  return select(c < F(0), F(3.14159265f) - angle, angle);
}

// The way a bone is turned from rest, and the sine of how far.
template <class F>
struct Turned {
  F s, x, y;
};
// `fallback`: h.x where s is too small for a direction.
template <class F>
Turned<F> turnedOf(const Vec3<F>& d, const Mask<F>& tooSmall) {
  const F square = d.x * d.x + d.y * d.y, inverse = rsqrt(larger(square, F(1e-20f)));
  return {square * inverse, select(tooSmall, F(1), d.x * inverse), select(tooSmall, F(0), d.y * inverse)};
}

// Inverses of the half-angles on the side of h.
template <class F>
struct InverseAxes {
  F x, y;
};
template <class F>
InverseAxes<F> inverseAxes(const BoneModel& bone, const Turned<F>& h) {
  return {select(h.x < F(0), F(bone.inverseNegativeX), F(bone.inversePositiveX)),
          select(h.y < F(0), F(bone.inverseNegativeY), F(bone.inversePositiveY))};
}

template <class F>
Vec3<F> clampHinge(const BoneModel& bone, const Vec3<F>& d) {
  // tan(q / 2) = sin q / (1 + cos q), d = (0, -sin q, cos q)
  const F scale = F(1) + d.z;
  const auto below = -d.y < F(bone.lowTanHalf) * scale, above = F(bone.highTanHalf) * scale < -d.y;
  const F y = select(below, F(-bone.lowSine), select(above, F(-bone.highSine), d.y));
  const F z = select(below, F(bone.lowCosine), select(above, F(bone.highCosine), d.z));
  return {F(0), y, z};
}

template <class F>
Vec3<F> clampBall(const BoneModel& bone, const Vec3<F>& d) {
  const F square = d.x * d.x + d.y * d.y;
  const auto turnedOver = (square < F(1e-6f)) & (d.z < F(0));
  const Turned<F> h = turnedOf(d, turnedOver);
  SineCosine<F> most{F(bone.coneSine), F(bone.coneCosine)};
  F inside = F(bone.coneTanHalf) * (F(1) + d.z) - h.s;  // tan(theta / 2) = s / (1 + d.z), small angles exact
  if (bone.kind == LimitKind::ellipse) {
    const InverseAxes<F> axes = inverseAxes(bone, h);
    const F x = h.x * axes.x, y = h.y * axes.y;
    most = sineCosine(smaller(rsqrt(larger(x * x + y * y, F(1e-20f))), F(3.1f)));
    inside = most.sine * (F(1) + d.z) - h.s * (F(1) + most.cosine);
  }
  const auto outside = turnedOver | (inside < F(0));
  return select(outside, Vec3<F>{h.x * most.sine, h.y * most.sine, most.cosine}, d);
}

template <class F>
Vec3<F> clampSwing(const BoneModel& bone, const Vec3<F>& d) {
  return bone.kind == LimitKind::hinge ? clampHinge(bone, d) : clampBall(bone, d);
}

template <class F>
F clampTwist(const BoneModel& bone, const F& tanHalf) {
  return larger(smaller(tanHalf, F(bone.twistHighTanHalf)), F(bone.twistLowTanHalf));
}

}  // namespace skitter::baseline
