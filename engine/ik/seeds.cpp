#include "ik/seeds.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/split_mix.h"
#include "ik/limits.h"

namespace skitter::ik {
namespace {

using glm::dvec3;

constexpr uint32_t candidateCount = 1024;
constexpr double pulled = 0.7;  // of the way out from rest is left

double within(base::SplitMix64& random, double low, double high) {
  return low + (high - low) * random.uniform();
}

dvec3 randomDirection(const Limit& limit, base::SplitMix64& random) {
  if (const auto* hinge = std::get_if<Hinge>(&limit)) {
    const double middle = std::clamp<double>(0, hinge->min, hinge->max);
    const double q = middle + pulled * (within(random, hinge->min, hinge->max) - middle);
    return {0, -std::sin(q), std::cos(q)};
  }
  const double phi = within(random, 0, 2 * std::numbers::pi);
  const double most = greatestAngle(limit, phi);
  // Uniform on the cap.
  const double theta = std::acos(within(random, std::cos(most), 1));
  return leaning(std::holds_alternative<Free>(limit) ? theta : pulled * theta, phi);
}

double fold(const std::vector<dvec3>& places, const dvec3& pole) {
  const dvec3 tip = places.back(), line = tip / std::max(glm::length(tip), 1e-12);
  dvec3 sum(0);
  for (const dvec3& p : places) sum += p - line * glm::dot(p, line);
  return glm::dot(sum, pole);
}

}  // namespace

// To which side a seed folds changes as it is turned.
bool aimsSeeds(const Skeleton& skeleton, const std::optional<glm::vec3>& pole) {
  const Skeleton::Joint& base = skeleton.joints()[0];
  return !pole && base.length > 0 && std::holds_alternative<Free>(base.limit);
}

std::vector<Skeleton::Pose> seedPoses(const Skeleton& skeleton, const std::optional<glm::vec3>& pole,
                                      uint32_t most) {
  base::SplitMix64 random(1);
  const bool aimed = aimsSeeds(skeleton, pole);
  std::vector<Skeleton::Pose> candidates;
  std::vector<dvec3> tips;
  for (uint32_t c = 0; c < candidateCount; ++c) {
    Skeleton::Pose pose;
    for (const Skeleton::Joint& joint : skeleton.joints()) {
      pose.directions.push_back(joint.length > 0 ? randomDirection(joint.limit, random) : dvec3(0, 0, 1));
      pose.twists.push_back(pulled * within(random, joint.twistMin, joint.twistMax));
    }
    if (aimed) pose.directions[0] = {0, 0, 1};
    const std::vector<dvec3> places = skeleton.place(pose);
    if (pole && fold(places, dvec3(*pole)) < 0) continue;
    candidates.push_back(pose);
    tips.push_back(aimed ? dvec3(glm::length(places.back()), 0, 0) : places.back());
  }
  std::vector<Skeleton::Pose> seeds;
  std::vector<double> distance(candidates.size(), std::numeric_limits<double>::max());
  for (size_t next = 0; seeds.size() < std::min<size_t>(most, candidates.size());) {
    seeds.push_back(candidates[next]);
    for (size_t c = 0; c < candidates.size(); ++c)
      distance[c] = std::min(distance[c], glm::length(tips[c] - tips[next]));
    next = static_cast<size_t>(std::max_element(distance.begin(), distance.end()) - distance.begin());
  }
  return seeds;
}

}  // namespace skitter::ik
