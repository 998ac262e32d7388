#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "cpu_reference/ik/solve.h"
#include "skitter/ik.h"
#include "validation/ik_judge.h"

// Chains of the batch (skitter/ik.h) and its records (shaders/shared/ik_batch.h) as the reference has them.
namespace skitter::validation {

reference::IkChain referenceOf(const ik::Chain& chain);
// `solver` is not `automatic`.
reference::IkSolver referenceOf(ik::Solver solver);
IkJudge judgeOf(const ik::Chain& chain);

// Where a batch's records of one kind of chain keep what.
struct IkLayout {
  int bones;
  bool twists;      // of the records, whether a bone may twist
  bool positional;  // the state is joints

  IkLayout(const reference::IkChain& chain, reference::IkSolver solver);
  size_t stateStride() const;
  size_t seedStride() const;
};

// The records of one chain, of one seed.
reference::IkState stateOf(const reference::IkChain& chain, const IkLayout& layout,
                           std::span<const glm::vec4> record);
std::vector<reference::Pose> seedsOf(const IkLayout& layout, std::span<const glm::vec4> records);
// A state's record, as the batch reads it.
void append(const reference::IkChain& chain, const IkLayout& layout, const reference::IkState& state,
            std::vector<glm::vec4>& records);

}  // namespace skitter::validation
