#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "skitter/ik.h"

namespace skitter::ik {

// A chain made ready: bone frames, lengths as shares of the reach, limits in radians within what the solvers
// can hold. Double precision, for set-up on the host.
class Skeleton {
 public:
  explicit Skeleton(const Chain&);

  struct Joint {
    glm::dmat3 frame{1};  // B_i
    double length = 0;
    glm::dvec3 axis{0, 0, 1};  // o_i, the bone in its frame
    Limit limit = Free{};
    double twistMin = 0, twistMax = 0;
    double stiffness = 1;
  };
  // d_i and tau_i.
  struct Pose {
    std::vector<glm::dvec3> directions;
    std::vector<double> twists;
  };

  const std::vector<Joint>& joints() const { return joints_; }
  size_t bones() const { return joints_.size(); }
  bool hasTwists() const;
  bool isPadded() const;        // a bone has no length
  bool restIsLegal() const;     // no limit forbids it
  bool restIsStraight() const;  // every joint within 2e-3 of the line base-tip

  Pose rest() const;
  // p_1 .. p_n, base at 0.
  std::vector<glm::dvec3> place(const Pose&) const;
  // The legal pose whose bones point, as far as they may, from one given joint (base first) to the next.
  Pose aim(std::span<const glm::dvec3> joints) const;

 private:
  std::vector<Joint> joints_;
};

}  // namespace skitter::ik
