#pragma once

#include "bench/cpu_crowd/gait.h"
#include "bench/cpu_crowd/ground.h"
#include "bench/cpu_crowd/swing.h"

namespace skitter::cpu_crowd {

// Legs that begin a step or are aimed anew, a lane each, of whatever agents.
template <class F>
struct Beginning {
  Agent<F> agent;
  Step<F> step;  // the old one; foothold makes it the new one
  Vec3<F> root, home;
  F reach, reaim;  // 1: aimed anew
};

template <class F>
class Foothold {
 public:
  Foothold(const World& world, float tick, const Beginning<F>& b)
      : world_(world),
        q_(world.q),
        b_(b),
        a_(b.agent),
        reaim_(F(0.5f) < b.reaim),
        r_(matrixOf(a_.orientation)) {
    x_ = a_.tileX * shared::TILE_SIZE + a_.localX;
    z_ = a_.tileZ * shared::TILE_SIZE + a_.localZ;
    oldTicks_ = absolute(b.step.ticks);
    flown_ = F(tick - 1) - b.step.firstTick;
    ticks_ = select(reaim_, larger(oldTicks_ - flown_, 2), a_.duration);
  }

  Step<F> step(float tick) const {
    Step<F> next;
    const Ladder ladder = ladderOf();
    Vec3<F> p1;
    const auto none = !findBest(ladder, p1);
    if (any(none)) p1 = select(none, lastResort(ladder), p1);

    const Flight<F> flight(b_.step, a_);
    const F inverse = reciprocal(oldTicks_), u = clamp(flown_ * inverse, 0, 1), way = flight.easedTime(u);
    Vec3<F> p0 = flight.p1, m0{F(0), F(0), F(0)};
    if (any(reaim_)) {
      p0 = select(reaim_, flight.point(way), p0);
      m0 = select(reaim_, flight.tangent(way) * (flight.easedRate(u) * ticks_ * inverse), m0);
    }
    const F least = select(reaim_, F(1) - u, F(1)) * q_.stepHeight;
    const Vec3<F> lift = route(p0, p1, m0, least);
    next.landing = p1 + a_.local();
    next.liftOff = p0 + a_.local();
    next.lift = lift;
    next.startTangent = select(reaim_, m0, lift);
    next.tileX = a_.tileX;
    next.tileZ = a_.tileZ;
    next.firstTick = F(tick - 1);
    next.ticks = select(none, -ticks_, ticks_);
    return next;
  }

 private:
  // Rungs from the root toward the predicted landing: that and the root at touchdown, relative to the body
  // along world axes, and the ways from a rung to the next and from a place to the next along it.
  struct Ladder {
    Vec3<F> predicted, root, along, across;
  };

  Ladder ladderOf() const {
    const F time = ticks_ * q_.dt, stance = a_.cycle - a_.duration * q_.dt;
    const Vec3<F> tau = predictLanding(b_.home, a_, time, stance);
    Vec3<F> root = Turn<F>(a_.turnRate * time)(b_.root);
    root.z = root.z + a_.surfaceSpeed * time;
    F ox = tau.x - root.x, oz = tau.z - root.z;
    const F span = squareRoot(ox * ox + oz * oz), rho = larger(span, b_.reach * 0.1f);
    const auto below = span < F(1e-6f);
    ox = select(below, b_.home.x - b_.root.x, ox);
    oz = select(below, b_.home.z - b_.root.z, oz);
    const F size = rho * rsqrt(larger(ox * ox + oz * oz, 1e-20f));
    return {r_ * tau, r_ * root, (r_.x * ox + r_.z * oz) * (size * (1 / 3.0f)),
            (r_.z * ox - r_.x * oz) * (size * (1 / 6.0f))};
  }

  // visit(point, ground there, distance from the root) for each candidate, in order.
  template <class Visit>
  void eachCandidate(const Ladder& ladder, const Visit& visit) const {
    for (int k = 1; k <= 4; ++k) {
      for (int j = -k; j <= k; ++j) {
        Vec3<F> point = ladder.predicted + ladder.along * float(k - 3) + ladder.across * float(j);
        const Ground<F> ground = groundAt(world_.terrain, x_ + point.x, z_ + point.z);
        point.y = ground.height - a_.y;
        visit(point, ground, length(point - ladder.root));
      }
    }
  }

  // Cosine between the ground and the body's up axis.
  F facing(const Ground<F>& g) const {
    const Vec3<F>& up = r_.y;
    return (up.y - g.slopeX * up.x - g.slopeZ * up.z) *
           rsqrt(g.slopeX * g.slopeX + g.slopeZ * g.slopeZ + 1.0f);
  }

