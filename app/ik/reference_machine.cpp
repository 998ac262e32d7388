#include <algorithm>
#include <thread>

#include "app/ik/machine.h"
#include "cpu_reference/ik/seeds.h"
#include "cpu_reference/ik/solve.h"
#include "validation/convert_ik.h"

namespace skitter::app {
namespace {

reference::IkSolver solverOf(ik::Solver solver) {
  return solver == ik::Solver::automatic ? reference::IkSolver::activeSet : validation::referenceOf(solver);
}

ik::Stop stopOf(reference::IkStop stop) {
  switch (stop) {
    case reference::IkStop::tolerance:
      return ik::Stop::tolerance;
    case reference::IkStop::cap:
      return ik::Stop::cap;
    case reference::IkStop::stall:
      return ik::Stop::stall;
    case reference::IkStop::unreachable:
      return ik::Stop::unreachable;
    case reference::IkStop::held:
      return ik::Stop::held;
    case reference::IkStop::jumped:
      return ik::Stop::jumped;
    default:
      return ik::Stop::skipped;
  }
}

reference::IkChain chainOf(const ik::Chain& chain, bool seeded) {
  reference::IkChain result = validation::referenceOf(chain);
  if (seeded) result.seeds = reference::makeSeeds(result, 1);
  return result;
}

reference::IkSettings settingsOf(const ik::Options& options) {
  reference::IkSettings settings;
  settings.solver = solverOf(options.solver);
  settings.tolerance = options.tolerance;
  settings.iterations = static_cast<int>(options.iterations);
  settings.restarts = options.restarts;
  settings.continues = options.start == ik::Start::previous;
  settings.restPull = options.restPull.value_or(0);
  return settings;
}

// Calls work(first, end) for parts of 0 .. count, one on each core.
template <class Work>
void inParallel(size_t count, const Work& work) {
  const size_t parts = std::clamp<size_t>(std::thread::hardware_concurrency(), 1, std::max<size_t>(count, 1));
  std::vector<std::jthread> threads;
  for (size_t p = 0; p < parts; ++p) {
    threads.emplace_back(work, count * p / parts, count * (p + 1) / parts);
  }
}

class ReferenceMachine : public IkMachine {
 public:
  ReferenceMachine(const ik::Chain& chain, uint32_t chains, const ik::Options& options)
      : settings_(settingsOf(options)),
        chain_(chainOf(chain, settings_.solver == reference::IkSolver::activeSet)),
        rest_(reference::restState(chain_)),
        rotations_(options.rotations),
        results_(chains, {rest_, 0, 0, reference::IkStop::skipped}),
        memories_(chains) {}

  std::string name() const override { return "cpu, the reference in double precision"; }
  void warmUp(std::span<const glm::vec3>) override {}

  IkLot solve(std::span<const glm::vec3> targets) override {
    IkLot lot;
    lot.spent = base::timed([&] {
      inParallel(targets.size(), [&](size_t first, size_t end) {
        for (size_t c = first; c < end; ++c) solveOne(c, targets[c]);
      });
    });
    for (size_t c = 0; c < targets.size(); ++c) append(results_[c], lot);
    return lot;
  }

 private:
  void solveOne(size_t c, const glm::vec3& target) {
    const reference::IkState& start = settings_.continues ? results_[c].state : rest_;
    results_[c] =
        reference::solveIk(chain_, settings_, glm::dvec3(target) / chain_.length, start, memories_[c]);
  }

  void append(const reference::IkResult& result, IkLot& lot) const {
    for (const glm::dvec3& joint : result.state.joints) lot.joints.emplace_back(joint * chain_.length);
    lot.reports.push_back(
        {static_cast<float>(result.error), static_cast<uint32_t>(result.iterations), stopOf(result.stop)});
    if (!rotations_) return;
    for (const glm::dmat3& rotation : rotationsOf(result.state)) {
      lot.rotations.emplace_back(glm::normalize(glm::quat_cast(rotation)));
    }
  }

  // The dissertation's solvers move joints and leave the pose behind.
  std::vector<glm::dmat3> rotationsOf(const reference::IkState& state) const {
    const bool byJoints = chain_.free || settings_.solver == reference::IkSolver::dissertationKeep ||
                          settings_.solver == reference::IkSolver::dissertationEdge;
    return byJoints ? reference::rotationsOf(chain_, state.joints)
                    : reference::rotationsOf(chain_, state.pose);
  }

  reference::IkSettings settings_;
  reference::IkChain chain_;
  reference::IkState rest_;
  bool rotations_;
  std::vector<reference::IkResult> results_;
  std::vector<reference::IkMemory> memories_;
};

}  // namespace

std::unique_ptr<IkMachine> makeReferenceMachine(const ik::Chain& chain, uint32_t chains,
                                                const ik::Options& options) {
  return std::make_unique<ReferenceMachine>(chain, chains, options);
}

}  // namespace skitter::app
