#include "bench/ik/quality.h"

#include <algorithm>
#include <cmath>

namespace skitter::bench {
namespace {

constexpr uint32_t kMostCounted = 1u << 16;  // more iterations than that are counted as that

// An error so near the tolerance that rounding decides is no contradiction.
bool contradicts(ik::Stop stop, double error, double tolerance) {
  return stop == ik::Stop::tolerance ? error > tolerance + Quality::kSlip
                                     : error < tolerance - Quality::kSlip && stop != ik::Stop::skipped;
}

}  // namespace

void Quality::add(const validation::IkJudge& judge, std::span<const glm::vec3> targets, float tolerance,
                  const Results& results) {
  const size_t joints = results.joints.size() / targets.size();
  std::vector<glm::dvec3> pose(joints);
  for (size_t c = 0; c < targets.size(); ++c) {
    std::copy_n(results.joints.begin() + std::ptrdiff_t(c * joints), joints, pose.begin());
    const validation::IkJudge::Verdict verdict = judge.judge(targets[c], pose);
    const ik::Report& report = results.reports[c];
    worstLimit = std::max(worstLimit, verdict.limitViolation);
    worstLength = std::max(worstLength, verdict.boneLengthError);
    worstReport = std::max(worstReport, std::abs(verdict.tipError - double(report.error)));
    if (contradicts(report.stop, verdict.tipError, tolerance)) ++wrongStops;
    errorSum_ += verdict.tipError;
    if (verdict.tipError <= kSolved) ++solved_;
    const uint32_t counted = std::min(report.iterations, kMostCounted);
    if (counted >= byIterations_.size()) byIterations_.resize(counted + 1);
    ++byIterations_[counted];
    iterationSum_ += report.iterations;
    ++stops_.at(size_t(report.stop));
  }
  solves_ += targets.size();
}

uint32_t Quality::p99Iterations() const {
  size_t within = 0;
  for (size_t i = 0; i < byIterations_.size(); ++i) {
    within += byIterations_[i];
    if (within * 100 >= solves_ * 99) return uint32_t(i);
  }
  return 0;
}

}  // namespace skitter::bench
