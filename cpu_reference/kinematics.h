#pragma once

#include "cpu_reference/types.h"

namespace skitter::reference {

// (X, Y) = (d.x, d.y) / (1 + d.z) of a unit vector, and back.
glm::dvec2 stereographic(const glm::dvec3& d);
glm::dvec3 direction(const glm::dvec2& xy);
// Scales (X, Y) onto the cone |(X, Y)| <= tan(alpha / 2).
glm::dvec2 clampCone(const glm::dvec2& xy, double tanHalfCone);

// A limb's directions with what forward kinematics makes of them: model space with the root at 0 and lengths
// divided by the reach.
class Posture {
 public:
  Posture(const Limb& limb, std::vector<glm::dvec2> directions);

  // Sets the direction of bone i and places it; the bones after it are stale until placed in turn.
  void place(size_t i, const glm::dvec2& xy);
  void setDirections(const std::vector<glm::dvec2>& directions);

  size_t bones() const { return directions_.size(); }
  const std::vector<glm::dvec2>& directions() const { return directions_; }
  const glm::dmat3& frame(size_t i) const { return frames_[i]; }  // A_i
  const glm::dvec3& joint(size_t i) const { return joints_[i]; }  // p_i
  const glm::dvec3& tip() const { return joints_.back(); }        // p_n

 private:
  const Limb* limb_;
  std::vector<glm::dvec2> directions_;
  std::vector<glm::dmat3> frames_;  // A_0 .. A_n, the last one unused
  std::vector<glm::dvec3> joints_;
};

}  // namespace skitter::reference
