#include "cpu_reference/ik/solve.h"

#include <gtest/gtest.h>

#include <limits>

#include "cpu_reference/ik/pole.h"
#include "cpu_reference/ik/seeds.h"
#include "ik_chains.h"

// A whole solve: what it starts from, when it ends, what it says.
namespace skitter::test {
namespace {

using namespace reference;

constexpr IkSolver allSolvers[] = {
    IkSolver::fabrik,       IkSolver::dissertationKeep, IkSolver::dissertationEdge,
    IkSolver::ccd,          IkSolver::transpose,        IkSolver::pseudoinverse,
    IkSolver::dls,          IkSolver::targetAttached,   IkSolver::twoBone,
    IkSolver::stretchAlign, IkSolver::activeSet};

bool isFinite(const IkState& state) {
  for (const glm::dvec3& joint : state.joints) {
    if (!std::isfinite(joint.x + joint.y + joint.z)) return false;
  }
  for (size_t i = 0; i < state.pose.swing.size(); ++i) {
    if (!std::isfinite(state.pose.swing[i].x + state.pose.swing[i].y + state.pose.twist[i])) return false;
  }
  return true;
}

const std::vector<ChainSpec>& allSpecs() {
  static const std::vector<ChainSpec> specs{bentSpec(1),     bentSpec(2),    bentSpec(15), coneSpec(1, 1),
                                            coneSpec(15, 1), ellipseSpec(4), hingeSpec(1), hingeSpec(15),
                                            mixedSpec(),     ChainSpec(5),   ChainSpec(15)};
  return specs;
}

// Calls body(chain, spec, solver) for every solver and chain that go together.
template <typename Body>
void forAll(Body body) {
  for (const ChainSpec& spec : allSpecs()) {
    const IkChain chain = chainOf(spec);
    for (const IkSolver solver : allSolvers) {
      SCOPED_TRACE(testing::Message()
                   << "solver " << static_cast<int>(solver) << ", " << spec.size() << " bones");
      if (accepts(chain, solver)) body(chain, spec, solver);
    }
  }
}

TEST(IkSolve, strangeTargetsLeaveLegalFinitePoses) {
  const glm::dvec3 targets[] = {{0, 0, 0},   {1e-9, 0, 0}, {0, 0, -0.5},  {0, 0, 0.5},    {1, 0, 0},
                                {0, 0, 1.2}, {0, -1e6, 0}, {1e-3, 0, -1}, {0.3, 0.3, 0.3}};
  forAll([&](const IkChain& chain, const ChainSpec& spec, IkSolver solver) {
    for (const glm::dvec3& target : targets) {
      const IkResult result = solve(chain, {.solver = solver}, target);
      ASSERT_TRUE(isFinite(result.state));
      ASSERT_LE(result.iterations, 64);
      ASSERT_LE(result.error, restState(chain).error(target) + 1e-12);
      if (solver == IkSolver::dissertationKeep || solver == IkSolver::dissertationEdge) continue;
      const Verdict verdict = judge(spec, result.state.joints, rotationsOf(chain, result.state));
      ASSERT_LE(verdict.stretch, 1e-12);
      ASSERT_LE(chain.free ? 0 : verdict.beyond, 1e-9);
    }
  });
}

TEST(IkSolve, targetThatIsNotFiniteIsSkipped) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  forAll([&](const IkChain& chain, const ChainSpec&, IkSolver solver) {
    for (const glm::dvec3& target : {glm::dvec3(std::nan(""), 0, 0), glm::dvec3(0, infinity, 0)}) {
      const IkResult result = solve(chain, {.solver = solver}, target);
      ASSERT_EQ(result.stop, IkStop::skipped);
      ASSERT_EQ(result.iterations, 0);
      ASSERT_EQ(result.state.joints, restState(chain).joints);
    }
  });
}

TEST(IkSolve, startWithinToleranceIsKept) {
  forAll([&](const IkChain& chain, const ChainSpec&, IkSolver solver) {
    const glm::dvec3 target = restState(chain).joints.back() + glm::dvec3(5e-4, 0, 0);
    const IkResult result = solve(chain, {.solver = solver}, target);
    ASSERT_EQ(result.stop, IkStop::tolerance);
    ASSERT_EQ(result.iterations, 0);
    ASSERT_EQ(result.state.joints, restState(chain).joints);
  });
}

// The best pose of the iterations made one by one is what a solve returns.
TEST(IkSolve, isItsIterations) {
  const glm::dvec3 target{0.2, 0.35, 0.3};
  forAll([&](const IkChain& chain, const ChainSpec&, IkSolver solver) {
    if (solver == IkSolver::activeSet || chain.bones.size() == 1) return;
    const IkSettings settings{.solver = solver, .iterations = 4};
    const IkResult result = solve(chain, settings, target);
    IkState state = restState(chain);
    if (chain.bones.size() >= 5 && chain.bones[0].direction() == chain.bones[1].direction())
      return;  // is bent first
    double best = state.error(target);
    for (int k = 0; k < result.iterations; ++k) {
      iterate(chain, settings, target, k, state);
      best = std::min(best, state.error(target));
    }
    ASSERT_EQ(result.error, best);
    ASSERT_EQ(result.state.error(target), best);
  });
}

TEST(IkSolve, capIsKept) {
  const ChainSpec spec = coneSpec(5, 1);
  const IkChain chain = chainOf(spec);
  for (const int cap : {0, 1, 2, 3}) {
    for (const IkSolver solver : {IkSolver::ccd, IkSolver::activeSet}) {
      const IkResult result = solve(chain, {.solver = solver, .iterations = cap}, {0.1, -0.4, 0.3});
      EXPECT_EQ(result.stop, IkStop::cap);
      EXPECT_EQ(result.iterations, cap);
    }
  }
}

TEST(IkSolve, straightChainsReachTargetsOnTheirLine) {
  for (const size_t bones : {2u, 5u, 15u}) {
    ChainSpec cones(bones), hinges(bones);
    for (size_t i = 0; i < bones; ++i) {
      cones[i].kind = LimitKind::cone;
      cones[i].cone = 1.5;
      hinges[i].kind = LimitKind::hinge;
      hinges[i].axis = {1, 0, 0};
      hinges[i].low = -1.5;
      hinges[i].high = 1.5;
    }
    for (const ChainSpec& spec : {ChainSpec(bones), cones, hinges}) {
      const IkChain chain = chainOf(spec);
      for (const IkSolver solver : {IkSolver::fabrik, IkSolver::dls, IkSolver::twoBone,
                                    IkSolver::stretchAlign, IkSolver::activeSet}) {
        // FABRIK bends the last joints alone, up to their limits.
        if (!accepts(chain, solver) || (solver == IkSolver::fabrik && !chain.free)) continue;
        const IkResult result = solve(chain, {.solver = solver}, {0, 0, 0.8});
        EXPECT_LE(result.error, 1e-3) << "solver " << static_cast<int>(solver) << ", " << bones << " bones";
      }
    }
  }
}

TEST(IkSolve, freeChainsPointAtTargetsOutOfReach) {
  const IkChain chain = chainOf(bentSpec(6));
  const glm::dvec3 way = glm::normalize(glm::dvec3(1, 2, -1));
  for (const IkSolver solver : {IkSolver::fabrik, IkSolver::ccd, IkSolver::dls, IkSolver::stretchAlign}) {
    const IkResult far = solve(chain, {.solver = solver}, 1.5 * way),
                   near = solve(chain, {.solver = solver}, 1.0005 * way);
    EXPECT_EQ(far.stop, IkStop::unreachable);
    EXPECT_EQ(near.stop, IkStop::tolerance);
    EXPECT_EQ(far.iterations, 1);
    EXPECT_NEAR(far.error, 0.5, 1e-12);
    for (const glm::dvec3& u : directionsOf(far.state.joints)) EXPECT_NEAR(glm::length(u - way), 0, 1e-12);
  }
}

TEST(IkSolve, limitedChainsComeAsNearAsTheyCan) {
  IkChain chain = chainOf(coneSpec(6, 80 * degree));
  chain.seeds = makeSeeds(chain, 1);
  for (const bool restarts : {false, true}) {
    const IkResult result = solve(chain, {.solver = IkSolver::activeSet, .restarts = restarts}, {0, 1.3, 0});
    EXPECT_EQ(result.stop, IkStop::unreachable);
    EXPECT_NEAR(result.error, 0.3, 1e-3);
  }
}

TEST(IkSolve, whatCannotBeReachedStalls) {
  ChainSpec spec = bentSpec(3);
  spec[0].length = 4;
  for (const IkSolver solver : {IkSolver::fabrik, IkSolver::stretchAlign}) {
    const IkResult result = solve(chainOf(spec), {.solver = solver, .iterations = 1000}, {0, 0, 0.1});
    EXPECT_EQ(result.stop, IkStop::stall) << static_cast<int>(solver);
    EXPECT_LT(result.iterations, 1000);
  }
  const IkResult limited = solve(chainOf(coneSpec(4, 0.2)), {.solver = IkSolver::activeSet}, {-0.5, 0, 0});
  EXPECT_EQ(limited.stop, IkStop::stall);
}

TEST(IkSolve, bonesWithoutLengthDoNotMatter) {
  for (const ChainSpec& plain : {bentSpec(4), coneSpec(4, 1.2), ellipseSpec(4), hingeSpec(4), mixedSpec()}) {
    ChainSpec padded = plain;
    BoneSpec none;
    none.length = 0;
    none.direction = {0.3, 1, 0.2};
    padded.insert(padded.begin() + 2, none);
    padded.push_back(none);
    padded.insert(padded.begin(), none);
    const IkChain a = chainOf(plain), b = chainOf(padded);
    std::mt19937_64 random(21);
    for (const IkSolver solver : allSolvers) {
      if (!accepts(a, solver) || !accepts(b, solver)) continue;
      // A cone told from the one bone before it alone is another cone where a bone comes between.
      if (solver == IkSolver::dissertationKeep || solver == IkSolver::dissertationEdge) continue;
      for (int trial = 0; trial < 20; ++trial) {
        const glm::dvec3 target = randomPoint(random, 0.2, 0.9);
        const IkResult x = solve(a, {.solver = solver, .iterations = 6}, target);
        const IkResult y = solve(b, {.solver = solver, .iterations = 6}, target);
        ASSERT_NEAR(glm::length(x.state.joints.back() - y.state.joints.back()), 0, 1e-7)
            << static_cast<int>(solver);
        ASSERT_EQ(x.iterations, y.iterations);
        ASSERT_TRUE(b.free || y.state.pose.swing[0] == glm::dvec2(0));
      }
    }
  }
}

TEST(IkSolve, refusesChainsThatTheSolverIsNotFor) {
  const IkChain free = chainOf(bentSpec(3)), two = chainOf(bentSpec(2)), cones = chainOf(coneSpec(2, 1));
  const IkChain hinges = chainOf(hingeSpec(3)), mixed = chainOf(mixedSpec());
  EXPECT_FALSE(accepts(free, IkSolver::activeSet));
  EXPECT_FALSE(accepts(free, IkSolver::twoBone));
  EXPECT_TRUE(accepts(two, IkSolver::twoBone));
  EXPECT_FALSE(accepts(cones, IkSolver::twoBone));
  EXPECT_FALSE(accepts(cones, IkSolver::stretchAlign));
  EXPECT_TRUE(accepts(cones, IkSolver::dissertationEdge));
  EXPECT_TRUE(accepts(free, IkSolver::dissertationEdge));
  EXPECT_FALSE(accepts(hinges, IkSolver::dissertationKeep));
  EXPECT_FALSE(accepts(mixed, IkSolver::dissertationEdge));
  EXPECT_THROW(solve(free, {.solver = IkSolver::activeSet}, {0, 0, 0.5}), std::invalid_argument);
}

TEST(IkSolve, startPoseIsClampedFirst) {
  const ChainSpec spec = mixedSpec();
  const IkChain chain = chainOf(spec);
  IkState wild = restState(chain);
  for (glm::dvec2& swing : wild.pose.swing) swing = {5, -7};
  IkMemory memory;
  const IkResult result = solveIk(chain, {.iterations = 0}, {0.1, 0.2, 0.3}, wild, memory);
  EXPECT_LE(judge(spec, result.state.joints, rotationsOf(chain, result.state)).beyond, 1e-9);
}

TEST(IkSeeds, areLegalFarApartAndTheSameAgain) {
  for (const ChainSpec& spec : {coneSpec(4, 1.5), ellipseSpec(9), hingeSpec(4), mixedSpec()}) {
    const IkChain chain = chainOf(spec);
    const auto seeds = makeSeeds(chain, 5), again = makeSeeds(chain, 5), few = makeSeeds(chain, 5, 7);
    EXPECT_EQ(seeds.size(), 64u);
    EXPECT_EQ(few.size(), 7u);
    std::vector<glm::dvec3> tips;
    for (size_t s = 0; s < seeds.size(); ++s) {
      EXPECT_EQ(seeds[s].swing, again[s].swing);
      const IkState state = stateAt(chain, seeds[s]);
      EXPECT_LE(judge(spec, state.joints, rotationsOf(chain, state)).beyond, 1e-9);
      // Seeds that are aimed differ only by the distance of their tip from the base.
      const bool shapes = aimsSeeds(chain);
      const glm::dvec3 own = state.joints.back();
      const glm::dvec3 compared = shapes ? glm::dvec3(glm::length(own), 0, 0) : own;
      for (const glm::dvec3& tip : tips) EXPECT_GT(glm::length(tip - compared), shapes ? 0.005 : 0.01);
      tips.push_back(compared);
      if (shapes) {
        EXPECT_EQ(seeds[s].swing[0], glm::dvec2(0));
      }
    }
  }
}

TEST(IkSeeds, thatAreAimedPointAtTheTarget) {
  const ChainSpec spec = hingeSpec(5);
  const IkChain chain = chainOf(spec);
  ASSERT_TRUE(aimsSeeds(chain));
  IkRandom random(9);
  int exact = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    const IkState start = stateAt(chain, randomLegalPose(chain.bones, random));
    const glm::dvec3 target = stateAt(chain, randomLegalPose(chain.bones, random)).joints.back();
    const IkState turned = aimed(chain, start, target);
    EXPECT_LE(judge(spec, turned.joints, rotationsOf(chain, turned)).beyond, 1e-9);
    for (size_t i = 1; i < start.joints.size(); ++i)
      EXPECT_NEAR(glm::length(turned.joints[i]), glm::length(start.joints[i]), 1e-12);
    const double least = std::abs(glm::length(start.joints.back()) - glm::length(target));
    exact += turned.error(target) <= least + 1e-9;
  }
  EXPECT_EQ(exact, 1000) << "a free ball turns to wherever";
}

