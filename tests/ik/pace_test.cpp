// How far joints move beside their target, judged by nothing but where they are.
#include <algorithm>
#include <cmath>

#include "ik/solved.h"
#include "skitter/device.h"
#include "support/gpu_fixture.h"

namespace skitter::test {
namespace {

using glm::dvec3;

constexpr size_t crossingRows = 1200;
// The solver's 8, and what float32 joints may be off by from row to row.
constexpr double mostRatio = 8.05, jointNoise = 3e-6;

struct Crossing {
  const char* name;
  dvec3 (*at)(double share);
};

dvec3 onCircle(double angle) { return {std::cos(angle), std::sin(angle), 0}; }

constexpr double halfCircle = 3.14159265358979323846;

// `rest` chains bend in the XY plane about +X.
const Crossing crossings[] = {
    {"over the pole", [](double s) { return -0.6 * onCircle(-halfCircle * s); }},
    {"beside the pole", [](double s) { return dvec3(0, 0, 1e-3) - 0.6 * onCircle(-halfCircle * s); }},
    {"out of the plane",
     [](double s) { return 0.7 * dvec3(std::cos(halfCircle * s), 0, std::sin(halfCircle * s)); }},
    {"through full stretch",
     [](double s) { return (1 - 0.1 * std::cos(4 * halfCircle * s)) * onCircle(0.4); }},
    {"past the point opposite to rest",
     [](double s) { return 0.75 * onCircle(2 * halfCircle * s - halfCircle / 18); }},
    {"around, out of reach", [](double s) { return 1.3 * onCircle(2 * halfCircle * s) + dvec3(0, 0, 0.2); }},
    {"past the base", [](double s) { return dvec3(1.6 * s - 0.8, 0.02, 0); }},
};

// As `skitter ik` has it at rest.
ik::Chain restingChain(size_t joints, const ik::Limit& limit) {
  ik::Chain chain;
  const auto bones = static_cast<double>(joints - 1);
  for (size_t i = 0; i + 1 < joints; ++i) {
    const double angle = (60 - 140 * static_cast<double>(i) / std::max(bones - 1, 1.0)) * halfCircle / 180;
    chain.bones.push_back(
        {.length = static_cast<float>(1 / bones), .direction = onCircle(angle), .limit = limit});
  }
  chain.bones[0].limit = ik::Free{};
  return chain;
}

struct Followed {
  double worst = 0;  // the farthest joint's way, of the target's
  size_t over = 0;   // rows beyond `mostRatio`
  size_t held = 0, jumped = 0;
};

// A chain a path.
std::vector<Followed> followAcross(Device& device, const ik::Chain& chain, ik::Solver solver) {
  ik::Batch batch(device, chain, std::size(crossings), {.solver = solver, .start = ik::Start::previous});
  std::vector<Followed> followed(std::size(crossings));
  std::vector<glm::vec3> targets, lastTargets;
  Solved before;
  for (size_t row = 0; row < crossingRows; ++row) {
    lastTargets = targets;
    targets.clear();
    for (const Crossing& crossing : crossings)
      targets.emplace_back(crossing.at(static_cast<double>(row) / (crossingRows - 1)));
    batch.setTargets(targets);
    batch.solve();
    const Solved after = resultOf(batch);
    for (size_t p = 0; p < std::size(crossings) && row > 0; ++p) {
      const double way = glm::length(targets[p] - lastTargets[p]);
      double farthest = 0;
      for (size_t j = 0; j < after.joints; ++j)
        farthest = std::max<double>(farthest, glm::length(after.chain(p)[j] - before.chain(p)[j]));
      // Where a target turns round it may stand, and a chain that is behind catch up.
      const double ratio = way > 0 ? std::max(farthest - jointNoise, 0.0) / way : 0;
      followed[p].worst = std::max(followed[p].worst, ratio);
      followed[p].over += ratio > mostRatio;
      followed[p].held += after.report[p].stop == ik::Stop::held;
      followed[p].jumped += after.report[p].stop == ik::Stop::jumped;
    }
    before = after;
  }
  return followed;
}

class PaceTest : public GpuTest {
 protected:
  // Whether each row in which a joint goes beyond is one that was reported, and there are at most `jumps` a
  // path.
  void expectPace(const ik::Chain& chain, ik::Solver solver, size_t jumps) {
    const std::vector<Followed> followed = followAcross(device(), chain, solver);
    for (size_t p = 0; p < followed.size(); ++p) {
      SCOPED_TRACE(std::string(crossings[p].name) + ", " + std::to_string(chain.bones.size() + 1) +
                   " joints, " + ik::nameOf(solver));
      EXPECT_LE(followed[p].over, followed[p].jumped) << followed[p].worst;
      EXPECT_LE(followed[p].jumped, jumps) << followed[p].worst;
    }
  }
};

TEST_F(PaceTest, WithoutLimitsNoJointGoesBeyond) {
  for (const size_t joints : {3, 4, 7})
    expectPace(restingChain(joints, ik::Free{}), ik::Solver::automatic, 0);
  expectPace(restingChain(3, ik::Free{}), ik::Solver::twoBone, 0);
  for (const ik::Solver solver : {ik::Solver::fabrik, ik::Solver::ccd, ik::Solver::dampedLeastSquares})
    expectPace(restingChain(5, ik::Free{}), solver, 0);
}

TEST_F(PaceTest, ConesOnAFreeBaseGoBeyondWhereALimitForbidsAWayAlone) {
  for (const size_t joints : {3, 5, 9})
    expectPace(restingChain(joints, ik::Cone{static_cast<float>(halfCircle / 3)}), ik::Solver::automatic, 2);
}

TEST_F(PaceTest, ATargetOutOfReachThatStandsStillLeavesJointsStill) {
  for (const ik::Limit& limit : {ik::Limit(ik::Free{}), ik::Limit(ik::Cone{1.5f}), ik::Limit(ik::Cone{0.6f}),
                                 ik::Limit(ik::Ellipse{0.8f, 1.1f, 0.5f, 0.9f})})
    for (const size_t joints : {3, 5}) {
      const std::vector<glm::vec3> targets = {{1.05f, 0, 0}, {0, 1.3f, 0}, {-0.9f, 0, 0.9f}, {0, 0, -2}};
      ik::Batch batch(device(), restingChain(joints, limit), 4, {.start = ik::Start::previous});
      batch.setTargets(targets);
      for (int solve = 0; solve < 150; ++solve) batch.solve();
      const std::vector<glm::vec3> before = batch.downloadJoints();
      for (int solve = 0; solve < 50; ++solve) batch.solve();
      EXPECT_EQ(before, batch.downloadJoints()) << joints << " joints, limit " << limit.index();
    }
}

}  // namespace
}  // namespace skitter::test
