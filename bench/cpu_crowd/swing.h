#pragma once

#include "bench/cpu_crowd/layout.h"

namespace skitter::cpu_crowd {

// A step's spline, relative to the body: two cubic Hermite segments through p0, (p0 + p1)/2 + lift, p1.
template <class F>
struct Flight {
  Vec3<F> p0, p1, lift, m0;
  F startRate;  // of eased time: 0 from rest, 1 aimed anew

  Flight(const Step<F>& step, const Agent<F>& a)
      : p0(relative(step.liftOff, step, a)),
        p1(relative(step.landing, step, a)),
        lift(step.lift),
        m0(step.startTangent) {
    const Vec3<F> d = m0 - lift;
    startRate = select(absolute(d.x) + absolute(d.y) + absolute(d.z) <= F(0), F(0), F(1));
  }

  F easedTime(const F& u) const { return u * (u * (F(3) - u * 2.0f) + startRate * (F(1) - u) * (F(1) - u)); }
  F easedRate(const F& u) const { return u * (F(6) - u * 6.0f) + startRate * (F(1) + u * (u * 3.0f - 4.0f)); }

  Vec3<F> point(const F& u) const {
    const Segment g(*this, u);
    const F s = g.s, s2 = s * s, s3 = s2 * s, rest = s2 * 3.0f - s3 * 2.0f;
    return g.a * (F(1) - rest) + g.ma * (s3 - s2 * 2.0f + s) + g.b * rest + g.mb * (s3 - s2);
  }
  // By the segment's own parameter.
  Vec3<F> tangent(const F& u) const {
    const Segment g(*this, u);
    const F s = g.s, s2 = s * s;
    return (g.a - g.b) * ((s2 - s) * 6.0f) + g.ma * (s2 * 3.0f - s * 4.0f + 1.0f) +
           g.mb * (s2 * 3.0f - s * 2.0f);
  }

 private:
  struct Segment {
    Vec3<F> a, ma, b, mb;
    F s;
    Segment(const Flight& f, const F& u) {
      const auto early = u < F(0.5f);
      const Vec3<F> middle = (f.p0 + f.p1) * 0.5f + f.lift, mm = (f.p1 - f.p0) * 0.5f;
      s = u + u - select(early, F(0), F(1));
      a = select(early, f.p0, middle);
      ma = select(early, f.m0, mm);
      b = select(early, middle, f.p1);
      mb = select(early, mm, Vec3<F>{-f.lift.x, -f.lift.y, -f.lift.z});
    }
  };
};

template <class F>
[[gnu::flatten]] void swing(float tick, const Agent<F>& a, const Step<F>& step, Foot<F>& foot) {
  const F flown = F(tick) - step.firstTick, ticks = absolute(step.ticks);
  const auto planted = ticks <= flown;
  foot.target = relative(step.landing, step, a);
  foot.progress = F(1);
  if (!any(!planted)) return;
  const F u = clamp(flown * reciprocal(ticks), 0, 1);
  const Flight<F> flight(step, a);
  foot.target = select(planted, foot.target, flight.point(flight.easedTime(u)));
  foot.progress = select(planted, F(1), u);
}

}  // namespace skitter::cpu_crowd
