#include "app/run/damage.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "crowd/support.h"

namespace skitter::app {
namespace {

template <class Value>
nlohmann::ordered_json numberOrNull(const std::optional<Value>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

bool isUnstable(const HurtAgent& agent) {
  std::vector<glm::dvec2> feet;
  for (const HurtAgent::Leg& leg : agent.legs)
    if (leg.isPlanted) feet.push_back(leg.tip);
  return crowd::SupportPolygon(std::move(feet)).marginOf(agent.centre) < 0;
}

}  // namespace

std::optional<bool> DamageFigures::counts() const {
  if (!speedKept) return {};
  return slip.value_or(0) <= mostSlip && reachErrorP99.value_or(0) <= mostReachError;
}

nlohmann::ordered_json jsonOf(const DamageFigures& figures) {
  return {{"agents", figures.agents},
          {"speedKept", numberOrNull(figures.speedKept)},
          {"counts", numberOrNull(figures.counts())},
          {"unstable", numberOrNull(figures.unstable)},
          {"slip", numberOrNull(figures.slip)},
          {"reachErrorP99", numberOrNull(figures.reachErrorP99)}};
}

void DamageTally::add(uint64_t agent, uint64_t tick, const HurtAgent& now) {
  Seen& seen = agents_[agent];
  if (seen.feet.empty() || seen.tick + 1 != tick) {
    seen.feet.clear();
    for (const HurtAgent::Leg& leg : now.legs) seen.feet.push_back({leg.tip, leg.isPlanted});
  } else {
    for (size_t l = 0; l < now.legs.size(); ++l) follow(now.legs[l], now.legLength, seen.feet[l], seen);
  }
  seen.tick = tick;
  for (const HurtAgent::Leg& leg : now.legs)
    if (leg.carries) addError(leg.error / now.legLength);
  ++agentTicks_;
  unstable_ += isUnstable(now);
}

void DamageTally::follow(const HurtAgent::Leg& leg, double legLength, Foot& foot, Seen& seen) const {
  if (leg.isPlanted && !foot.isPlanted) {
    foot.slip = 0;
  } else if (leg.isPlanted && foot.slip) {
    *foot.slip += glm::distance(leg.tip, foot.tip) / legLength;
  } else if (foot.isPlanted && foot.slip) {
    seen.slip += *foot.slip;
    ++seen.stances;
    foot.slip.reset();
  }
  foot.tip = leg.tip;
  foot.isPlanted = leg.isPlanted;
}

void DamageTally::addSpeed(double hurt, double whole) {
  hurtSpeeds_ += hurt;
  wholeSpeeds_ += whole;
}

void DamageTally::addError(double error) {
  const double bucket = std::floor(octave * (std::log2(std::max(error, 1e-30)) - leastExponent));
  ++errors_[static_cast<size_t>(std::clamp(bucket, 0.0, static_cast<double>(errors_.size() - 1)))];
  errorMost_ = std::max(errorMost_, error);
}

std::optional<double> DamageTally::errorP99() const {
  const uint64_t all = std::accumulate(errors_.begin(), errors_.end(), uint64_t{0});
  if (all == 0) return {};
  uint64_t seen = 0;
  for (size_t i = 0; i < errors_.size(); ++i) {
    seen += errors_[i];
    if (100 * seen >= 99 * all)
      return std::min(errorMost_, std::exp2(static_cast<double>(i + 1) / octave + leastExponent));
  }
  return errorMost_;
}

DamageFigures DamageTally::figures() const {
  DamageFigures figures{.agents = agents_.size(), .reachErrorP99 = errorP99()};
  if (wholeSpeeds_ > 0) figures.speedKept = hurtSpeeds_ / wholeSpeeds_;
  if (agentTicks_ > 0) figures.unstable = static_cast<double>(unstable_) / static_cast<double>(agentTicks_);
  for (const auto& [number, seen] : agents_)
    if (seen.stances > 0)
      figures.slip = std::max(figures.slip.value_or(0), seen.slip / static_cast<double>(seen.stances));
  return figures;
}

}  // namespace skitter::app
