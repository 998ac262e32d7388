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
  F reach, again;  // 1: aimed anew
};

// The best candidate so far and, if none fits, the one nearest to where legs reach.
template <class F>
struct Choice {
  Vec3<F> point, nearest;
  F score = F(3e38f), misfit = F(3e38f);
};

template <class F>
class Foothold {
 public:
  Foothold(const World& world, float tick, const Beginning<F>& b)
      : world_(world),
        q_(world.q),
        b_(b),
        a_(b.agent),
        again_(F(0.5f) < b.again),
        r_(matrixOf(a_.orientation)) {
    x_ = a_.tileX * shared::TILE_SIZE + a_.local.x;
    z_ = a_.tileZ * shared::TILE_SIZE + a_.local.z;
    oldTicks_ = absolute(b.step.ticks);
    flown_ = F(tick - 1) - b.step.firstTick;
    ticks_ = select(again_, larger(oldTicks_ - flown_, 2), a_.stepTicks);
  }

  Step<F> step(float tick) const {
    Step<F> next;
    const Choice<F> choice = collect();
    const Vec3<F> rootThen = r_ * predictRoot();
    const auto none = F(3e38f) <= choice.score;
    Vec3<F> p1 = choice.point;
    if (any(none)) p1 = select(none, ontoRange(choice.nearest, rootThen), p1);

    const Flight<F> flight(b_.step, a_);
    const F inverse = reciprocal(oldTicks_), u = clamp(flown_ * inverse, 0, 1), way = flight.easedTime(u);
    Vec3<F> p0 = flight.p1, m0{F(0), F(0), F(0)};
    if (any(again_)) {
      p0 = select(again_, flight.point(way), p0);
      m0 = select(again_, flight.tangent(way) * (flight.easedRate(u) * ticks_ * inverse), m0);
    }
    const F least = select(again_, F(1) - u, F(1)) * q_.stepHeight;
    const Vec3<F> lift = route(p0, p1, m0, least);
    next.landing = p1 + a_.local;
    next.liftOff = p0 + a_.local;
    next.lift = lift;
    next.startTangent = select(again_, m0, lift);
    next.tileX = a_.tileX;
    next.tileZ = a_.tileZ;
    next.firstTick = F(tick - 1);
    next.ticks = select(none, -ticks_, ticks_);
    return next;
  }

 private:
  // In model space.
  Vec3<F> predictRoot() const {
    const F time = ticks_ * q_.dt;
    Vec3<F> root = Turn<F>(a_.turnRate * time)(b_.root);
    root.z = root.z + a_.surfaceSpeed * time;
    return root;
  }

  // The ladder of rungs from the root toward the predicted landing.
  Choice<F> collect() const {
    const F stance = a_.cycle - a_.stepTicks * q_.dt;
    const Vec3<F> tau = predictLanding(b_.home, a_, ticks_ * q_.dt, stance), rootThen = predictRoot();
    F ox = tau.x - rootThen.x, oz = tau.z - rootThen.z;
    const F span = squareRoot(ox * ox + oz * oz);
    const auto above = span < F(1e-6f);
    ox = select(above, b_.home.x - b_.root.x, ox);
    oz = select(above, b_.home.z - b_.root.z, oz);
    const F inverse = rsqrt(larger(ox * ox + oz * oz, 1e-20f)), rho = larger(span, b_.reach * 0.1f);
    ox = ox * inverse;
    oz = oz * inverse;
    // What turns a rung and a place on it into a way along world axes.
    const Vec3<F> along = (r_.x * ox + r_.z * oz) * (rho * (1 / 3.0f)),
                  across = (r_.z * ox - r_.x * oz) * (rho * (1 / 6.0f));
    const Vec3<F> predicted = r_ * tau, root = r_ * rootThen;
    Choice<F> choice;
    choice.point = choice.nearest = predicted;
    for (int k = 1; k <= 4; ++k) {
      for (int j = -k; j <= k; ++j)
        consider(predicted + along * float(k - 3) + across * float(j), predicted, root, choice);
    }
    return choice;
  }

  void consider(Vec3<F> point, const Vec3<F>& predicted, const Vec3<F>& root, Choice<F>& choice) const {
    const Ground<F> g = groundAt(world_.terrain, x_ + point.x, z_ + point.z);
    point.y = g.height - a_.local.y;
    const F distance = length(point - root);
    const F least = b_.reach * q_.reachLeast, most = b_.reach * q_.reachMost;
    const Vec3<F>& up = r_.y;
    const F aligned =
        (up.y - g.slopeX * up.x - g.slopeZ * up.z) * rsqrt(g.slopeX * g.slopeX + g.slopeZ * g.slopeZ + 1.0f);
    const auto fits = (least <= distance) & (distance <= most) & (F(q_.slopeLeast) <= aligned);
    const Vec3<F> miss = point - predicted;
    F score = dot(miss, miss) * (1 / (q_.legLength * q_.legLength));
    if (q_.nearestOnly == 0) {
      const F strain = larger(F(0), distance * reciprocal(b_.reach) - q_.reachComfort);
      score = score + (F(1) - aligned) * q_.slopeWeight + strain * strain * q_.reachWeight;
    }
    const auto better = fits & (score < choice.score);
    choice.score = select(better, score, choice.score);
    choice.point = select(better, point, choice.point);
    const F misfit = larger(larger(least - distance, distance - most), 0);
    const auto nearer = misfit < choice.misfit;
    choice.misfit = select(nearer, misfit, choice.misfit);
    choice.nearest = select(nearer, point, choice.nearest);
  }

  // A last resort: moved along its line from the root.
  Vec3<F> ontoRange(const Vec3<F>& point, const Vec3<F>& root) const {
    const Vec3<F> d = point - root;
    const F far = length(d), range = larger(smaller(far, b_.reach * q_.reachMost), b_.reach * q_.reachLeast);
    return root + d * (range * reciprocal(larger(far, 1e-6f)));
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
      share = select(again_, F(h01), share);
      p = p + m0 * h10;  // nothing but for a step aimed anew
    }
    p = p + side * share;
    const F gap = groundAt(world_.terrain, x_ + p.x, z_ + p.z).height - (a_.local.y + p.y);
    return (gap * r_.y.y + q_.stepClearance * clearing) * reciprocal(share);
  }

  const World& world_;
  const shared::Parameters& q_;
  const Beginning<F>& b_;
  const Agent<F>& a_;
  Mask<F> again_;
  Mat3<F> r_;
  F x_, z_, oldTicks_, flown_, ticks_;
};

template <class F>
[[gnu::flatten]] void foothold(const World& world, float tick, Beginning<F>& b) {
  b.step = Foothold<F>(world, tick, b).step(tick);
}

}  // namespace skitter::cpu_crowd
