#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "app/ik/machine.h"
#include "skitter/ik.h"
#include "validation/ik_judge.h"

namespace skitter::app {

// How well and how fast solves went. Errors are the judge's, from the joints that came out; only iterations
// and why solves stopped are the solver's word.
class IkFigures {
 public:
  explicit IkFigures(const ik::Chain& chain);

  // The first solves of a lot, as many as targets.
  void add(std::span<const glm::vec3> targets, const IkLot& lot);

  uint64_t solves() const { return solves_; }
  double solvedFraction() const { return perSolve(static_cast<double>(solved_)); }
  double meanError() const { return perSolve(errorSum_); }
  const validation::IkJudge::Verdict& worst() const { return worst_; }  // of each figure by itself
  double meanIterations() const { return perSolve(iterationSum_); }
  uint32_t p99Iterations() const;
  uint64_t stopped(ik::Stop why) const { return stopped_.at(static_cast<size_t>(why)); }
  double nanoseconds() const { return 1e9 * perSolve(seconds_); }  // a solve
  double cpuNanoseconds() const { return 1e9 * perSolve(cpuSeconds_); }

 private:
  double perSolve(double sum) const { return sum / static_cast<double>(solves_); }

  size_t joints_;
  validation::IkJudge judge_;
  uint64_t solves_ = 0, solved_ = 0;
  std::vector<uint64_t> byIterations_;
  std::array<uint64_t, ik::stopNames.size()> stopped_{};
  double errorSum_ = 0, iterationSum_ = 0, seconds_ = 0, cpuSeconds_ = 0;
  validation::IkJudge::Verdict worst_;
};

// A chain counts as solved below this error, a share of the chain's length.
inline constexpr double ikSolvedError = 1e-3;

}  // namespace skitter::app