// Shares of 1000 tips of legal poses.
struct Share {
  int solved = 0, iterations = 0;
};
Share shareOf(const IkChain& chain, const IkSettings& settings) {
  IkRandom random(31);
  Share share;
  for (int trial = 0; trial < 1000; ++trial) {
    const glm::dvec3 target = stateAt(chain, randomLegalPose(chain.bones, random)).joints.back();
    const IkResult result = solve(chain, settings, target);
    share.iterations += result.iterations;
    if (result.error <= 1e-3) ++share.solved;
  }
  return share;
}

TEST(IkRestarts, leaveTheLocalMinimaOfHinges) {
  IkChain chain = chainOf(hingeSpec(4));
  EXPECT_LT(shareOf(chain, {}).solved, 980);
  chain.seeds = makeSeeds(chain, 7);
  EXPECT_LT(shareOf(chain, {.restarts = false}).solved, 980);
  const Share share = shareOf(chain, {});
  EXPECT_GE(share.solved, 998);
  EXPECT_LE(share.iterations, 5300);  // soon: an attempt that gets nowhere is given up at once
}

TEST(IkRestarts, pauseLongerAndLongerAfterAttemptsInVain) {
  IkChain chain = chainOf(coneSpec(4, 0.5));
  chain.seeds = makeSeeds(chain, 7);
  IkState state = restState(chain);
  IkMemory memory;
  std::vector<int> restarted;  // the solves that try seeds
  for (int tick = 0; tick < 120; ++tick) {
    const int before = memory.pause + memory.nextPause;
    const IkResult result = solveIk(chain, {.continues = true}, {-1.2, 0, 0}, state, memory);
    if (memory.pause + memory.nextPause > before) restarted.push_back(tick);
    state = result.state;
  }
  EXPECT_EQ(restarted, (std::vector{0, 1, 3, 6, 11, 20, 37, 70, 103}));
}

