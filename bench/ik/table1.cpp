#include "bench/ik/table1.h"

#include <fmt/format.h>

#include <random>

#include "bench/ik/measured_batch.h"
#include "validation/convert_ik.h"

namespace skitter::bench {
namespace {

constexpr int kJoints = 10, kCap = 10000;
constexpr float kTolerance = 1e-3f;

struct Line {
  const char* solver;
  const char* paper;  // what the paper calls it, and its iterations within and out of reach
  const char* paperWithin;
  const char* paperBeyond;
};

const Line lines[] = {
    {"fabrik", "FABRIK", "15.5", "67.6; 1 by a reach test"},
    {"stretch-align", "", "", ""},
    {"ccd", "CCD", "26.3", "390"},
    {"transpose", "Jacobian transpose", "1311", "6549"},
    {"dls", "DLS", "999", ""},
    {"pseudoinverse", "SVD-DLS (nearest)", "809", ""},
    {"target-attached", "", "", ""},
};

std::vector<glm::vec3> targetsAt(double nearest, double farthest, int count) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> distance(nearest, farthest);
  std::vector<glm::vec3> targets;
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 v(normal(random), normal(random), normal(random));
    targets.emplace_back(distance(random) * glm::normalize(v));
  }
  return targets;
}

// Iterations alone, in double, without reach test and stall rule, until the tip is within the tolerance of
// the target, or of the chain's nearest place to one out of reach; kCap where that never happens.
struct Bare {
  double meanIterations = 0, arrivedShare = 0;
};
Bare bareIterations(const reference::IkChain& chain, reference::IkSolver solver,
                    const std::vector<glm::vec3>& targets) {
  reference::IkSettings settings;
  settings.solver = solver;
  settings.tolerance = kTolerance;
  Bare bare;
  for (const glm::vec3& given : targets) {
    const glm::dvec3 target(given);
    const double enough = std::max(0.0, glm::length(target) - 1) + double(kTolerance);
    reference::IkState state = reference::restState(chain);
    int k = 0;
    while (state.error(target) > enough && k < kCap) reference::iterate(chain, settings, target, k++, state);
    bare.meanIterations += k / double(targets.size());
    bare.arrivedShare += (state.error(target) <= enough) / double(targets.size());
  }
  return bare;
}

nlohmann::ordered_json describe(const Bare& bare) {
  return {{"meanIterations", bare.meanIterations}, {"arrivedShare", bare.arrivedShare}};
}

nlohmann::ordered_json describe(const MeasuredBatch& batch, size_t solves) {
  return {{"meanIterations", batch.quality.meanIterations()},
          {"withinToleranceShare", batch.quality.stopShare(ik::Stop::tolerance)},
          {"stallShare", batch.quality.stopShare(ik::Stop::stall)},
          {"microsecondsASolve", 1e6 * batch.seconds / double(solves)}};
}

}  // namespace

nlohmann::ordered_json runTable1(Device& device, int count) {
  const baseline::Chain chain = chainWith("none", kJoints);
  const reference::IkChain exact = validation::referenceOf(deviceChain(chain));
  const std::vector<glm::vec3> within = targetsAt(0.2, 0.95, count), beyond = targetsAt(1.1, 1.5, count);
  fmt::print(
      "{} joints, {} targets at 0.2 to 0.95 of the reach and {} at 1.1 to 1.5, from the bent rest pose,\n"
      "tolerance {} of the reach, at most {} iterations; \"bare\": in double, no reach test, no stall "
      "rule\n\n",
      kJoints, count, count, kTolerance, kCap);
  fmt::print("{:<17}{:>9}{:>10}{:>9}{:>9}   {:>9}{:>10}   {:>9}{:>10}{:>9}   {}\n", "", "device", "", "", "",
             "bare", "", "bare,", "", "device,", "paper: iterations");
  fmt::print("{:<17}{:>9}{:>10}{:>9}{:>9}   {:>9}{:>10}   {:>9}{:>10}{:>9}   {}\n", "solver", "mean",
             "arrived %", "stall %", "us", "mean", "arrived %", "beyond", "arrived %", "beyond",
             "within / beyond");
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const Line& line : lines) {
    ik::Options options;
    options.solver = *ik::solverNamed(line.solver);
    options.tolerance = kTolerance;
    options.iterations = kCap;
    const MeasuredBatch near = measureBatch(device, chain, within, options);
    const MeasuredBatch far = measureBatch(device, chain, beyond, options);
    const Bare bareNear = bareIterations(exact, validation::referenceOf(options.solver), within);
    const Bare bareFar = bareIterations(exact, validation::referenceOf(options.solver), beyond);
    fmt::print(
        "{:<17}{:>9.2f}{:>10.1f}{:>9.1f}{:>9.2f}   {:>9.2f}{:>10.1f}   {:>9.1f}{:>10.1f}{:>9.1f}   {} {} / "
        "{}\n",
        line.solver, near.quality.meanIterations(), 100 * near.quality.stopShare(ik::Stop::tolerance),
        100 * near.quality.stopShare(ik::Stop::stall), 1e6 * near.seconds / count, bareNear.meanIterations,
        100 * bareNear.arrivedShare, bareFar.meanIterations, 100 * bareFar.arrivedShare,
        far.quality.meanIterations(), line.paper, line.paperWithin, line.paperBeyond);
    std::fflush(stdout);
    rows.push_back({{"solver", line.solver},
                    {"reachable", describe(near, within.size())},
                    {"unreachable", describe(far, beyond.size())},
                    {"bareReachable", describe(bareNear)},
                    {"bareUnreachable", describe(bareFar)}});
  }
  return rows;
}

}  // namespace skitter::bench
