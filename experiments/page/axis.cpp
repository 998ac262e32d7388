#include "experiments/page/axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace skitter::experiments {
namespace {

constexpr int wantedTicks = 6;  // of a linear axis, about
constexpr int mostDecades = 7;  // that are all labelled
constexpr int fewDecades = 2;   // where 2 and 5 are labelled too

// The 1, 2 or 5 times a power of ten nearest above the span's even division.
double niceStep(double span) {
  const double raw = span / wantedTicks;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= raw * (1 - 1e-9)) return factor * power;
  return 10 * power;
}

std::string label(double value) { return fmt::format("{:g}", value); }

std::vector<Tick> linearTicks(double least, double most, double step) {
  std::vector<Tick> ticks;
  const auto first = static_cast<long>(std::ceil(least / step - 1e-6));
  const auto last = static_cast<long>(std::floor(most / step + 1e-6));
  // Multiplied, not added up: a sum would drift off the round numbers.
  for (long i = first; i <= last; ++i) {
    const double value = static_cast<double>(i) * step;
    ticks.push_back({value, label(value)});
  }
  return ticks;
}

std::vector<Tick> logTicks(double least, double most) {
  std::vector<Tick> ticks;
  const int first = static_cast<int>(std::floor(std::log10(least) + 1e-9));
  const int last = static_cast<int>(std::ceil(std::log10(most) - 1e-9));
  const int every = (last - first + mostDecades - 1) / mostDecades;
  for (int decade = first; decade <= last; ++decade) {
    for (int factor = 1; factor < 10; ++factor) {
      const double value = factor * std::pow(10.0, decade);
      if (value < least * (1 - 1e-9) || value > most * (1 + 1e-9)) continue;
      const bool labelled = factor == 1 ? (decade - first) % std::max(1, every) == 0
                                        : last - first <= fewDecades && (factor == 2 || factor == 5);
      if (every > 1 && !labelled) continue;
      ticks.push_back({value, labelled ? label(value) : ""});
    }
  }
  return ticks;
}

// The 1, 2 or 5 times a power of ten at or beyond a value.
double roundedLog(double value, bool up) {
  const double power = std::pow(10.0, std::floor(std::log10(value) + 1e-9));
  const double share = value / power;
  if (up) {
    for (const double factor : {1.0, 2.0, 5.0})
      if (share <= factor * (1 + 1e-9)) return factor * power;
    return 10 * power;
  }
  for (const double factor : {5.0, 2.0})
    if (share >= factor * (1 - 1e-9)) return factor * power;
  return power;
}

}  // namespace

Axis::Axis(const AxisInfo& info, const std::vector<double>& values) : log_(info.log) {
  bool any = false;
  for (const double value : values) {
    if (!holds(value)) continue;
    least_ = any ? std::min(least_, value) : value;
    most_ = any ? std::max(most_, value) : value;
    any = true;
  }
  if (!any) least_ = log_ ? 1 : 0, most_ = log_ ? 10 : 1;
  if (info.least) least_ = *info.least;
  if (info.most) most_ = *info.most;
  if (log_) {
    if (!info.least) least_ = roundedLog(least_, false);
    if (!info.most) most_ = roundedLog(most_, true);
    if (!(most_ > least_)) most_ = 10 * least_;
    ticks_ = logTicks(least_, most_);
    return;
  }
  // All alike: a range about the value, so that there is something to see.
  if (!(most_ > least_)) {
    const double about = most_;
    most_ = about + std::max(1e-3, std::fabs(about) / 2);
    if (!info.least) least_ = about - std::max(1e-3, std::fabs(about) / 2);
  }
  const double step = niceStep(most_ - least_);
  if (!info.least) least_ = std::floor(least_ / step + 1e-6) * step;
  if (!info.most) most_ = std::ceil(most_ / step - 1e-6) * step;
  ticks_ = linearTicks(least_, most_, step);
}

bool Axis::holds(double value) const { return std::isfinite(value) && (!log_ || value > 0); }

double Axis::place(double value) const {
  if (!log_) return (value - least_) / (most_ - least_);
  return std::log(value / least_) / std::log(most_ / least_);
}

}  // namespace skitter::experiments
