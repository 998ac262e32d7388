#include "bench/ik/caliko.h"

#include <fmt/format.h>

#include "bench/ik/problem.h"
#include "validation/convert_ik.h"

namespace skitter::bench {
namespace {

constexpr int kChainJoints = 10, kMostIterations = 20;
constexpr double kLength = 10 * (kChainJoints - 1);  // bones of 10
constexpr double kSolved = 1 / kLength, kLeastGain = 0.01 / kLength;

struct Outcome {
  bool solved;
  int iterations;
};

Outcome solve(const reference::IkChain& chain, reference::IkSolver solver, const glm::dvec3& target) {
  reference::IkSettings settings;
  settings.solver = solver;
  settings.tolerance = kSolved;
  reference::IkState state = reference::restState(chain);
  double error = state.error(target), gain = error;
  int k = 0;
  for (; k < kMostIterations && error > kSolved && gain >= kLeastGain; ++k) {
    const double before = state.error(target);
    reference::iterate(chain, settings, target, k, state);
    gain = std::abs(before - state.error(target));
    error = std::min(error, state.error(target));
  }
  return {error <= kSolved, k};
}

}  // namespace

nlohmann::ordered_json runCaliko(int count) {
  const reference::IkChain chain = validation::referenceOf(deviceChain(chainWith("caliko", kChainJoints)));
  const Targets targets({baseline::coldTargets(chainWith("none", kChainJoints), size_t(count), 1)},
                        size_t(count));
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  fmt::print(
      "\nCaliko's set-up by its own measure: {} joints, straight rest, balls of 90 degrees, free base,\n"
      "{} targets at 0.2 to 0.95 of the reach, at most {} iterations, solved within {:.4f} of the reach\n",
      kChainJoints, count, kMostIterations, kSolved);
  for (const reference::IkSolver solver : {reference::IkSolver::fabrik, reference::IkSolver::activeSet}) {
    int solved = 0, iterations = 0;
    for (const glm::vec3& target : targets.vectors[0]) {
      const Outcome outcome = solve(chain, solver, glm::dvec3(target));
      solved += outcome.solved;
      iterations += outcome.iterations;
    }
    const char* name = solver == reference::IkSolver::fabrik ? "fabrik" : "active-set-alone";
    const double share = double(solved) / count, mean = double(iterations) / count;
    fmt::print("{:<17} solved {:.1f} %, {:.2f} iterations\n", name, 100 * share, mean);
    rows.push_back({{"solver", name}, {"solvedShare", share}, {"meanIterations", mean}});
  }
  return rows;
}

}  // namespace skitter::bench
