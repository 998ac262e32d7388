#include "app/ik/summary.h"

#include <fmt/format.h>

namespace skitter::app {
namespace {

void printRow(const char* name, const std::string& value) { fmt::print("{:<12}{}\n", name, value); }

const char* nameOf(ik::Start start) { return start == ik::Start::rest ? "rest" : "previous"; }

// A float as people write it: 0.0009, not the double that it is.
double written(float value) { return std::stod(fmt::format("{}", value)); }

nlohmann::ordered_json arrayOf(const glm::vec3& v) { return {written(v.x), written(v.y), written(v.z)}; }

std::string solvesOf(const IkSummary& summary, uint64_t solves) {
  const uint64_t wanted = summary.chains * summary.rows;
  const char* from = summary.solve.start == ik::Start::rest ? "the rest pose" : "the row before";
  return fmt::format("{}{}: chains {}, rows {}, from {}", solves,
                     solves < wanted ? fmt::format(" of {}, interrupted", wanted) : "", summary.chains,
                     summary.rows, from);
}

std::string stopsOf(const IkFigures& figures) {
  std::vector<std::string> stops;
  for (size_t s = 0; s < ik::stopNames.size(); ++s) {
    const uint64_t count = figures.stopped(static_cast<ik::Stop>(s));
    if (count > 0) stops.push_back(fmt::format("{} {}", ik::stopNames[s], count));
  }
  return fmt::format("{}", fmt::join(stops, ", "));
}

}  // namespace

void IkSummary::print(const IkFigures& figures) const {
  printRow("device", device);
  printRow("chain", fmt::format("{} joints, length {:.6g}, rest {}, limits {}", chain.bones.size() + 1,
                                chain.reach(), rest, limits));
  printRow("solver", fmt::format("{}, at most {} iterations, tolerance {:.6g} of the length",
                                 ik::nameOf(solve.solver), solve.iterations, solve.tolerance));
  printRow("solves", solvesOf(*this, figures.solves()));
  printRow("solved",
           fmt::format("{:.3f} % within {} of the length", 100 * figures.solvedFraction(), ikSolvedError));
  printRow("error", fmt::format("{:.3g} of the length in the mean, {:.3g} at most", figures.meanError(),
                                figures.worst().tipError));
  printRow("iterations", fmt::format("{:.2f} in the mean, 99th percentile {}", figures.meanIterations(),
                                     figures.p99Iterations()));
  printRow("stopped", stopsOf(figures));
  printRow("limits", fmt::format("exceeded by at most {:.3g} rad", figures.worst().limitViolation));
  printRow("bones", fmt::format("off by at most {:.3g} of the length", figures.worst().boneLengthError));
  printRow("a solve",
           fmt::format("{:.1f} ns, CPU time {:.1f} ns", figures.nanoseconds(), figures.cpuNanoseconds()));
  for (const std::string& file : files) printRow("written", file);
}

nlohmann::ordered_json IkSummary::json(const IkFigures& figures) const {
  nlohmann::ordered_json pose = nlohmann::ordered_json::array(), lengths = pose, stops;
  for (const glm::vec3& joint : chain.rest()) pose.push_back(arrayOf(joint));
  for (const ik::Bone& bone : chain.bones) lengths.push_back(written(bone.length));
  for (size_t s = 0; s < ik::stopNames.size(); ++s) {
    stops[ik::stopNames[s]] = figures.stopped(static_cast<ik::Stop>(s));
  }
  const bool fromFile = !targets.empty();
  return {{"solver", ik::nameOf(solve.solver)},
          {"device", device},
          {"joints", chain.bones.size() + 1},
          {"chains", chains},
          {"rows", rows},
          {"solves", figures.solves()},
          {"solvesWanted", chains * rows},
          {"interrupted", figures.solves() < chains * rows},
          {"start", nameOf(solve.start)},
          {"targets", fromFile ? nlohmann::ordered_json(targets) : nlohmann::ordered_json(nullptr)},
          {"seed", fromFile ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(seed)},
          {"tolerance", written(solve.tolerance)},
          {"iterations", solve.iterations},
          {"restPull", written(solve.restPull.value_or(0))},
          {"limits", limits},
          {"pole", chain.pole ? arrayOf(*chain.pole) : nlohmann::ordered_json(nullptr)},
          {"bones", lengths},
          {"rest", pose},
          {"solvedFraction", figures.solvedFraction()},
          {"meanIterations", figures.meanIterations()},
          {"p99Iterations", figures.p99Iterations()},
          {"maxError", figures.worst().tipError},
          {"meanError", figures.meanError()},
          {"maxLimitViolation", figures.worst().limitViolation},
          {"maxBoneLengthError", figures.worst().boneLengthError},
          {"stopped", stops},
          {"nanosecondsPerSolve", figures.nanoseconds()},
          {"cpuNanosecondsPerSolve", figures.cpuNanoseconds()}};
}

}  // namespace skitter::app