// A target that comes back to the limit of what can be reached must not make the chain jump from seed to
// seed.
TEST(IkRestarts, outOfReachTheChainStaysWhereItIs) {
  IkChain chain = chainOf(coneSpec(4, 0.6));
  chain.seeds = makeSeeds(chain, 7);
  IkState state = restState(chain);
  IkMemory memory;
  for (int tick = 0; tick < 400; ++tick) {
    const double angle = 0.005 * tick;
    const glm::dvec3 target{1.2 * std::cos(angle), 1.2 * std::sin(angle), 0.2};
    const IkResult result = solveIk(chain, {.iterations = 16, .continues = true}, target, state, memory);
    for (size_t i = 0; i < state.joints.size() && tick > 0; ++i) {
      ASSERT_LE(glm::length(result.state.joints[i] - state.joints[i]), 0.05) << "tick " << tick;
    }
    state = result.state;
  }
}

TEST(IkSolve, dampingCarriesOverToASolveThatContinues) {
  const IkChain chain = chainOf(coneSpec(4, 1));
  IkState start = restState(chain);
  const glm::dvec3 target = start.joints.back() + glm::dvec3(0.1, 0.1, 0.1);
  start.damping = 4096;
  IkMemory memory;
  const double anew = solveIk(chain, {.iterations = 1}, target, start, memory).error;
  const IkResult damped = solveIk(chain, {.iterations = 1, .continues = true}, target, start, memory);
  EXPECT_LT(anew, 0.5 * damped.error);
  EXPECT_NEAR(damped.state.damping, 409.6, 1e-9);
}

