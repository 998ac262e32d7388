#include "bench/cpu_baseline/workload.h"

#include <algorithm>

namespace skitter::baseline {
namespace {

using DVec = Vec3<double>;

constexpr double kNearest = 0.2, kFarthest = 0.95, kStep = 0.02;

bool isLimited(const Chain& chain) {
  return std::any_of(chain.bones.begin(), chain.bones.end(),
                     [](const Bone& bone) { return bone.limit.kind != LimitKind::free; });
}

double norm(const DVec& v) { return std::sqrt(dot(v, v)); }

DVec randomDirection(std::mt19937& random) {
  std::normal_distribution<double> normal;
  const DVec v{normal(random), normal(random), normal(random)};
  return v * (1 / norm(v));
}

void put(Rows& targets, size_t chain, const DVec& target) {
  targets.at(0, chain) = float(target.x);
  targets.at(1, chain) = float(target.y);
  targets.at(2, chain) = float(target.z);
}

DVec tipOf(const Chain& chain, const Pose& pose) { return jointsOf(chain, pose).back(); }

// Between two legal poses, legal itself: cones, ellipses and ranges are convex in these coordinates or nearly
// so; what an ellipse of very unlike axes loses is a target out of reach now and then.
Pose between(const Pose& from, const Pose& to, float share, int bones) {
  Pose pose;
  for (int i = 0; i < bones; ++i) {
    pose.x[i] = from.x[i] + share * (to.x[i] - from.x[i]);
    pose.y[i] = from.y[i] + share * (to.y[i] - from.y[i]);
    pose.twist[i] = from.twist[i] + share * (to.twist[i] - from.twist[i]);
  }
  return pose;
}

// A pose that drifts from goal to goal, its tip `kStep` a tick.
class Drift {
 public:
  Drift(const Chain& chain, std::mt19937& random)
      : chain_(chain), random_(random), pose_(randomPose(chain, random)), goal_(randomPose(chain, random)) {}

  DVec tip() const { return tipOf(chain_, pose_); }
  void advance() {
    const DVec old = tip();
    const int bones = int(chain_.bones.size());
    for (int attempt = 0; attempt < 100; ++attempt) {
      if (norm(tipOf(chain_, goal_) - old) > kStep) break;
      goal_ = randomPose(chain_, random_);
    }
    // Small shares move the tip about evenly, so a few corrections find the one that moves it by a step.
    float share = 0.02f;
    for (int correction = 0; correction < 5; ++correction) {
      const double moved = norm(tipOf(chain_, between(pose_, goal_, share, bones)) - old);
      share = std::clamp(share * float(kStep / std::max(moved, 1e-9)), 1e-4f, 1.0f);
    }
    pose_ = between(pose_, goal_, share, bones);
  }

 private:
  const Chain& chain_;
  std::mt19937& random_;
  Pose pose_, goal_;
};

DVec wander(const DVec& target, std::mt19937& random) {
  for (;;) {
    const DVec next = target + randomDirection(random) * kStep;
    if (norm(next) >= kNearest && norm(next) <= kFarthest) return next;
  }
}

DVec freeTarget(std::mt19937& random) {
  return randomDirection(random) * std::uniform_real_distribution<double>(kNearest, kFarthest)(random);
}

}  // namespace

Rows coldTargets(const Chain& chain, size_t chains, uint32_t seed) {
  std::mt19937 random(seed);
  Rows targets(3, chains);
  const bool limited = isLimited(chain);
  for (size_t i = 0; i < chains; ++i) {
    put(targets, i, limited ? tipOf(chain, randomPose(chain, random)) : freeTarget(random));
  }
  return targets;
}

std::vector<Rows> trackedTargets(const Chain& chain, size_t chains, int ticks, uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<Rows> targets(ticks, Rows(3, chains));
  const bool limited = isLimited(chain);
  for (size_t i = 0; i < chains; ++i) {
    if (limited) {
      Drift drift(chain, random);
      for (Rows& tick : targets) {
        put(tick, i, drift.tip());
        drift.advance();
      }
      continue;
    }
    DVec target = freeTarget(random);
    for (Rows& tick : targets) {
      put(tick, i, target);
      target = wander(target, random);
    }
  }
  return targets;
}

}  // namespace skitter::baseline
