#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <span>
#include <vector>

#include "validation/limits.h"

// What a pose is worth, from where its joints are and nothing else: docs/ik.md (Chain) once more, in double
// and sharing no code with those who solve. Radians; angles are measured by atan2, so that they are exact
// near nothing as near a half turn.
namespace skitter::validation {

class IkJudge {
 public:
  struct Bone {
    double length = 0;
    glm::dvec3 rest{0, 1, 0};  // any length but 0
    judged::Limit limit = judged::Free{};
    double twistMin = 0, twistMax = 0;
  };
  struct Verdict {
    double tipError = 0;         // distance of the tip from the target, share of the chain's length
    double limitViolation = 0;   // of the bone that breaks its limit most
    double boneLengthError = 0;  // of the worst bone, share of the chain's length; of the base's way from 0
  };

  // Throws std::invalid_argument for a chain without length.
  explicit IkJudge(std::vector<Bone> bones);

  // `joints`: base first, one more than bones; the base belongs at 0. With `rotations`, each bone's from rest
  // to the world, frames are the rotations' own, twist is judged, and so is whether they put the bones where
  // the joints say. Joints alone do not show twist: a chain with a twist range cannot do without. A pose that
  // is not finite errs infinitely in all three. Throws std::invalid_argument for counts that do not match.
  Verdict judge(const glm::dvec3& target, std::span<const glm::dvec3> joints,
                std::span<const glm::dquat> rotations = {}) const;
  bool needsRotations() const;

 private:
  struct RestBone {
    double length;
    glm::dvec3 direction;
    glm::dmat3 frame;
    judged::Limit limit;
    double twistMin, twistMax;
  };
  double worstLimit(std::span<const glm::dvec3> joints) const;
  double worstLimit(std::span<const glm::dvec3> joints, std::span<const glm::dquat> rotations) const;

  std::vector<RestBone> bones_;
  double length_ = 0;
  bool free_ = true;
};

}  // namespace skitter::validation
