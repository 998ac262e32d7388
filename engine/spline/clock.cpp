#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "skitter/error.h"
#include "skitter/spline.h"

namespace skitter {

void SplineClock::activate(double at) {
  start = at;
  active = true;
}

void SplineClock::reset() { active = false; }

void SplineClock::rescale(double wanted, double now) {
  if (!(wanted >= 1e-30 && wanted <= 1e30))
    throw inputError(fmt::format("a spline's duration is {}, expected more than 0", wanted));
  if (active && now > start) start = now - (now - start) / duration * wanted;
  duration = wanted;
}

SplineState SplineClock::state(double now, bool closed) const {
  if (!active || !(now >= start)) return SplineState::idle;
  return closed || now - start < duration ? SplineState::moving : SplineState::finished;
}

double SplineClock::progress(double now, bool closed) const {
  if (state(now, closed) == SplineState::idle) return 0;
  const double phase = (now - start) / duration;
  return closed ? phase - std::floor(phase) : std::min(phase, 1.0);
}

double SplineClock::rounds(double now, bool closed) const {
  return closed && state(now, closed) == SplineState::moving ? std::floor((now - start) / duration) : 0;
}

}  // namespace skitter
