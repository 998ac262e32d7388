#include "spline/tangents.h"

#include <algorithm>
#include <cmath>

namespace skitter {
namespace {

using glm::dvec3;

struct Side {
  dvec3 slope;
  double time;
};

dvec3 parabola(const Side& before, const Side& after) {
  return (after.time * before.slope + before.time * after.slope) / (before.time + after.time);
}

dvec3 chord(const Side& before, const Side& after) {
  return (before.time * before.slope + after.time * after.slope) / (before.time + after.time);
}

dvec3 monotoneMean(const dvec3& before, const dvec3& after) {
  dvec3 mean(0);
  for (int axis = 0; axis < 3; ++axis)
    if ((before[axis] > 0 && after[axis] > 0) || (before[axis] < 0 && after[axis] < 0))
      mean[axis] = 0.5 * (before[axis] + after[axis]);
  return mean;
}

class Rules {
 public:
  Rules(const SplineChain& chain, const std::vector<dvec3>& points, const std::vector<double>& knots)
      : closed_(chain.closed), rule_(chain.tangents) {
    for (size_t i = 0; i + 1 < points.size(); ++i) {
      const double time = knots[i + 1] - knots[i];
      sides_.push_back({(points[i + 1] - points[i]) / time, time});
    }
  }

  TangentPair at(int k) const {
    const Side &before = side(k - 1), &after = side(k);
    switch (rule_.rule) {
      case SplineRule::catmullRom:
        return both(catmullRom(k));
      case SplineRule::finiteDifference:
        return both(0.5 * (before.slope + after.slope));
      case SplineRule::cardinal:
        return both((1.0 - rule_.tension) * chord(before, after));
      case SplineRule::kochanekBartels:
        return {tcb(before, after, -rule_.continuity), tcb(before, after, rule_.continuity)};
      case SplineRule::monotone:
        return both(monotone(k));
      case SplineRule::given:
      case SplineRule::zero:
        break;
    }
    return both(dvec3(0));
  }

 private:
  static TangentPair both(const dvec3& m) { return {m, m}; }
  int segments() const { return static_cast<int>(sides_.size()); }
  const Side& side(int i) const {
    const int n = segments();
    return sides_[static_cast<size_t>(closed_ ? (i + n) % n : std::clamp(i, 0, n - 1))];
  }

  dvec3 catmullRom(int k) const {
    if (closed_ || segments() == 1 || (k > 0 && k < segments())) return parabola(side(k - 1), side(k));
    return 2.0 * side(k).slope - catmullRom(k == 0 ? 1 : segments() - 1);
  }

  dvec3 tcb(const Side& before, const Side& after, double c) const {
    const double loose = 0.5 * (1.0 - rule_.tension), bias = rule_.bias;
    return loose * ((1 + c) * (1 + bias) * before.slope + (1 - c) * (1 - bias) * after.slope);
  }

  dvec3 mean(int k) const { return monotoneMean(side(k - 1).slope, side(k).slope); }
  // What segment i asks of the tangents at its ends: the circle of radius 3.
  dvec3 scale(int i) const {
    dvec3 result(1);
    if (!closed_ && (i < 0 || i >= segments())) return result;
    const dvec3 &d = side(i).slope, at = mean(i), end = mean(i + 1);
    for (int axis = 0; axis < 3; ++axis)
      if (d[axis] != 0) result[axis] = std::min(1.0, 3 / std::hypot(at[axis] / d[axis], end[axis] / d[axis]));
    return result;
  }
  dvec3 monotone(int k) const { return mean(k) * glm::min(scale(k - 1), scale(k)); }

  bool closed_;
  SplineTangents rule_;
  std::vector<Side> sides_;
};

}  // namespace

std::vector<TangentPair> tangentsOf(const SplineChain& chain, const std::vector<dvec3>& points,
                                    const std::vector<double>& knots) {
  std::vector<TangentPair> result;
  const Rules rules(chain, points, knots);
  for (size_t k = 0; k < points.size(); ++k) {
    if (chain.tangents.rule != SplineRule::given) {
      result.push_back(rules.at(static_cast<int>(k)));
      continue;
    }
    const size_t of = k % chain.points.size();
    result.push_back({chain.arriving[of], chain.leaving.empty() ? chain.arriving[of] : chain.leaving[of]});
  }
  return result;
}

}  // namespace skitter