struct Track {
  int ticks = 0, within = 0;
  int leaps = 0;  // a joint moved more than 4 times as far as the target
};

// The target goes along the tips of poses between random ones, 2 % of the length a tick, 3 iterations a tick.
Track track(const IkChain& chain, int ticks) {
  IkRandom random(32);
  IkState state = stateAt(chain, randomLegalPose(chain.bones, random));
  IkMemory memory;
  Pose from = state.pose;
  glm::dvec3 last = state.joints.back();
  Track result;
  while (result.ticks < ticks) {
    const Pose to = randomLegalPose(chain.bones, random);
    for (double t = 0; t < 1; t += 1e-3) {
      Pose between = from;
      for (size_t i = 0; i < chain.bones.size(); ++i)
        between.swing[i] = glm::mix(from.swing[i], to.swing[i], t);
      const glm::dvec3 target = stateAt(chain, between).joints.back();
      if (glm::length(target - last) < 0.02) continue;
      const IkResult solved = solveIk(chain, {.iterations = 3, .continues = true}, target, state, memory);
      double motion = 0;
      for (size_t i = 0; i < state.joints.size(); ++i) {
        motion = std::max(motion, glm::length(solved.state.joints[i] - state.joints[i]));
      }
      if (motion > 4 * glm::length(target - last)) ++result.leaps;
      state = solved.state;
      last = target;
      ++result.ticks;
      if (solved.error <= 1e-3) ++result.within;
    }
    from = to;
  }
  return result;
}