  // Where any candidate fits.
  Mask<F> findBest(const Ladder& ladder, Vec3<F>& best) const {
    const F least = b_.reach * q_.reachLeast, most = b_.reach * q_.reachMost,
            inverseReach = reciprocal(b_.reach);
    F lowest(3e38f);
    best = ladder.predicted;
    eachCandidate(ladder, [&](const Vec3<F>& point, const Ground<F>& g, const F& distance) {
      const F aligned = facing(g);
      const auto fits = (least <= distance) & (distance <= most) & (F(q_.slopeLeast) <= aligned);
      const Vec3<F> miss = point - ladder.predicted;
      F score = dot(miss, miss) * (1 / (q_.legLength * q_.legLength));
      if (q_.nearestOnly == 0) {
        const F strain = larger(F(0), distance * inverseReach - q_.reachComfort);
        score = score + (F(1) - aligned) * q_.slopeWeight + strain * strain * q_.reachWeight;
      }
      const auto better = fits & (score < lowest);
      lowest = select(better, score, lowest);
      best = select(better, point, best);
    });
    return lowest < F(3e38f);
  }

  // The candidate that is nearest to the leg's range, where none fits: one that faces up, if there is one.
  Vec3<F> lastResort(const Ladder& ladder) const {
    const F least = b_.reach * q_.reachLeast, most = b_.reach * q_.reachMost;
    F misfit(3e38f);
    Vec3<F> nearest = ladder.predicted;
    eachCandidate(ladder, [&](const Vec3<F>& point, const Ground<F>& g, const F& distance) {
      const F off = larger(larger(least - distance, distance - most), 0) +
                    select(facing(g) < F(q_.slopeLeast), F(q_.legLength), F(0));
      const auto nearer = off < misfit;
      misfit = select(nearer, off, misfit);
      nearest = select(nearer, point, nearest);
    });
    return nearest;
  }

  // The shortest lift vector that clears the ground at all places of its lane.
  Vec3<F> route(const Vec3<F>& p0, const Vec3<F>& p1, const Vec3<F>& m0, const F& least) const {
    const Vec3<F>& up = r_.y;
    const Vec3<F> aside = normalized(cross(up, p1 - p0)) * q_.routeWidth;
    constexpr float kSides[] = {0, -1, 1, -2, 2};
    Vec3<F> lift{F(0), F(0), F(0)};
    F shortest(3e38f);
    for (const float lane : kSides) {
      // No bow is shorter than the least lift, so most steps look along the straight lane alone.
      const auto open = least * least * 1.0001f < shortest;
      if (!any(open)) break;
      const Vec3<F> side = aside * lane;
      F height = least;
      for (int i = 0; i < 7; ++i) height = larger(height, heightAt(i, p0, p1, m0, side));
      const F over = larger(F(0), height - q_.stepHeightMax);
      const Vec3<F> bow = up * (height - over) + side;
      const F cost = dot(bow, bow) + over * over * 100.0f;
      const auto cheaper = open & (cost < shortest);
      shortest = select(cheaper, cost, shortest);
      lift = select(cheaper, bow, lift);
    }
    return lift;
  }

  // The lift that clears the ground at place i of 7, u' = 1/8 .. 7/8.
  F heightAt(int i, const Vec3<F>& p0, const Vec3<F>& p1, const Vec3<F>& m0, const Vec3<F>& side) const {
    const bool early = i < 3;
    const float s = 0.25f * float(i < 4 ? i + 1 : 7 - i);
    const float h01 = s * s * (3 - 2 * s), h10 = s * (s - 1) * (s - 1), h11 = s * s * (s - 1);
    const float along = 0.5f * (h01 + h11), clearing = h01 + h10;
    Vec3<F> p = mix(p0, p1, F(early ? along : 1 - along));
    F share(clearing);
    if (early) {
      share = select(reaim_, F(h01), share);
      p = p + m0 * h10;  // nothing but for a step aimed anew
    }
    p = p + side * share;
    const F gap = groundAt(world_.terrain, x_ + p.x, z_ + p.z).height - (a_.y + p.y);
    return (gap * r_.y.y + q_.stepClearance * clearing) * reciprocal(share);
  }

  const World& world_;
  const shared::Parameters& q_;
  const Beginning<F>& b_;
  const Agent<F>& a_;
  Mask<F> reaim_;
  Mat3<F> r_;
  F x_, z_, oldTicks_, flown_, ticks_;
};

template <class F>
[[gnu::flatten]] void foothold(const World& world, float tick, Beginning<F>& b) {
  b.step = Foothold<F>(world, tick, b).step(tick);
}

}  // namespace skitter::cpu_crowd
