#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace skitter::evolve {

// What a creature knows of gaits before it tries any: of each how long every leg stands, and the fitness that
// it is expected to have (docs/evolve.md#trial-and-error). Shared by all who search in it.
class BehaviourMap {
 public:
  explicit BehaviourMap(size_t legs) : legs_(legs) {}

  // `shares` of time, one a leg, 0 to 1.
  void add(std::span<const float> shares, float expected);
  uint32_t count() const { return static_cast<uint32_t>(expected_.size()); }
  float expected(uint32_t behaviour) const { return expected_[behaviour]; }
  // The highest that is expected of any; there is one.
  float best() const { return *std::ranges::max_element(expected_); }
  // Of two behaviours, in shares of time: a Euclidean one.
  double distance(uint32_t a, uint32_t b) const;

 private:
  size_t legs_;
  std::vector<float> shares_, expected_;
};

struct AdaptationOptions {
  // The kernel's length, in shares of time. A leg that is held up is about 0.6 away: with 0.8, a bad trial
  // tells of gaits that differ in one such leg, too, and the few trials reach the others sooner.
  double lengthScale = 0.8;
  double noise = 0.001;     // variance of a measured fitness
  double deviation = 0.3;   // of what is expected, before any trial
  double exploration = 2;   // how many deviations a behaviour may be better than expected
  double goodEnough = 0.9;  // share of the best in the map, at which the search ends
  uint32_t mostTrials = 20;
};

// Trial and error of one creature whose body is not as it was: a Gaussian process over what the map expects,
// with a Matern 5/2 kernel, and the behaviour with the highest upper confidence bound is tried next (M-BOA,
// Cully et al. 2015).
class Adaptation {
 public:
  // The map outlives it.
  Adaptation(const BehaviourMap& map, const AdaptationOptions& options);

  // The next behaviour to try. There is none once enough were tried, once the best of them is good enough, or
  // once no other one could be better.
  std::optional<uint32_t> next() const;
  // A trial's result.
  void tell(uint32_t behaviour, double fitness);

  uint32_t trials() const { return static_cast<uint32_t>(tried_.size()); }
  // The best that was tried, of equal ones the first; none before the first trial.
  std::optional<uint32_t> best() const;
  double bestFitness() const { return bestFitness_; }
  // As the creature thinks by now.
  double expected(uint32_t behaviour) const { return mean_[behaviour]; }
  double variance(uint32_t behaviour) const { return variance_[behaviour]; }

 private:
  double kernel(uint32_t a, uint32_t b) const;

  const BehaviourMap* map_;
  AdaptationOptions options_;
  std::vector<double> mean_, variance_;  // of each behaviour
  // A row of L^-1 k(X, x) per trial, where L L^T is the kernel of the trials X and their noise.
  std::vector<std::vector<double>> rows_;
  std::vector<uint32_t> tried_;
  std::optional<uint32_t> best_;
  double bestFitness_ = 0;
};

}  // namespace skitter::evolve
