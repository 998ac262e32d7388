#pragma once

#include <cmath>
#include <glm/glm.hpp>
#include <limits>

#include "experiments/page/svg.h"

namespace skitter::experiments {

// World points on paper, without perspective: seen from a side and a little above, and fitted to a rectangle.
class Projection {
 public:
  // Seen along `away` (x, z, unit); `rise`: radians above the horizon.
  Projection(glm::dvec2 away, double rise) : away_(away), sine_(std::sin(rise)), cosine_(std::cos(rise)) {}

  // Before fit: in metres, to the right and up.
  glm::dvec2 flat(const glm::dvec3& p) const {
    const double deep = p.x * away_.x + p.z * away_.y;
    return {-p.x * away_.y + p.z * away_.x, p.y * cosine_ + deep * sine_};
  }
  void include(const glm::dvec3& p) {
    least_ = glm::min(least_, flat(p));
    most_ = glm::max(most_, flat(p));
  }
  // One scale in both directions, at most as large as the rectangle takes; metres a pixel is its inverse.
  void fit(glm::dvec2 corner, glm::dvec2 size) {
    const glm::dvec2 span = glm::max(most_ - least_, glm::dvec2(1e-6));
    scale_ = std::min(size.x / span.x, size.y / span.y);
    corner_ = corner + 0.5 * (size - scale_ * span);
  }
  glm::dvec2 operator()(const glm::dvec3& p) const {
    const glm::dvec2 at = (flat(p) - least_) * scale_;
    return {corner_.x + at.x, corner_.y + (most_.y - least_.y) * scale_ - at.y};
  }
  double scale() const { return scale_; }

 private:
  glm::dvec2 away_;
  double sine_, cosine_, scale_ = 1;
  glm::dvec2 corner_{0};
  glm::dvec2 least_{std::numeric_limits<double>::infinity()}, most_{-std::numeric_limits<double>::infinity()};
};

// A bar of one length unit in a corner.
inline void drawScale(Svg& svg, const Projection& projection, double metres, const char* words) {
  const glm::dvec2 at(20, svg.height() - 14);
  svg.line(at, at + glm::dvec2(metres * projection.scale(), 0), colour::ink, 2);
  svg.text(at + glm::dvec2(metres * projection.scale() + 8, 4), words, Svg::Anchor::start, 11);
}

}  // namespace skitter::experiments
