#include "evolve/adaptation.h"

#include <algorithm>
#include <cmath>

#include "crowd/gait_map.h"

namespace skitter::evolve {

void BehaviourMap::add(std::span<const float> shares, float expected) {
  shares_.insert(shares_.end(), shares.begin(), shares.end());
  expected_.push_back(expected);
}

double BehaviourMap::distance(uint32_t a, uint32_t b) const {
  double sum = 0;
  for (size_t leg = 0; leg < legs_; ++leg) {
    const double apart = double{shares_[a * legs_ + leg]} - double{shares_[b * legs_ + leg]};
    sum += apart * apart;
  }
  return std::sqrt(sum);
}

Adaptation::Adaptation(const BehaviourMap& map, const AdaptationOptions& options)
    : map_(&map), options_(options), variance_(map.count(), options.deviation * options.deviation) {
  for (uint32_t behaviour = 0; behaviour < map.count(); ++behaviour)
    mean_.push_back(double{map.expected(behaviour)});
}

double Adaptation::kernel(uint32_t a, uint32_t b) const {
  return options_.deviation * options_.deviation *
         crowd::matern52(map_->distance(a, b), options_.lengthScale);
}

std::optional<uint32_t> Adaptation::next() const {
  if (mean_.empty() || trials() >= options_.mostTrials) return {};
  if (best_ && bestFitness_ >= options_.goodEnough * double{map_->best()}) return {};
  const auto bound = [&](uint32_t behaviour) {
    return mean_[behaviour] + options_.exploration * std::sqrt(std::max(0.0, variance_[behaviour]));
  };
  std::optional<uint32_t> highest;
  for (uint32_t behaviour = 0; behaviour < map_->count(); ++behaviour) {
    // A trial tells nothing new of what was tried.
    if (std::ranges::find(tried_, behaviour) != tried_.end()) continue;
    if (!highest || bound(behaviour) > bound(*highest)) highest = behaviour;
  }
  if (best_ && highest && bestFitness_ >= bound(*highest)) return {};
  return highest;
}

// One more row of the Cholesky factor. A row has, for each behaviour x, what is new in k(x, behaviour) beside
// the rows before; mean and variance change by it alone.
void Adaptation::tell(uint32_t behaviour, double fitness) {
  std::vector<double> row(map_->count());
  const double pivot = std::sqrt(std::max(variance_[behaviour], 0.0) + options_.noise);
  for (uint32_t x = 0; x < map_->count(); ++x) {
    double left = kernel(behaviour, x);
    for (const std::vector<double>& before : rows_) left -= before[behaviour] * before[x];
    row[x] = left / pivot;
  }
  const double surprise = (fitness - mean_[behaviour]) / pivot;
  for (uint32_t x = 0; x < map_->count(); ++x) {
    mean_[x] += row[x] * surprise;
    variance_[x] -= row[x] * row[x];
  }
  rows_.push_back(std::move(row));
  tried_.push_back(behaviour);
  if (!best_ || fitness > bestFitness_) best_ = behaviour, bestFitness_ = fitness;
}

std::optional<uint32_t> Adaptation::best() const { return best_; }

}  // namespace skitter::evolve
