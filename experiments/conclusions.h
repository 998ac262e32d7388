#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/page/table.h"
#include "experiments/results.h"

namespace skitter::experiments {

// Something that the dissertation concludes, held against what was measured here; by figures alone.
struct Conclusion {
  std::string claim;
  std::string rests;      // on which figure
  std::string criterion;  // when it would hold
  std::string measured;
  std::optional<bool> holds;  // none: not measured this time, or not settled by it
};

std::vector<Conclusion> conclusionsOf(const Results& results);
// "holds", "does not hold", "not settled", "not measured".
std::string verdictOf(const Conclusion& conclusion);
Table tableOf(const std::vector<Conclusion>& conclusions);

}  // namespace skitter::experiments
