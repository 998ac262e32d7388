#include "validation/judge.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "cpu_reference/tolerances.h"

namespace skitter::validation {

void Sample::compare(const char* quantity, double error, double tolerance, const glm::dvec4& expected,
                     const glm::dvec4& got) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  if (!std::isfinite(error)) error = infinite;
  const double ratio = error == 0 ? 0 : (tolerance > 0 ? error / tolerance : infinite);
  if (ratio <= ratio_) return;
  quantity_ = quantity;
  error_ = error;
  tolerance_ = tolerance;
  ratio_ = ratio;
  expected_ = expected;
  got_ = got;
}

void Sample::same(const char* quantity, double expected, double got) {
  compare(quantity, std::abs(expected - got), 0, {expected, 0, 0, 0}, {got, 0, 0, 0});
}

void Sample::finite(const char* record, std::span<const float> values) {
  for (const float value : values) {
    if (!std::isfinite(value)) {
      compare(record, std::numeric_limits<double>::infinity(), 0, glm::dvec4(0), glm::dvec4(value));
      return;
    }
  }
}

void Judge::add(uint64_t tick, uint64_t agent, int leg, const Sample& sample, bool tie) {
  ++result_.samples;
  if (tie) ++result_.ties;
  if (sample.ratio_ <= ratio_) return;
  ratio_ = sample.ratio_;
  result_.maxError = sample.error_;
  result_.tolerance = sample.tolerance_;
  char text[400];
  const glm::dvec4 &e = sample.expected_, &g = sample.got_;
  std::snprintf(
      text, sizeof text,
      "%s: tick %llu, agent %llu, leg %d, expected (%.9g, %.9g, %.9g, %.9g), got (%.9g, %.9g, %.9g, "
      "%.9g)",
      sample.quantity_, static_cast<unsigned long long>(tick), static_cast<unsigned long long>(agent), leg,
      e.x, e.y, e.z, e.w, g.x, g.y, g.z, g.w);
  result_.worst = text;
}

StageResult Judge::result() const {
  StageResult result = result_;
  const double allowed = std::max(1.0, reference::tolerance::tieShare * static_cast<double>(result.samples));
  result.pass = !(ratio_ > 1) && static_cast<double>(result.ties) <= allowed;
  return result;
}

}  // namespace skitter::validation
