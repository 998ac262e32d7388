#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "skitter/error.h"
#include "skitter/spline.h"
#include "spline/checks.h"
#include "spline/tangents.h"

namespace skitter {
namespace {

using glm::dvec3;

// Gauss-Legendre on [-1, 1].
constexpr double kNode[4] = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267, 0.9602898564975363};
constexpr double kWeight[4] = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                               0.1012285362903763};

void checkCount(const char* name, size_t found, size_t expected) {
  if (found != expected)
    throw inputError(fmt::format("the spline has {} {}, expected {}", found, name, expected));
}

void check(const SplineChain& chain) {
  const size_t points = chain.points.size();
  checkPointCount(points);
  checkTangentRule(chain.tangents);
  checkPoints("the spline", chain.points);
  if (!chain.knots.empty()) checkCount("knots", chain.knots.size(), points + (chain.closed ? 1 : 0));
  checkKnots("the spline", chain.knots);
  if (chain.tangents.rule != SplineRule::given) return;
  checkCount("arriving tangents", chain.arriving.size(), points);
  if (!chain.leaving.empty()) checkCount("leaving tangents", chain.leaving.size(), points);
  checkTangents("the spline", chain.arriving);
  checkTangents("the spline", chain.leaving);
}

// The last of the ascending `marks`, but for the very last, that is not after `at`.
size_t segmentOf(const std::vector<double>& marks, double at) {
  const auto after = std::upper_bound(marks.begin() + 1, marks.end() - 1, at);
  return static_cast<size_t>(after - marks.begin()) - 1;
}

double wrapped(double at, double first, double last, bool closed) {
  if (!closed) return std::clamp(at, first, last);
  const double span = last - first;
  return span > 0 ? std::clamp(at - span * std::floor((at - first) / span), first, last) : first;
}

}  // namespace

std::vector<float> splineKnots(std::span<const glm::vec3> points, bool closed, float power) {
  checkPointCount(points.size());
  checkPoints("the spline", points);
  if (!(power >= 0 && power <= 1))
    throw inputError(fmt::format("the power of the chords is {}, expected 0 to 1", power));
  std::vector<float> knots = {0};
  const size_t segments = points.size() - (closed ? 0 : 1);
  double knot = 0;
  for (size_t i = 0; i < segments; ++i) {
    const double distance = glm::distance(dvec3(points[i]), dvec3(points[(i + 1) % points.size()]));
    // Points on one another still are apart in float32.
    knot += std::max({std::pow(distance, static_cast<double>(power)), 2e-6, 0x1p-21 * knot});
    knots.push_back(static_cast<float>(knot));
  }
  checkKnots("the spline", knots);
  return knots;
}

Spline::Spline(const SplineChain& chain) : closed_((check(chain), chain.closed)) {
  std::vector<dvec3> points(chain.points.begin(), chain.points.end());
  if (closed_) points.push_back(points.front());
  knots_.assign(chain.knots.begin(), chain.knots.end());
  if (knots_.empty())
    for (size_t k = 0; k < points.size(); ++k) knots_.push_back(static_cast<double>(k));
  const std::vector<TangentPair> tangents = tangentsOf(chain, points, knots_);
  lengths_ = {0};
  for (size_t i = 0; i + 1 < points.size(); ++i) {
    const dvec3 d = points[i + 1] - points[i], a = step(i) * tangents[i].leaving,
                b = step(i) * tangents[i + 1].arriving;
    segments_.push_back({points[i], a, 3.0 * d - 2.0 * a - b, a + b - 2.0 * d});
    lengths_.push_back(lengths_.back() + segments_.back().length(1));
  }
  clock.duration = end() - begin();
}

double Spline::Segment::length(double s) const {
  double sum = 0;
  for (const double middle : {0.25 * s, 0.75 * s})
    for (int n = 0; n < 4; ++n)
      sum += kWeight[n] * (glm::length(first(middle - 0.25 * s * kNode[n])) +
                           glm::length(first(middle + 0.25 * s * kNode[n])));
  return 0.25 * s * sum;
}

Spline::Place Spline::placeAt(double time) const {
  const double at = wrapped(time, begin(), end(), closed_);
  const size_t i = segmentOf(knots_, at);
  return {i, std::clamp((at - knots_[i]) / step(i), 0.0, 1.0)};
}

Spline::Place Spline::placeAtLength(double length) const {
  const double at = wrapped(length, 0, this->length(), closed_);
  const size_t i = segmentOf(lengths_, at);
  const double whole = lengths_[i + 1] - lengths_[i], part = at - lengths_[i];
  if (!(whole > 0)) return {i, 0};
  double s = std::clamp(part / whole, 0.0, 1.0), low = 0, high = 1;
  for (int k = 0; k < 24; ++k) {
    const double off = segments_[i].length(s) - part;
    if (std::abs(off) <= 1e-12 * whole) break;
    (off < 0 ? low : high) = s;
    const double next = s - off / glm::length(segments_[i].first(s));
    s = next > low && next < high ? next : 0.5 * (low + high);
  }
  return {i, s};
}

glm::vec3 Spline::position(double time) const {
  const auto [i, s] = placeAt(time);
  const Segment& segment = segments_[i];
  return segment.p + s * (segment.a + s * (segment.c + s * segment.e));
}

glm::vec3 Spline::velocity(double time) const {
  const auto [i, s] = placeAt(time);
  return segments_[i].first(s) / step(i);
}

glm::vec3 Spline::acceleration(double time) const {
  const auto [i, s] = placeAt(time);
  return (2.0 * segments_[i].c + 6.0 * s * segments_[i].e) / (step(i) * step(i));
}

double Spline::lengthAt(double time) const {
  const auto [i, s] = placeAt(time);
  return lengths_[i] + segments_[i].length(s);
}

double Spline::timeAtLength(double length) const {
  const auto [i, s] = placeAtLength(length);
  return knots_[i] + s * step(i);
}

SplineMotion Spline::at(double now, bool constantSpeed) const {
  SplineMotion motion{.state = clock.state(now, closed_)};
  // A finished spline is at its end, where a closed one would wrap.
  const double phase = progress(now), duration = clock.duration;
  const auto [i, s] =
      constantSpeed ? placeAtLength(phase * length()) : placeAt(begin() + phase * (end() - begin()));
  const Segment& segment = segments_[i];
  motion.position = segment.p + s * (segment.a + s * (segment.c + s * segment.e));
  const double within = constantSpeed ? phase * length() : lengths_[i] + segment.length(s);
  motion.travelled = static_cast<float>(clock.rounds(now, closed_) * length() + within);
  if (motion.state != SplineState::moving) return motion;
  const dvec3 tangent = segment.first(s);
  if (!constantSpeed)
    motion.velocity = tangent * ((end() - begin()) / (step(i) * duration));
  else if (const double speed = glm::length(tangent); speed >= 1e-10)
    motion.velocity = tangent * (length() / (duration * speed));
  return motion;
}

}  // namespace skitter
