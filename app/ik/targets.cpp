#include "app/ik/targets.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>
#include <vector>

#include "assets/files/file.h"
#include "base/split_mix.h"
#include "skitter/error.h"

namespace skitter::app {
namespace {

static_assert(std::endian::native == std::endian::little);
static_assert(sizeof(glm::vec3) == 12);

constexpr double nearest = 0.2, farthest = 0.95, pace = 0.02;  // shares of the reach

// A stream a chain: what a chain is given does not depend on the others.
class Random {
 public:
  Random(uint64_t seed, uint64_t stream)
      : draw_(base::SplitMix64::mixed(seed) ^ base::SplitMix64::mixed(stream * 2 + 1)) {}

  double uniform(double low, double high) { return low + (high - low) * draw_.uniform(); }

  glm::dvec3 point() {
    const double z = uniform(-1, 1), around = uniform(0, 2 * 3.14159265358979323846);
    const double across = std::sqrt(1 - z * z), distance = uniform(nearest, farthest);
    return distance * glm::dvec3(across * std::cos(around), across * std::sin(around), z);
  }

 private:
  base::SplitMix64 draw_;
};

double distanceFromBase(const glm::dvec3& from, const glm::dvec3& to) {
  const glm::dvec3 way = to - from;
  const double share = std::clamp(-glm::dot(from, way) / std::max(glm::dot(way, way), 1e-20), 0.0, 1.0);
  return glm::length(from + share * way);
}

// A target on its way from point to point.
class Walker {
 public:
  Walker(uint64_t seed, uint64_t chain) : random_(seed, chain), at_(random_.point()), goal_(at_) {}

  glm::dvec3 at() const { return at_; }
  void step() {
    double left = pace;
    for (double way = glm::distance(at_, goal_); way <= left; way = glm::distance(at_, goal_)) {
      left -= way;
      at_ = goal_;
      // Ways that lead past the base are drawn again.
      do goal_ = random_.point();
      while (distanceFromBase(at_, goal_) < nearest);
    }
    at_ += left * glm::normalize(goal_ - at_);
  }

 private:
  Random random_;
  glm::dvec3 at_, goal_;
};

std::vector<glm::vec3> readPoints(const std::string& file) {
  FileStream stream(file);
  if (stream.size() % sizeof(glm::vec3) != 0) {
    throw inputError(fmt::format("{}: has {} bytes, expected a multiple of 12 (float32 x, y, z a target)",
                                 file, stream.size()));
  }
  std::vector<glm::vec3> points(stream.size() / sizeof(glm::vec3));
  stream.read(points.data(), stream.size());
  const auto isFinite = [](const glm::vec3& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
  };
  const auto broken = std::find_if_not(points.begin(), points.end(), isFinite);
  if (broken != points.end()) {
    throw inputError(fmt::format("{}: target {} (from 0) is ({}, {}, {}), expected finite numbers", file,
                                 broken - points.begin(), broken->x, broken->y, broken->z));
  }
  return points;
}

}  // namespace

IkTargets readIkTargets(const std::string& file, std::optional<uint32_t> chains, ik::Start start) {
  auto points = std::make_shared<const std::vector<glm::vec3>>(readPoints(file));
  const uint64_t count = points->size();
  if (!chains && start == ik::Start::rest && count > ik::Batch::maxChains) {
    throw inputError(fmt::format("{}: has {} targets, expected at most {} chains (--chains)", file, count,
                                 ik::Batch::maxChains));
  }
  IkTargets targets;
  targets.chains = chains.value_or(start == ik::Start::previous ? 1 : static_cast<uint32_t>(count));
  targets.rows = count / targets.chains;
  if (count % targets.chains != 0) {
    throw inputError(
        fmt::format("{}: has {} targets, expected rows of {} (--chains)", file, count, targets.chains));
  }
  targets.next = [points, at = size_t{0}](std::span<glm::vec3> to) mutable {
    std::copy_n(points->begin() + static_cast<std::ptrdiff_t>(at), to.size(), to.begin());
    at += to.size();
  };
  return targets;
}

IkTargets makeIkTargets(uint32_t chains, uint64_t rows, ik::Start start, float reach, uint64_t seed) {
  IkTargets targets{chains, rows, {}};
  if (start == ik::Start::rest) {
    targets.next = [=, at = uint64_t{0}](std::span<glm::vec3> to) mutable {
      for (glm::vec3& target : to) target = reach * glm::vec3(Random(seed, at++).point());
    };
    return targets;
  }
  auto walkers = std::make_shared<std::vector<Walker>>();
  targets.next = [=, at = size_t{0}](std::span<glm::vec3> to) mutable {
    // Millions take seconds, which belong to the work that can be interrupted.
    while (walkers->size() < chains) walkers->emplace_back(seed, walkers->size());
    for (glm::vec3& target : to) {
      Walker& walker = (*walkers)[at++ % walkers->size()];
      target = reach * glm::vec3(walker.at());
      walker.step();
    }
  };
  return targets;
}

}  // namespace skitter::app
