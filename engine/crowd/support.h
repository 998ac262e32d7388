#pragma once

#include <glm/glm.hpp>
#include <vector>

namespace skitter::crowd {

// The convex hull of the feet that stand, seen from above, in any unit of length.
class SupportPolygon {
 public:
  explicit SupportPolygon(std::vector<glm::dvec2> feet);

  // How far a place is inside of it: below 0 outside of it, and -infinity without feet. Feet in a line have
  // no inside, so it is at most 0 then.
  double marginOf(const glm::dvec2& place) const;

 private:
  struct Edge {
    glm::dvec2 inward;  // unit
    double offset;      // of the line along it
  };
  std::vector<Edge> edges_;          // of three corners or more
  std::vector<glm::dvec2> corners_;  // of fewer
};

}  // namespace skitter::crowd
