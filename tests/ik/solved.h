#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "skitter/ik.h"
#include "validation/ik_judge.h"

namespace skitter::test {

// What a batch came to.
struct Solved {
  size_t joints = 0;  // a chain
  std::vector<glm::vec3> joint;
  std::vector<glm::quat> rotation;
  std::vector<ik::Report> report;

  std::span<const glm::vec3> chain(size_t c) const { return std::span(joint).subspan(c * joints, joints); }
};

Solved resultOf(const ik::Batch& batch, bool rotations = false);
// A chain a target, solved once from rest.
Solved solve(Device& device, const ik::Chain& chain, const ik::Options& options,
             const std::vector<glm::vec3>& targets);

// Chain c judged by its joints, and by its rotations where there are any.
validation::IkJudge::Verdict judge(const validation::IkJudge& judge, const Solved& solved, size_t c,
                                   const glm::vec3& target);
// Bone lengths and limits of every chain.
void expectSound(const ik::Chain& chain, const Solved& solved);

}  // namespace skitter::test
