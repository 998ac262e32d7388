#pragma once

#include <algorithm>
#include <cmath>

#include "cpu_reference/roundoff.h"
#include "cpu_reference/spline/spline.h"

// How far a float32 implementation of docs/spline.md may be from the reference, both from the same float32
// keys and clock. First-order bounds, as in stages/tolerances.h: a division errs by 5 roundoff, a length
// by 8.
namespace skitter::reference::tolerance {

struct TravelBounds {
  double phase, position, velocity, travelled;
};

class SplineBounds {
 public:
  SplineBounds(const SplineRecipe& recipe, const HermiteSpline& of) : spline_(of) {
    const std::vector<SplineKey>& keys = spline_.keys();
    double steepest = 0;
    for (size_t i = 0; i < spline_.segments(); ++i)
      steepest = std::max(steepest, glm::distance(keys[i + 1].point, keys[i].point) / step(i));
    // A slope errs by 7 roundoff; a rule weighs two of them by no more than `weight` and errs by at most 24
    // more of what it weighs. The end of catmullRom weighs by 3, Kochanek-Bartels by up to 8.
    const double weight =
        recipe.rule == TangentRule::kochanekBartels
            ? (1 + std::abs(recipe.tension)) * (1 + std::abs(recipe.continuity)) * (1 + std::abs(recipe.bias))
            : 3;
    const bool byRule = recipe.rule != TangentRule::given && recipe.rule != TangentRule::zero;
    tangent_ = byRule ? 32 * roundoff * weight * steepest : 0;
    for (const SplineKey& key : keys) {
      farthest_ = std::max(farthest_, glm::length(key.point));
      latest_ = std::max(latest_, std::abs(key.time));
    }
    // 16 lengths of derivatives, weighed and added, a segment; then a sum over the segments.
    for (size_t i = 0; i < spline_.segments(); ++i) length_ += derivative(i);
    length_ += (24 + static_cast<double>(spline_.segments())) * roundoff * spline_.length();
  }

  TravelBounds of(const Travel& travel, double duration, bool constantSpeed) const {
    TravelBounds bounds{};
    const double span = spline_.end() - spline_.begin();
    // e and e / D: 6; times T: 2; + t_0 and - t_i: one rounding of a knot each; / h_i: 5 of at most T.
    bounds.phase = roundoff * (20 + 6 * latest_ / span);
    // A length sought is off by both sums' errors and by what the solver may leave.
    if (constantSpeed && spline_.length() > 0)
      bounds.phase = 20 * roundoff + 1e-6 + 2 * length_ / spline_.length();
    const double time = constantSpeed ? spline_.timeAtLength(travel.phase * spline_.length())
                                      : spline_.begin() + travel.phase * span;
    const size_t here = segmentAt(time);
    double size = 0, rate = 0, slack = 0;
    for (size_t i = here > 0 ? here - 1 : 0; i < std::min(here + 2, spline_.segments()); ++i) {
      size = std::max(size, sizeOf(i));
      slack = std::max(slack, step(i) * tangent_);
      rate = std::max(rate, derivative(i) / step(i));
    }
    // D, a, b err by 3 of their size; c and e weigh them by 6 and 4 and add 5; Horner's rule adds 6 of at
    // most 6.
    bounds.position = roundoff * (2 * farthest_ + 64 * size) + slack;
    double fastest = glm::length(travel.velocity), shift = 0, turn = 0;
    if (travel.state == TravelState::moving) {
      const double turned = span / duration;
      bounds.velocity = rate * turned;
      if (constantSpeed) {
        const double even = spline_.length() / duration;
        const double speed = glm::length(spline_.at(time).velocity);
        bounds.velocity =
            even * (std::min(2.0, 2 * rate / std::max(speed, 1e-300)) + 16 * roundoff) + length_ / duration;
      }
      for (const double side : {-bounds.phase, bounds.phase}) {
        double phase = travel.phase + side;
        phase = spline_.closed() ? phase - std::floor(phase) : std::clamp(phase, 0.0, 1.0);
        const Travel beside = travelAtPhase(spline_, phase, travel.rounds, duration, constantSpeed);
        shift = std::max(shift, glm::distance(beside.position, travel.position));
        turn = std::max(turn, glm::distance(beside.velocity, travel.velocity));
        fastest = std::max(fastest, glm::length(beside.velocity));
      }
    }
    bounds.position += shift;
    bounds.velocity += turn;
    bounds.travelled =
        fastest * duration * bounds.phase + (travel.rounds + 1) * (length_ + 3 * roundoff * spline_.length());
    return bounds;
  }

  double length() const { return length_; }

 private:
  double step(size_t i) const { return spline_.keys()[i + 1].time - spline_.keys()[i].time; }
  size_t segmentAt(double time) const {
    size_t i = 0;
    while (i + 1 < spline_.segments() && spline_.keys()[i + 1].time <= time) ++i;
    return i;
  }
  // |D| + |a| + |b|
  double sizeOf(size_t i) const {
    const SplineKey &from = spline_.keys()[i], &to = spline_.keys()[i + 1];
    return glm::distance(from.point, to.point) +
           step(i) * (glm::length(from.leaving) + glm::length(to.arriving));
  }
  // The bound of dP/ds: 2 c errs by 30 of the size, 3 e by 30, their sum and product by 100, the length by 8
  // of 25; a basis function's slope is at most 1.
  double derivative(size_t i) const { return 360 * roundoff * sizeOf(i) + 2 * step(i) * tangent_; }

  const HermiteSpline& spline_;
  double tangent_ = 0, farthest_ = 0, latest_ = 0, length_ = 0;
};

}  // namespace skitter::reference::tolerance
