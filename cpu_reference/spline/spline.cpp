#include "cpu_reference/spline/spline.h"

#include <algorithm>
#include <cmath>

namespace skitter::reference {
namespace {

using glm::dvec3;

// A segment as the tangents of its ends see it; `there` is false past an open end.
struct Neighbour {
  dvec3 slope{0};
  double time = 1;
  bool there = false;
};

struct Sides {
  const SplineRecipe& recipe;

  Neighbour operator[](ptrdiff_t i) const {
    const auto count = static_cast<ptrdiff_t>(recipe.keys.size()) - 1;
    ptrdiff_t from = i;
    if (recipe.closed)
      from = ((i % count) + count) % count;
    else
      from = std::min(std::max<ptrdiff_t>(i, 0), count - 1);
    const SplineKey &a = recipe.keys[static_cast<size_t>(from)],
                    &b = recipe.keys[static_cast<size_t>(from) + 1];
    return {(b.point - a.point) / (b.time - a.time), b.time - a.time, recipe.closed || from == i};
  }
};

double monotoneMean(double a, double b) { return a * b > 0 ? (a + b) / 2 : 0; }

// Fritsch & Carlson: how much of the tangents m, n at the ends of a slope d may stay.
double monotoneShare(double d, double m, double n) {
  if (d == 0) return 1;
  const double alpha = m / d, beta = n / d, square = alpha * alpha + beta * beta;
  return square > 9 ? 3 / std::sqrt(square) : 1;
}

dvec3 monotoneTangent(const Sides& sides, ptrdiff_t k) {
  dvec3 result;
  for (int c = 0; c < 3; ++c) {
    const auto mean = [&](ptrdiff_t j) { return monotoneMean(sides[j - 1].slope[c], sides[j].slope[c]); };
    double share = 1;
    for (const ptrdiff_t i : {k - 1, k})
      if (sides[i].there) share = std::min(share, monotoneShare(sides[i].slope[c], mean(i), mean(i + 1)));
    result[c] = share * mean(k);
  }
  return result;
}

dvec3 parabolaTangent(const Sides& sides, ptrdiff_t k) {
  const Neighbour a = sides[k - 1], b = sides[k];
  const double share = b.time / (a.time + b.time);
  return share * a.slope + (1 - share) * b.slope;
}

void setTangents(const SplineRecipe& recipe, std::vector<SplineKey>& keys) {
  const Sides sides{recipe};
  const double loose = 1 - recipe.tension, C = recipe.continuity, B = recipe.bias;
  for (size_t index = 0; index < keys.size(); ++index) {
    const auto k = static_cast<ptrdiff_t>(index);
    const Neighbour a = sides[k - 1], b = sides[k];
    SplineKey& key = keys[index];
    switch (recipe.rule) {
      case TangentRule::given:
        continue;
      case TangentRule::zero:
        key.arriving = dvec3(0);
        break;
      case TangentRule::finiteDifference:
        key.arriving = (a.slope + b.slope) / 2.0;
        break;
      case TangentRule::cardinal:
        key.arriving = loose * (a.time * a.slope + b.time * b.slope) / (a.time + b.time);
        break;
      case TangentRule::monotone:
        key.arriving = monotoneTangent(sides, k);
        break;
      case TangentRule::kochanekBartels:
        key.arriving = loose / 2 * ((1 - C) * (1 + B) * a.slope + (1 + C) * (1 - B) * b.slope);
        key.leaving = loose / 2 * ((1 + C) * (1 + B) * a.slope + (1 - C) * (1 - B) * b.slope);
        continue;
      case TangentRule::catmullRom:
        key.arriving = parabolaTangent(sides, k);
        if (keys.size() > 2 && !a.there) key.arriving = 2.0 * b.slope - parabolaTangent(sides, 1);
        if (keys.size() > 2 && !b.there) key.arriving = 2.0 * a.slope - parabolaTangent(sides, k - 1);
        break;
    }
    key.leaving = key.arriving;
  }
}

// Nodes and weights of Gauss-Legendre quadrature on [-1, 1].
constexpr double node[] = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267, 0.9602898564975363};
constexpr double weight[] = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763};

double gauss(const Bezier& curve, double from, double to) {
  double sum = 0;
  for (int i = 0; i < 4; ++i)
    for (const double x : {-node[i], node[i]})
      sum += weight[i] * glm::length(curve.derivative((from + to) / 2 + (to - from) / 2 * x));
  return sum * (to - from) / 2;
}

}  // namespace

dvec3 Bezier::at(double s) const {
  const double r = 1 - s;
  return r * r * r * b0 + 3 * r * r * s * b1 + 3 * r * s * s * b2 + s * s * s * b3;
}
dvec3 Bezier::derivative(double s) const {
  const double r = 1 - s;
  return 3 * r * r * (b1 - b0) + 6 * r * s * (b2 - b1) + 3 * s * s * (b3 - b2);
}
dvec3 Bezier::secondDerivative(double s) const {
  return 6 * (1 - s) * (b2 - 2.0 * b1 + b0) + 6 * s * (b3 - 2.0 * b2 + b1);
}
void Bezier::halve(Bezier& first, Bezier& second) const {
  const dvec3 p = (b0 + b1) / 2.0, q = (b1 + b2) / 2.0, r = (b2 + b3) / 2.0;
  const dvec3 left = (p + q) / 2.0, right = (q + r) / 2.0, middle = (left + right) / 2.0;
  first = {b0, p, left, middle};
  second = {middle, right, r, b3};
}
double Bezier::chord() const { return glm::distance(b0, b3); }
double Bezier::polygon() const {
  return glm::distance(b0, b1) + glm::distance(b1, b2) + glm::distance(b2, b3);
}

