// Targets, chains and sizes at the edge of what there may be.
#include <cmath>
#include <limits>

#include "gpu/buffer.h"
#include "gpu/submit.h"
#include "gpu/transfer.h"
#include "ik/chains.h"
#include "ik/solved.h"
#include "skitter/error.h"
#include "support/gpu_fixture.h"
#include "validation/convert_ik.h"

namespace skitter::test {
namespace {

using glm::vec3;

constexpr float nan = std::numeric_limits<float>::quiet_NaN(),
                infinite = std::numeric_limits<float>::infinity();
const ik::Limit wide = ik::Cone{1.2f};

std::vector<vec3> targetsIn(double radius, size_t count, uint64_t seed) {
  Random random(seed);
  std::vector<vec3> targets;
  for (size_t c = 0; c < count; ++c)
    targets.emplace_back(uniform(random, 0.2, radius) * randomDirection(random));
  return targets;
}

std::vector<vec3> edgeTargets(const ik::Chain& chain, size_t count, Random& random) {
  const reference::IkChain expected = validation::referenceOf(chain);
  std::vector<vec3> targets;
  for (size_t c = 0; c < count; ++c) targets.emplace_back(expected.length * legalTarget(expected, random));
  return targets;
}

ik::Chain stretched(ik::Chain chain, float by) {
  for (ik::Bone& bone : chain.bones) bone.length *= by;
  return chain;
}

bool takes(const ik::Chain& chain, ik::Solver solver) {
  return solver == ik::Solver::automatic ||
         accepts(validation::referenceOf(chain), validation::referenceOf(solver));
}

void expectSame(const Solved& a, const Solved& b) {
  EXPECT_EQ(a.joint, b.joint);
  ASSERT_EQ(a.report.size(), b.report.size());
  for (size_t c = 0; c < a.report.size(); ++c) {
    EXPECT_EQ(a.report[c].error, b.report[c].error) << c;
    EXPECT_EQ(a.report[c].iterations, b.report[c].iterations) << c;
    EXPECT_EQ(a.report[c].stop, b.report[c].stop) << c;
  }
}

using TargetTest = GpuTest;

TEST_F(TargetTest, OnTheLineOfAStraightChain) {
  for (const ik::Limit& limit : {ik::Limit(ik::Free{}), wide, ik::Limit(ik::Hinge{{1, 0, 0}, -1.5f, 1.5f})}) {
    const ik::Chain chain = evenChain(5, 0, limit);
    const std::vector<vec3> targets = {{0, 0.9f, 0}, {0, 0.6f, 0}, {0, 0.99f, 0}};
    const Solved solved = solve(device(), chain, {}, targets);
    expectSound(chain, solved);
    for (size_t c = 0; c < targets.size(); ++c) EXPECT_LE(solved.report[c].error, 1e-3) << c;
  }
}

// Beyond the tip of a straight chain no step gains anything, so the fourth is the last.
TEST_F(TargetTest, IdleStepsEndASolve) {
  const ik::Chain chain = evenChain(5, 0, wide);
  const Solved solved =
      solve(device(), chain, {.iterations = 12, .restarts = false}, {{0, 1.5f, 0}, {0, 3, 0}});
  for (const ik::Report& report : solved.report) {
    EXPECT_EQ(report.stop, ik::Stop::unreachable);
    EXPECT_EQ(report.iterations, 4u);
  }
}

TEST_F(TargetTest, AtTheBase) {
  for (const ik::Limit& limit : {ik::Limit(ik::Free{}), wide})
    for (const ik::Solver solver : ik::allSolvers) {
      const ik::Chain chain = evenChain(4, 0, limit);
      if (!takes(chain, solver) || solver == ik::Solver::dissertationKeep) continue;
      SCOPED_TRACE(ik::nameOf(solver));
      const Solved solved = solve(device(), chain, {.solver = solver}, {vec3(0), vec3(1e-7f)});
      for (const vec3& p : solved.joint) ASSERT_TRUE(std::isfinite(p.x + p.y + p.z));
      // The dissertation's cones are those of its own constraint points.
      if (solver != ik::Solver::dissertationEdge) expectSound(chain, solved);
    }
}

TEST_F(TargetTest, BeyondReachAFreeChainIsStraight) {
  const ik::Chain chain = evenChain(5, 0.4);
  for (const ik::Solver solver :
       {ik::Solver::stretchAlign, ik::Solver::fabrik, ik::Solver::dampedLeastSquares}) {
    const Solved solved =
        solve(device(), chain, {.solver = solver}, {{0, 0, 1.5f}, {-2, 0, 0}, {0, 1.0005f, 0}});
    expectSound(chain, solved);
    EXPECT_EQ(solved.report[0].stop, ik::Stop::unreachable);
    EXPECT_EQ(solved.report[2].stop, ik::Stop::tolerance);
    EXPECT_EQ(solved.report[1].iterations, 1u);
    for (size_t i = 0; i < 5; ++i)
      EXPECT_LE(glm::length(solved.chain(1)[i] - vec3(-0.25f * static_cast<float>(i), 0, 0)), 1e-6f);
  }
}

// The target is so far that its square is no number.
TEST_F(TargetTest, AnywhereBeyondReachAFreeChainPointsThere) {
  const ik::Chain chain = evenChain(5, 0.4);
  for (int axis = 0; axis < 3; ++axis)
    for (const float far : {-1e30f, 1e30f}) {
      vec3 target(0), tip(0);
      target[axis] = far;
      tip[axis] = std::copysign(1.0f, far);
      const Solved solved = solve(device(), chain, {.solver = ik::Solver::stretchAlign}, {target});
      EXPECT_EQ(solved.report[0].stop, ik::Stop::unreachable);
      EXPECT_LE(glm::length(solved.chain(0)[4] - tip), 1e-6f) << axis << ", " << far;
    }
}

TEST_F(TargetTest, BeyondReachALimitedChainIsLegalAndNear) {
  // Straight chains turned about their base are legal: half the reach is left.
  const ik::Chain chain = evenChain(5, 0, wide);
  const float c = std::cos(0.5f), s = std::sin(0.5f);
  const Solved solved =
      solve(device(), chain, {}, {{0, 1.5f, 0}, {1.5f * s, 1.5f * c, 0}, {0, 1.5f * c, 1.5f * s}});
  expectSound(chain, solved);
  for (const ik::Report& report : solved.report) {
    EXPECT_EQ(report.stop, ik::Stop::unreachable);
    EXPECT_NEAR(report.error, 0.5, 5e-3);
  }
}

TEST_F(TargetTest, NotFiniteKeepsThePoseToTheBit) {
  const std::vector<vec3> bad = {{nan, 0, 0}, {0, infinite, 0}, {0, 0, -infinite}};
  for (const ik::Limit& limit : {ik::Limit(ik::Free{}), wide}) {
    Random random(1);
    const ik::Chain chain = stretched(evenChain(5, 0.4, limit), 1.7f);
    ik::Batch batch(device(), chain, 3, {.start = ik::Start::previous, .iterations = 64});
    batch.setTargets(edgeTargets(chain, 3, random));
    batch.solve();
    const std::vector<glm::vec4> before = batch.downloadStates();
    const Solved seen = resultOf(batch);
    batch.setTargets(bad);
    for (int tick = 0; tick < 5; ++tick) batch.solve();
    EXPECT_EQ(before, batch.downloadStates());
    const Solved after = resultOf(batch);
    for (size_t i = 0; i < seen.joint.size(); ++i)
      EXPECT_LE(glm::length(after.joint[i] - seen.joint[i]), 1e-6f);
    for (const ik::Report& report : after.report) {
      EXPECT_EQ(report.stop, ik::Stop::skipped);
      EXPECT_EQ(report.error, 0);
      EXPECT_EQ(report.iterations, 0u);
    }
    // And nothing of it stays: the next solve arrives.
    batch.setTargets(edgeTargets(chain, 3, random));
    batch.solve();
    for (const ik::Report& report : batch.downloadReports()) EXPECT_LE(report.error, 1e-3);
  }
}

using ChainTest = GpuTest;

TEST_F(ChainTest, BonesWithoutLengthDoNotMatter) {
  for (const char* limits : {"free", "cone"}) {
    Random random(5);
    const ik::Chain plain = randomChain(limits, 4, random);
    ik::Chain padded = plain;
    for (const size_t at : {3, 1, 0})
      padded.bones.insert(padded.bones.begin() + static_cast<ptrdiff_t>(at),
                          {.direction = {0, 0, 1}, .limit = wide});
    if (std::string(limits) == "free")
      for (ik::Bone& bone : padded.bones) bone.limit = ik::Free{};
    const std::vector<vec3> targets = edgeTargets(plain, 32, random);
    for (const ik::Solver solver : {ik::Solver::automatic, ik::Solver::fabrik}) {
      const ik::Options options{.solver = solver, .iterations = 3, .restarts = false};
      const Solved a = solve(device(), plain, options, targets),
                   b = solve(device(), padded, options, targets);
      for (size_t c = 0; c < targets.size(); ++c)
        EXPECT_NEAR(a.report[c].error, b.report[c].error, 2e-4) << limits;
      expectSound(padded, b);
    }
  }
}

TEST_F(ChainTest, FromTwoJointsToSixteen) {
  for (const ik::Limit& limit : {ik::Limit(ik::Free{}), wide})
    for (const size_t joints : {2, 16}) {
      const ik::Chain chain = evenChain(joints, 0.3, limit);
      Random random(7);
      const std::vector<vec3> targets = edgeTargets(chain, 64, random);
      const Solved solved = solve(device(), chain, {}, targets);
      expectSound(chain, solved);
      for (const ik::Report& report : solved.report) EXPECT_LE(report.error, 1e-3) << joints;
    }
}

TEST_F(ChainTest, TwoBonesOfFabrikAreTheClosedForm) {
  const ik::Chain chain = evenChain(3, 0.8);
  const std::vector<vec3> targets = targetsIn(0.95, 64, 3);
  const Solved closed = solve(device(), chain, {.solver = ik::Solver::twoBone}, targets);
  const Solved fabrik =
      solve(device(), chain, {.solver = ik::Solver::fabrik, .tolerance = 1e-6f, .iterations = 2000}, targets);
  for (size_t i = 0; i < closed.joint.size(); ++i)
    EXPECT_LE(glm::length(closed.joint[i] - fabrik.joint[i]), 1e-3f) << i / 3;
  for (const ik::Report& report : closed.report) EXPECT_LE(report.error, 2e-6);
}

TEST_F(ChainTest, TheDissertationsRulesDiffer) {
  const ik::Chain chain = evenChain(5, 0.3, ik::Cone{0.5f});
  const std::vector<vec3> targets = targetsIn(0.9, 256, 4);
  const validation::IkJudge by = validation::judgeOf(chain);
  const auto worst = [&](ik::Solver solver) {
    const Solved solved = solve(device(), chain, {.solver = solver}, targets);
    double error = 0;
    for (size_t c = 0; c < targets.size(); ++c)
      error = std::max(error, judge(by, solved, c, targets[c]).boneLengthError);
    return error;
  };
  EXPECT_GT(worst(ik::Solver::dissertationKeep), 0.01);
  EXPECT_LE(worst(ik::Solver::dissertationEdge), 1e-5);
}

TEST_F(ChainTest, ForwardKinematicsOfTheRotationsGiveTheJoints) {
  for (const char* limits : {"free", "free-base", "mixed"}) {
    Random random(11);
    const ik::Chain chain = randomChain(limits, 5, random);
    const reference::IkChain expected = validation::referenceOf(chain);
    const std::vector<vec3> targets = edgeTargets(chain, 32, random);
    const Solved solved = solve(device(), chain, {.rotations = true}, targets);
    for (size_t c = 0; c < targets.size(); ++c) {
      glm::dvec3 p(0);
      for (size_t i = 0; i < 4; ++i) {
        const ik::Bone& bone = chain.bones[i];
        p +=
            glm::dquat(solved.rotation[c * 4 + i]) * glm::dvec3(bone.length * glm::normalize(bone.direction));
        EXPECT_LE(glm::length(p - glm::dvec3(solved.chain(c)[i + 1])) / expected.length, 1e-5) << limits;
      }
    }
    expectSound(chain, solved);
  }
}

TEST_F(ChainTest, APullBringsChainsOnTargetBackToRest) {
  constexpr uint32_t chains = 32;
  const ik::Chain chain = evenChain(6, 0.2, wide);
  const reference::IkChain expected = validation::referenceOf(chain);
  ik::Batch batch(device(), chain, chains, {.start = ik::Start::previous, .restPull = 0.1f});
  Random random(15);
  std::vector<vec3> targets;
  std::vector<glm::vec4> states;
  for (uint32_t c = 0; c < chains; ++c) {
    const reference::IkState state = randomState(expected, random);
    validation::append(expected, validation::IkLayout(expected, reference::IkSolver::activeSet), state,
                       states);
    targets.emplace_back(state.joints.back());
  }
  const auto bent = [&] {
    double sum = 0;
    for (const glm::vec4& two : batch.downloadStates()) sum += glm::dot(two, two);
    return sum;
  };
  batch.setTargets(targets);
  batch.setStates(states);
  const double before = bent();
  for (int tick = 0; tick < 100; ++tick) batch.solve();
  EXPECT_LT(bent(), 0.95 * before);
  for (const ik::Report& report : batch.downloadReports()) EXPECT_LE(report.error, 1e-3);
}

using BatchTest = GpuLoadTest;

TEST_P(BatchTest, AnyNumberOfChains) {
  const ik::Chain chain = evenChain(5, 0.4);
  for (const uint32_t chains : {0u, 1u, 63u, 64u, 65u}) {
    const Solved solved = solve(device(), chain, {}, targetsIn(0.95, chains, 1));
    EXPECT_EQ(solved.report.size(), chains);
    for (const ik::Report& report : solved.report) EXPECT_LE(report.error, 1e-3);
  }
}

TEST_P(BatchTest, SameInputGivesSameBits) {
  for (const char* limits : {"free", "mixed"}) {
    Random random(3);
    const ik::Chain chain = randomChain(limits, 4, random);
    const std::vector<vec3> targets = targetsIn(1.8, 300, 9);
    expectSame(solve(device(), chain, {}, targets), solve(device(), chain, {}, targets));
  }
}

TEST_P(BatchTest, PagesDoNotMatter) {
  for (const char* limits : {"free", "mixed"}) {
    Random random(3);
    const ik::Chain chain = randomChain(limits, 4, random);
    const std::vector<vec3> targets = targetsIn(1.8, 300, 9);
    expectSame(solve(device(), chain, {}, targets), solve(device(), chain, {.pageChains = 64}, targets));
    const ik::Batch paged(device(), chain, 300, {.pageChains = 64});
    EXPECT_EQ(paged.pages(), 5u);
    EXPECT_EQ(paged.pageChains(), 64u);
  }
}

TEST_P(BatchTest, JointsGivenAboutTurnedBasesAreWhereTheyWere) {
  for (const char* limits : {"free", "cone"}) {
    Random random(6);
    const ik::Chain chain = randomChain(limits, 5, random);
    std::vector<ik::Base> bases;
    for (size_t c = 0; c < 64; ++c)
      bases.push_back(
          {3.0 * randomDirection(random), glm::normalize(glm::quat(1, vec3(2.0 * randomDirection(random))))});
    ik::Batch batch(device(), chain, 64, {.start = ik::Start::previous, .bases = true});
    batch.setBases(bases);
    // A target that is not finite keeps the pose, so what is written is what was given.
    batch.setTargets(std::vector<vec3>(64, vec3(NAN)));
    batch.solve();
    const std::vector<vec3> given = batch.downloadJoints();
    batch.setJoints(given);
    batch.solve();
    const std::vector<vec3> got = batch.downloadJoints();
    for (size_t j = 0; j < given.size(); ++j)
      // A dozen roundings of world coordinates below 8.
      EXPECT_LT(glm::length(got[j] - given[j]), 12 * 8 * 6e-8f * 4) << limits << ", chain " << j / 5;
  }
}

TEST_P(BatchTest, MovedBasesCarryTheirChains) {
  for (const char* limits : {"free", "mixed"}) {
    Random random(4);
    const ik::Chain chain = randomChain(limits, 4, random);
    const std::vector<vec3> targets = targetsIn(1.5, 64, 5);
    ik::Batch batch(device(), chain, 64, {.bases = true, .rotations = true});
    std::vector<vec3> moved;
    std::vector<ik::Base> bases;
    for (const vec3& target : targets) {
      const ik::Base base{3.0 * randomDirection(random),
                          glm::normalize(glm::quat(1, vec3(2.0 * randomDirection(random))))};
      bases.push_back(base);
      moved.push_back(base.position + base.rotation * target);
    }
    batch.setBases(bases);
    batch.setTargets(moved);
    batch.solve();
    const Solved there = resultOf(batch, true), here = solve(device(), chain, {.rotations = true}, targets);
    size_t apart = 0;  // a tie may go the other way
    for (size_t c = 0; c < 64; ++c)
      for (size_t j = 0; j < 4; ++j) {
        const vec3 expected = bases[c].position + bases[c].rotation * here.chain(c)[j];
        apart += glm::length(there.chain(c)[j] - expected) > 5e-4f;
        if (j < 3)
          apart += std::abs(glm::dot(there.rotation[c * 3 + j],
                                     bases[c].rotation * here.rotation[c * 3 + j])) < 0.999f;
      }
    EXPECT_LE(apart, 6u) << limits;
  }
}

TEST_P(BatchTest, TheCallersBuffersAndCommands) {
  const ik::Chain chain = evenChain(5, 0.4, wide);
  const std::vector<vec3> targets = targetsIn(0.9, 100, 6);
  const Solved expected = solve(device(), chain, {}, targets);
  std::vector<glm::vec4> records;
  for (const vec3& target : targets) records.emplace_back(target, 0);
  const gpu::Buffer target(context(), 1600, "targets"), joint(context(), 6400, "joints"),
      report(context(), 1600, "reports");
  gpu::upload(context(), target, records);
  ik::Batch batch(device(), chain, 100);
  const auto span = [](const gpu::Buffer& buffer) { return ik::Span{buffer.handle(), buffer.size()}; };
  batch.use({.targets = span(target),
             .bases = {},
             .joints = span(joint),
             .rotations = {},
             .reports = span(report)});
  gpu::submitAndWait(context(), [&](vk::CommandBuffer cmd) { batch.record(cmd); });
  expectSame(expected, resultOf(batch));
  const auto joints = gpu::download<glm::vec4>(context(), joint);
  for (size_t c = 0; c < 100; ++c) EXPECT_EQ(vec3(joints[c * 4 + 3]), expected.chain(c)[4]);
  EXPECT_THROW(
      batch.use(
          {.targets = {target.handle(), 16}, .bases = {}, .joints = {}, .rotations = {}, .reports = {}}),
      Error);
  // One chain short.
  EXPECT_THROW(batch.use({.targets = {target.handle(), 1584}}), Error);
  EXPECT_THROW(batch.use({.joints = {joint.handle(), 6384}}), Error);
  EXPECT_THROW(batch.use({.reports = {report.handle(), 1584}}), Error);
  ik::Batch paged(device(), chain, 100, {.pageChains = 64});
  EXPECT_THROW(paged.use({}), Error);
}

INSTANTIATE_TEST_SUITE_P(, BatchTest, bothLoadPaths(), loadPathName);

using ManyTest = GpuTest;

TEST_F(ManyTest, AMillionChains) {
  const std::vector<vec3> targets = targetsIn(0.95, 1000000, 8);
  const Solved solved = solve(device(), evenChain(5, 0.4), {}, targets);
  size_t missed = 0;
  for (size_t c = 0; c < targets.size(); ++c)
    missed += !(glm::length(solved.chain(c)[4] - targets[c]) <= 1e-3f);
  EXPECT_EQ(missed, 0u);
}

using RefusalTest = GpuTest;

TEST_F(RefusalTest, OfChainsNamesBoneAndFault) {
  const auto refusal = [](auto change) {
    ik::Chain chain = evenChain(4, 0.4, wide);
    change(chain);
    try {
      ik::check(chain);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  const auto expect = [&](const char* words, auto change) {
    const std::string message = refusal(change);
    EXPECT_NE(message.find(words), std::string::npos) << message;
  };
  const auto limited = [](ik::Limit limit) { return [limit](ik::Chain& c) { c.bones[1].limit = limit; }; };
  expect("0 bones", [](ik::Chain& c) { c.bones.clear(); });
  expect("16 bones", [](ik::Chain& c) { c.bones.resize(16, c.bones[0]); });
  expect("bone 1: its length", [](ik::Chain& c) { c.bones[1].length = -1; });
  expect("bone 2: its length", [](ik::Chain& c) { c.bones[2].length = nan; });
  expect("bone 0: its rest direction", [](ik::Chain& c) { c.bones[0].direction = vec3(0); });
  expect("bone 0: its rest direction", [](ik::Chain& c) { c.bones[0].direction.x = infinite; });
  expect("bone 1: its stiffness", [](ik::Chain& c) { c.bones[1].stiffness = -1; });
  expect("bone 1: its twist", [](ik::Chain& c) { c.bones[1].twistMin = 1; });
  expect("bone 1: its twist", [](ik::Chain& c) { c.bones[1].twistMax = 4; });
  expect("bone 1: a half-angle", limited(ik::Cone{0}));
  expect("bone 1: a half-angle", limited(ik::Cone{nan}));
  expect("bone 1: a half-angle", limited(ik::Ellipse{1, 1, -1, 1}));
  expect("bone 1: a half-angle", limited(ik::Ellipse{1, 1, 1, 3.2f}));
  expect("bone 1: its hinge has an axis without", limited(ik::Hinge{{0, 0, 0}, -1, 1}));
  expect("bone 1: its hinge's axis lies along", [](ik::Chain& c) {
    c.bones[1].limit = ik::Hinge{c.bones[1].direction, -1, 1};
  });
  expect("bone 1: its hinge goes", limited(ik::Hinge{{0, 0, 1}, 1, -1}));
  expect("bone 1: its hinge goes", limited(ik::Hinge{{0, 0, 1}, -3.2f, 1}));
  expect("bone 1: a hinge has no twist", [](ik::Chain& c) {
    c.bones[1].limit = ik::Hinge{{0, 0, 1}, -1, 1};
    c.bones[1].twistMax = 1;
  });
  expect("lengths add up", [](ik::Chain& c) {
    for (ik::Bone& bone : c.bones) bone.length = 0;
  });
  expect("pole", [](ik::Chain& c) { c.pole = vec3(0); });
  expect("none", [](ik::Chain&) {});
}

TEST_F(RefusalTest, OfOptionsAndSolvers) {
  const ik::Chain free = evenChain(4, 0.4), cones = evenChain(4, 0.4, wide),
                  hinges = evenChain(4, 0.4, ik::Hinge{{0, 0, 1}, -1, 1});
  const auto refused = [&](const ik::Chain& chain, const ik::Options& options) {
    EXPECT_THROW(ik::Batch(device(), chain, 1, options), Error);
  };
  refused(free, {.tolerance = 0});
  refused(free, {.tolerance = nan});
  refused(cones, {.restPull = -1});
  refused(cones, {.restPull = 2});
  refused(free, {.solver = ik::Solver::twoBone});
  refused(free, {.solver = ik::Solver::activeSet});
  refused(cones, {.solver = ik::Solver::stretchAlign});
  refused(hinges, {.solver = ik::Solver::dissertationKeep});
  ik::Chain twisting = cones;
  twisting.bones[0].twistMax = 1;
  refused(twisting, {.solver = ik::Solver::dissertationEdge});
}

// Memory might refuse them too, so the message tells which limit does.
TEST_F(RefusalTest, OfMoreChainsThanTheMost) {
  try {
    ik::Batch(device(), evenChain(4, 0.4), ik::Batch::maxChains + 1);
    FAIL() << "not refused";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::input);
    EXPECT_STREQ(error.what(), "16777217 chains, expected at most 16777216");
  }
}

}  // namespace
}  // namespace skitter::test