TEST(IkSolve, threeIterationsATickTrackAMovingTarget) {
  for (const ChainSpec& spec : {coneSpec(4, 90 * degree), coneSpec(9, 60 * degree), ellipseSpec(4)}) {
    IkChain chain = chainOf(spec);
    chain.seeds = makeSeeds(chain, 7);
    const Track result = track(chain, 1000);
    EXPECT_GE(result.within, result.ticks - 1);
    EXPECT_LE(result.leaps, 2);
  }
}

TEST(IkPole, freeChainsBendTowardIt) {
  std::mt19937_64 random(33);
  for (int trial = 0; trial < 200; ++trial) {
    const glm::dvec3 pole = randomPoint(random, 1, 1), target = randomPoint(random, 0.3, 0.9);
    const IkChain plain = chainOf(bentSpec(5)), chain = chainOf(bentSpec(5), pole);
    for (const IkSolver solver : {IkSolver::fabrik, IkSolver::stretchAlign, IkSolver::ccd}) {
      const IkResult without = solve(plain, {.solver = solver}, target),
                     with = solve(chain, {.solver = solver}, target);
      ASSERT_NEAR(with.error, without.error, 1e-9);
      ASSERT_LE(
          judge(bentSpec(5), with.state.joints, reference::rotationsOf(chain, with.state.joints)).stretch,
          1e-12);
      // As far as it can: no turn about the line brings more.
      const double bend = bendToward(pole, with.state.joints);
      ASSERT_GE(bend, bendToward(pole, without.state.joints) - 1e-12);
      const glm::dvec3 line = glm::normalize(with.state.joints.back());
      const glm::dvec3 across = glm::normalize(pole - line * glm::dot(pole, line));
      glm::dvec3 sum(0);
      for (const glm::dvec3& joint : with.state.joints) sum += joint - line * glm::dot(joint, line);
      ASSERT_NEAR(bend, glm::length(sum) * glm::dot(across, pole), 1e-9);
    }
  }
}

TEST(IkPole, limitedChainsStartOnItsSide) {
  const glm::dvec3 pole{0, 0, 1};
  ChainSpec spec(4);
  for (BoneSpec& bone : spec) {
    bone.direction = {1, 0, 0};
    bone.kind = LimitKind::cone;
    bone.cone = 1.2;
  }
  IkChain chain = chainOf(spec, pole);
  chain.seeds = makeSeeds(chain, 7);
  IkRandom random(34);
  int away = 0, kept = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const IkState start = stateAt(chain, randomLegalPose(chain.bones, random));
    if (bendToward(pole, start.joints) > -0.1) continue;
    const glm::dvec3 target = 0.7 * glm::dvec3(std::cos(0.003 * trial), std::sin(0.003 * trial), 0);
    IkMemory memory;
    const IkResult result = solveIk(chain, {}, target, start, memory);
    EXPECT_LE(result.error, 1e-3);
    ++away;
    if (bendToward(pole, result.state.joints) > -1e-3) ++kept;
  }
  EXPECT_GT(away, 20);
  EXPECT_GE(kept, away * 9 / 10) << kept << " of " << away;
}

}  // namespace
}  // namespace skitter::test