double quadratureLength(const Bezier& curve, double s) {
  return gauss(curve, 0, s / 2) + gauss(curve, s / 2, s);
}

double lengthErrorBound(const Bezier& curve) {
  Bezier a, b;
  curve.halve(a, b);
  return a.polygon() + b.polygon() - a.chord() - b.chord();
}

double trueLength(const Bezier& curve, double tolerance) {
  const double chord = curve.chord(), polygon = curve.polygon();
  // Gravesen 1997: this mean is off by far less than the difference.
  if (polygon - chord <= tolerance) return (chord + polygon) / 2;
  Bezier a, b;
  curve.halve(a, b);
  return trueLength(a, tolerance / 2) + trueLength(b, tolerance / 2);
}

HermiteSpline::HermiteSpline(const SplineRecipe& recipe) : closed_(recipe.closed), keys_(recipe.keys) {
  setTangents(recipe, keys_);
  lengths_.push_back(0);
  for (size_t i = 0; i + 1 < keys_.size(); ++i) {
    const SplineKey &from = keys_[i], &to = keys_[i + 1];
    const double third = (to.time - from.time) / 3;
    segments_.push_back(
        {from.point, from.point + third * from.leaving, to.point - third * to.arriving, to.point});
    lengths_.push_back(lengths_.back() + quadratureLength(segments_.back(), 1));
  }
}

HermiteSpline::Place HermiteSpline::place(double time) const {
  const double span = end() - begin();
  if (closed_) time -= span * std::floor((time - begin()) / span);
  time = std::clamp(time, begin(), end());
  size_t i = 0;
  while (i + 2 < keys_.size() && keys_[i + 1].time <= time) ++i;
  return {i, (time - keys_[i].time) / (keys_[i + 1].time - keys_[i].time)};
}

SplineSample HermiteSpline::at(double time) const {
  const auto [i, s] = place(time);
  const double step = keys_[i + 1].time - keys_[i].time;
  const Bezier& b = segments_[i];
  return {b.at(s), b.derivative(s) / step, b.secondDerivative(s) / (step * step), step};
}

double HermiteSpline::lengthAt(double time) const {
  const auto [i, s] = place(time);
  return lengths_[i] + quadratureLength(segments_[i], s);
}

double HermiteSpline::timeAtLength(double wanted) const {
  if (closed_ && length() > 0) wanted -= length() * std::floor(wanted / length());
  wanted = std::clamp(wanted, 0.0, length());
  size_t i = 0;
  while (i + 2 < keys_.size() && lengths_[i + 1] <= wanted) ++i;
  // Bisection: the length never falls.
  double low = 0, high = 1;
  for (int k = 0; k < 60; ++k) {
    const double middle = (low + high) / 2;
    (lengths_[i] + quadratureLength(segments_[i], middle) < wanted ? low : high) = middle;
  }
  return keys_[i].time + high * (keys_[i + 1].time - keys_[i].time);
}

Travel travelAtPhase(const HermiteSpline& spline, double phase, double rounds, double duration,
                     bool constantSpeed) {
  Travel result{.state = TravelState::moving, .phase = phase, .rounds = rounds};
  const double span = spline.end() - spline.begin();
  const double time =
      constantSpeed ? spline.timeAtLength(phase * spline.length()) : spline.begin() + phase * span;
  const SplineSample sample = spline.at(time);
  result.position = sample.position;
  result.velocity = sample.velocity * (span / duration);
  if (constantSpeed) {
    const double speed = glm::length(sample.velocity);
    result.velocity =
        speed * sample.step >= 1e-10 ? sample.velocity / speed * (spline.length() / duration) : dvec3(0);
  }
  result.travelled =
      rounds * spline.length() + (constantSpeed ? phase * spline.length() : spline.lengthAt(time));
  return result;
}

Travel travelAt(const HermiteSpline& spline, const TravelClock& clock, double now, bool constantSpeed) {
  const double elapsed = now - clock.start;
  if (!clock.active || elapsed < 0) return {.position = spline.keys().front().point};
  double phase = elapsed / clock.duration, rounds = 0;
  if (spline.closed()) {
    rounds = std::floor(phase);
    phase -= rounds;
  } else if (phase >= 1) {
    return {TravelState::finished, 1, 0, spline.keys().back().point, dvec3(0), spline.length()};
  }
  return travelAtPhase(spline, phase, rounds, clock.duration, constantSpeed);
}

TravelClock rescaled(const TravelClock& clock, double duration, double now) {
  TravelClock result = clock;
  result.duration = duration;
  const double phase = (now - clock.start) / clock.duration;
  if (clock.active && phase > 0) result.start = now - phase * duration;
  return result;
}

}  // namespace skitter::reference
