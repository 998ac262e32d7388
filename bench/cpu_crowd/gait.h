#pragma once

#include <bit>

#include "bench/cpu_crowd/layout.h"
#include "bench/cpu_crowd/rig.h"
#include "skitter/rig.h"

namespace skitter::cpu_crowd {

// A share of the half stride. A leg that steps without a rhythm is out of comfort beyond it.
inline constexpr float kReachShare = 0.6f;

// Lanes whose leg lifts, or is aimed anew; a set a leg.
struct Begun {
  uint64_t lift[Rig::maxLegs], reaim[Rig::maxLegs];
};

// Where in model space a foot should land that touches down in `time` seconds: its home in the middle of the
// stance that follows.
template <class F>
Vec3<F> predictLanding(const Vec3<F>& home, const Agent<F>& a, const F& time, const F& stance) {
  const F ahead = time + stance * 0.5f;
  Vec3<F> landing = Turn<F>(a.turnRate * ahead)(home);
  landing.z = landing.z + a.surfaceSpeed * ahead;
  return landing;
}

template <class F, int N>
[[gnu::flatten]] void gait(const World& world, float tick, Agent<F>& a, const Leg<F, N>* legs, Begun& begun) {
  const shared::Parameters& q = world.q;
  const int count = int(world.legs.size());
  const float groups = float(world.groups);
  const F v = a.surfaceSpeed + absolute(a.turnRate) * q.homeRadius;
  const F pace = reciprocal(F(1) + v * (1 / q.swingSpeed));
  a.duration = larger(F(2), roundDown(pace * (q.swingStill / q.dt) + 0.5f));
  const F swing = a.duration * q.dt, duty = larger(F(q.dutyLeast), F(q.dutyStill) - v * q.dutyGain);
  const F cycle =
      larger(smaller(F(q.cycleMax), swing * reciprocal(F(1) - duty)), swing * (groups * q.windowSlack));
  const F stance = cycle - swing, inverseCycle = reciprocal(cycle);
  const F halfStride = clamp(v * stance * 0.5f, q.halfStrideStill, q.halfStrideMax);
  const F spread = (F(1 / groups) - swing * inverseCycle) * q.lagShare;
  F phase = a.phase + inverseCycle * q.dt;
  phase = phase - roundDown(phase);
  a.phase = phase;
  a.cycle = cycle;
  a.halfStride = halfStride;

  const bool reach = q.reachTriggered != 0;
  const F comfort = halfStride * (reach ? kReachShare : q.liftShare), astray = halfStride * q.strayShare;
  const auto settled = F(q.settleTime) <= a.still;
  const Mat3<F> r = matrixOf(a.orientation);
  uint64_t air[Rig::maxLegs], wants[Rig::maxLegs];
  F stoodSince(3e38f), first(-1);
  for (int l = 0; l < count; ++l) {
    const LegModel& model = world.legs[l];
    const Step<F>& step = legs[l].step;
    const F flown = F(tick - 1) - step.firstTick, ticks = absolute(step.ticks);
    const auto planted = ticks <= flown;
    const Vec3<F> foot = transposedTimes(r, relative(step.landing, step, a));
    air[l] = bits(!planted);

    const F stretch = length(foot - broadcast<F>(model.root));
    const F dx = foot.x - model.home.x, dz = foot.z - model.home.z, off = squareRoot(dx * dx + dz * dz);
    auto must = (stretch < F(q.rootShare * model.reach)) | (F(q.stretchLift * model.reach) < stretch) |
                (astray < off) | (F(q.errorLift) < legs[l].chain.error);
    const auto far = comfort < off;
    auto want = planted & !settled & (far | must | (step.ticks < F(0)));
    if (!reach) {
      F since = phase - (spread * model.lag + model.group / groups);
      since = since - roundDown(since);
      want = want & (since * groups < F(q.windowOpen));
    } else {
      must = must | far;
    }
    wants[l] = bits(want);
    const F stood = step.firstTick + ticks;
    const auto longest = planted & !settled & must & (stood < stoodSince);
    stoodSince = select(longest, stood, stoodSince);
    first = select(longest, F(float(l)), first);

    begun.reaim[l] = 0;
    const auto mayAim = (!planted) & (F(4) <= flown) & (flown < ticks * q.reaimLatest);
    if (any(mayAim)) {
      const Vec3<F> to = predictLanding(broadcast<F>(model.home), a, (ticks - flown) * q.dt, stance);
      const F ax = to.x - foot.x, az = to.z - foot.z;
      begun.reaim[l] = bits(mayAim & (F(q.reaimDistance * q.reaimDistance) < ax * ax + az * az));
    }
  }

  // The leg that must lift and has stood longest goes first, and its neighbours wait for it.
  uint64_t yields[Rig::maxLegs] = {};
  for (int l = 0; l < count; ++l) {
    const uint64_t goes = bits(absolute(first - float(l)) < F(0.5f));
    begun.lift[l] = goes;
    for (uint32_t m = world.legs[l].neighbours; m != 0; m &= m - 1) {
      yields[std::countr_zero(m)] |= goes;
      begun.lift[l] &= ~air[std::countr_zero(m)];
    }
  }
  F lift(0), reaim(0), aloft(0);
  for (int l = 0; l < count; ++l) {
    uint64_t blocked = yields[l];
    for (uint32_t m = world.legs[l].neighbours; m != 0; m &= m - 1)
      blocked |= air[std::countr_zero(m)] | begun.lift[std::countr_zero(m)];
    begun.lift[l] |= wants[l] & ~blocked;
    const float bit = float(1u << l);
    lift = lift + flags<F>(begun.lift[l]) * bit;
    reaim = reaim + flags<F>(begun.reaim[l]) * bit;
    aloft = aloft + flags<F>(air[l]) * bit;
  }
  a.lift = lift;
  a.reaim = reaim;
  a.air = aloft;
}

}  // namespace skitter::cpu_crowd
