#include "app/viewer/pace.h"

#include <algorithm>
#include <cmath>

namespace skitter::app {

void Pace::step() {
  paused_ = true;
  ++steps_;
}

void Pace::faster() { doublings_ = std::min(doublings_ + 1, most_); }
void Pace::slower() { doublings_ = std::max(doublings_ - 1, -most_); }

void Pace::forget() {
  steps_ = 0;
  owed_ = 0;
}

double Pace::speed() const { return std::ldexp(1.0, doublings_); }

uint64_t Pace::ticks() {
  const uint64_t steps = steps_;
  steps_ = 0;
  if (paused_) return steps;
  owed_ += ticksPerFrame_ * speed();
  const double whole = std::floor(owed_);
  owed_ -= whole;
  return steps + static_cast<uint64_t>(whole);
}

}  // namespace skitter::app
