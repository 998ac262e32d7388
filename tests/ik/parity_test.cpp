// Every solver on every kind of chain against the reference in double precision: single iterations, whose
// joints must agree, and whole solves, whose error, iterations and stop reason must.
#include <algorithm>

#include "ik/runs.h"
#include "support/gpu_fixture.h"
#include "validation/convert_ik.h"

namespace skitter::test {
namespace {

constexpr size_t chains = 128;
// Ties: chains that rounding may send another way. In one iteration they are accidents; over a whole solve a
// limited chain takes dozens of decisions.
constexpr double iterationTies = 0.05, solveTies = 0.15;

// In how many directions the joints can move the tip at all.
size_t rankOf(const reference::IkChain& chain) {
  size_t columns = 0;
  for (const reference::BoneRest& bone : chain.bones)
    columns += bone.kind == reference::LimitKind::hinge ? 1 : 2;
  return std::min<size_t>(columns, 3);
}

// Whether float has anything left of a step: J J^T + mu I of rank 1, or of less than 3 with the
// pseudoinverse's mu of 1e-6 tr(J J^T), is singular to it.
bool isDetermined(const reference::IkChain& chain, ik::Solver solver) {
  using enum ik::Solver;
  if (solver == pseudoinverse) return rankOf(chain) == 3;
  if (solver == dampedLeastSquares || solver == targetAttached || solver == activeSet)
    return rankOf(chain) > 1;
  return true;
}

bool isComparable(const ik::Chain& chain, ik::Solver solver) {
  if (solver == ik::Solver::automatic) return false;
  const reference::IkChain expected = validation::referenceOf(chain);
  return accepts(expected, validation::referenceOf(solver)) && isDetermined(expected, solver);
}

// One iteration and whole solves, from random legal poses.
void compareSolver(Device& device, const std::string& limits, size_t joints, ik::Solver solver,
                   uint64_t seed) {
  Random random(seed);
  const ik::Chain chain = randomChain(limits, joints, random);
  if (!isComparable(chain, solver)) return;
  ik::Options options{.solver = solver, .start = ik::Start::previous, .iterations = 1, .restarts = false};
  expectParity(randomRun(device, limits, chain, chains, options, seed), iterationTies);
  options.iterations = solver == ik::Solver::activeSet ? 64 : 20;
  options.restarts = true;
  expectParity(randomRun(device, limits + ", whole", chain, chains, options, seed + 1000), solveTies);
}

class ParityTest : public GpuTest, public ::testing::WithParamInterface<std::string> {};

// What a family of solvers shares is tested by one of it where making kernels would take too long.
bool standsForOthers(ik::Solver solver) {
  using enum ik::Solver;
  return solver == fabrik || solver == ccd || solver == dampedLeastSquares || solver == stretchAlign ||
         solver == activeSet;
}

TEST_P(ParityTest, EverySolver) {
  // Mixed chains have these joints too.
  const bool few = GetParam() == "oblique" || GetParam() == "twist";
  uint64_t seed = 0;
  for (const ik::Solver solver : ik::allSolvers)
    if (++seed; !few || standsForOthers(solver)) compareSolver(device(), GetParam(), 5, solver, seed);
}

INSTANTIATE_TEST_SUITE_P(, ParityTest, ::testing::ValuesIn(limitKinds), [](const auto& param) {
  std::string name = param.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

using LengthTest = GpuTest;

TEST_F(LengthTest, ShortChains) {
  uint64_t seed = 100;
  for (const size_t joints : {2, 3})
    for (const ik::Solver solver : ik::allSolvers) {
      compareSolver(device(), "free", joints, solver, ++seed);
      if (standsForOthers(solver)) compareSolver(device(), "mixed", joints, solver, ++seed);
    }
}

TEST_F(LengthTest, LongFreeChains) {
  using enum ik::Solver;
  uint64_t seed = 200;
  for (const size_t joints : {10, 16})
    for (const ik::Solver solver : {fabrik, ccd, dampedLeastSquares, stretchAlign})
      compareSolver(device(), "free", joints, solver, ++seed);
}

TEST_F(LengthTest, LongLimitedChains) {
  using enum ik::Solver;
  uint64_t seed = 300;
  for (const ik::Solver solver : {fabrik, activeSet}) compareSolver(device(), "mixed", 10, solver, ++seed);
  compareSolver(device(), "mixed", 16, activeSet, ++seed);
}

// A target nearer on the line of a straight chain is reached by bending it first (docs/ik.md, Deadlock).
TEST_F(LengthTest, StraightChains) {
  using enum ik::Solver;
  const std::vector<glm::vec3> targets = {{0, 0.9f, 0}, {0, 0.6f, 0}, {0, 0.2f, 0}, {0, 0.9995f, 0}};
  for (const ik::Limit& limit :
       {ik::Limit(ik::Free{}), ik::Limit(ik::Cone{1}), ik::Limit(ik::Ellipse{0.8f, 1.1f, 0.9f, 1}),
        ik::Limit(ik::Hinge{{1, 0, 0}, -1.5f, 1.5f})})
    for (const ik::Solver solver : {fabrik, activeSet}) {
      const ik::Chain chain = evenChain(5, 0, limit);
      if (!isComparable(chain, solver)) continue;
      expectParity(runToward(device(), "straight", chain,
                             {.solver = solver, .iterations = 1, .restarts = false}, targets),
                   0);
    }
}

TEST_F(LengthTest, PulledToRest) {
  uint64_t seed = 700;
  for (const char* limits : {"hinge", "mixed"}) {
    Random random(++seed);
    const ik::Chain chain = randomChain(limits, 5, random);
    expectParity(
        randomRun(device(), limits, chain, chains, {.start = ik::Start::previous, .restPull = 0.05f}, seed),
        solveTies);
  }
}

// Nearly every chain is held to its target's pace, or left where it was.
TEST_F(LengthTest, HeldToTheTargetsPace) {
  using enum ik::Solver;
  uint64_t seed = 800;
  const auto compare = [&](const std::string& limits, size_t joints, ik::Solver solver) {
    Random random(++seed);
    const ik::Chain chain = randomChain(limits, joints, random);
    const validation::IkRun run =
        pacedRun(device(), limits, chain, chains, {.solver = solver, .iterations = 1}, seed);
    expectParity(run, iterationTies);
    const auto held = std::count_if(run.reports.begin(), run.reports.end(),
                                    [](const ik::Report& report) { return report.stop == ik::Stop::held; });
    EXPECT_GT(held, 16) << run.name;
  };
  for (const ik::Solver solver : {fabrik, ccd}) compare("free", 4, solver);
  for (const char* limits : {"cone", "mixed", "free-base"}) compare(limits, 4, ccd);
}

using StartTest = GpuLoadTest;

TEST_P(StartTest, FromRest) {
  uint64_t seed = 400;
  for (const char* limits : {"free", "mixed"}) {
    Random random(++seed);
    const ik::Chain chain = randomChain(limits, 4, random);
    expectParity(randomRun(device(), limits, chain, chains, {.iterations = 1, .restarts = false}, seed),
                 iterationTies);
    expectParity(randomRun(device(), limits, chain, chains, {}, seed), solveTies);
  }
}

TEST_P(StartTest, FromSeedsThatAreAimed) {
  Random random(450);
  const ik::Chain chain = randomChain("free-base", 4, random);
  expectParity(randomRun(device(), "free-base", chain, chains, {}, 450), solveTies);
}

TEST_P(StartTest, AboutBasesThatTurn) {
  uint64_t seed = 500;
  for (const char* limits : {"free", "mixed"}) {
    Random random(++seed);
    const ik::Chain chain = randomChain(limits, 4, random);
    expectParity(
        randomRun(device(), limits, chain, chains, {.start = ik::Start::previous, .bases = true}, seed),
        solveTies);
  }
}

TEST_P(StartTest, TowardAPole) {
  for (uint64_t seed = 601; seed < 604; ++seed) {
    Random random(seed);
    ik::Chain chain = randomChain("free", 4, random);
    chain.pole = randomDirection(random);
    expectParity(randomRun(device(), "pole", chain, chains, {.iterations = 1}, seed), iterationTies);
  }
}

INSTANTIATE_TEST_SUITE_P(, StartTest, bothLoadPaths(), loadPathName);

}  // namespace
}  // namespace skitter::test
