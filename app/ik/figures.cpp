#include "app/ik/figures.h"

#include <algorithm>

#include "validation/convert_ik.h"

namespace skitter::app {
using validation::IkJudge;

IkFigures::IkFigures(const ik::Chain& chain)
    : joints_(chain.bones.size() + 1), judge_(validation::judgeOf(chain)) {}

void IkFigures::add(std::span<const glm::vec3> targets, const IkLot& lot) {
  std::vector<glm::dvec3> pose(joints_);
  for (size_t c = 0; c < targets.size(); ++c) {
    std::copy_n(lot.joints.begin() + static_cast<std::ptrdiff_t>(c * joints_), joints_, pose.begin());
    const IkJudge::Verdict verdict = judge_.judge(targets[c], pose);
    worst_.tipError = std::max(worst_.tipError, verdict.tipError);
    worst_.limitViolation = std::max(worst_.limitViolation, verdict.limitViolation);
    worst_.boneLengthError = std::max(worst_.boneLengthError, verdict.boneLengthError);
    errorSum_ += verdict.tipError;
    if (verdict.tipError <= ikSolvedError) ++solved_;

    const ik::Report& report = lot.reports[c];
    if (report.iterations >= byIterations_.size()) byIterations_.resize(report.iterations + 1);
    ++byIterations_[report.iterations];
    iterationSum_ += report.iterations;
    ++stopped_.at(static_cast<size_t>(report.stop));
  }
  solves_ += targets.size();
  // The last lot may be filled up; what that took is not these targets'.
  const double share = static_cast<double>(targets.size()) / static_cast<double>(lot.reports.size());
  seconds_ += share * lot.spent.wall;
  cpuSeconds_ += share * lot.spent.cpu;
}

uint32_t IkFigures::p99Iterations() const {
  uint64_t within = 0;
  for (size_t i = 0; i < byIterations_.size(); ++i) {
    within += byIterations_[i];
    if (within * 100 >= solves_ * 99) return static_cast<uint32_t>(i);
  }
  return 0;
}

}  // namespace skitter::app
