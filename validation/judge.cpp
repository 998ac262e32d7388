#include "validation/judge.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace skitter::validation {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

double ratioOf(double error, double tolerance) {
  return error == 0 ? 0 : (tolerance > 0 ? error / tolerance : infinite);
}

}  // namespace

double StageResult::ratio() const { return ratioOf(maxError, tolerance); }

void Sample::compare(const char* quantity, double error, double tolerance, const glm::dvec4& expected,
                     const glm::dvec4& got) {
  if (!std::isfinite(error)) error = infinite;
  const double ratio = ratioOf(error, tolerance);
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
      compare(record, infinite, 0, glm::dvec4(0), glm::dvec4(value));
      return;
    }
  }
}

namespace {

std::string placeOf(uint64_t tick, uint64_t agent, int leg) {
  return "tick " + std::to_string(tick) + ", agent " + std::to_string(agent) + ", leg " + std::to_string(leg);
}

std::string textOf(const glm::dvec4& v) {
  char text[128];
  std::snprintf(text, sizeof text, "(%.9g, %.9g, %.9g, %.9g)", v.x, v.y, v.z, v.w);
  return text;
}

}  // namespace

void Judge::add(uint64_t tick, uint64_t agent, int leg, const Sample& sample, bool tie) {
  ++result_.samples;
  if (tie) ++result_.ties;
  if (sample.ratio_ <= ratio_) return;
  ratio_ = sample.ratio_;
  result_.maxError = sample.error_;
  result_.tolerance = sample.tolerance_;
  result_.worst = std::string(sample.quantity_) + ": " + placeOf(tick, firstAgent_ + agent, leg) +
                  ", expected " + textOf(sample.expected_) + ", got " + textOf(sample.got_);
}

StageResult Judge::result() const {
  StageResult result = result_;
  if (result.samples + result.kept == 0) result.why = "no samples";
  if (hasRefused()) result.why = "beyond the tolerance: " + result.worst;
  result.pass = result.why.empty();
  return result;
}

}  // namespace skitter::validation
