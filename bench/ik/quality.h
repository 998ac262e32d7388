#pragma once

#include <array>
#include <span>
#include <vector>

#include "skitter/ik.h"
#include "validation/ik_judge.h"

namespace skitter::bench {

// What a batch came to: J joints a chain, base first, and what it reports of itself.
struct Results {
  std::vector<glm::vec3> joints;
  std::vector<ik::Report> reports;
};

// The quality of one or more batches, judged in double from their joints.
class Quality {
 public:
  static constexpr double kSolved = 1e-3;  // share of the reach
  static constexpr double kSlip = 5e-5;    // what single precision leaves of 15 bones, share of the reach

  void add(const validation::IkJudge&, std::span<const glm::vec3> targets, float tolerance, const Results&);

  double solvedShare() const { return double(solved_) / double(solves_); }
  double meanIterations() const { return iterationSum_ / double(solves_); }
  uint32_t p99Iterations() const;
  double meanError() const { return errorSum_ / double(solves_); }  // share of the reach
  double stopShare(ik::Stop stop) const { return double(stops_[size_t(stop)]) / double(solves_); }

  double worstLimit = 0;   // radians beyond a limit
  double worstLength = 0;  // of a bone, share of the reach
  double worstReport = 0;  // reported error against the judged one, share of the reach
  size_t wrongStops = 0;   // stops that the error contradicts

 private:
  size_t solves_ = 0, solved_ = 0;
  double iterationSum_ = 0, errorSum_ = 0;
  std::vector<size_t> byIterations_;
  std::array<size_t, ik::stopNames.size()> stops_{};
};

}  // namespace skitter::bench
