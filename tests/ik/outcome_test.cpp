// What the solvers that the engine ships achieve, judged by the joints alone: a benchmark's rows with fewer
// targets.
#include <algorithm>

#include "ik/outcome.h"
#include "skitter/device.h"
#include "skitter/rig.h"
#include "support/gpu_fixture.h"

namespace skitter::test {
namespace {

constexpr size_t cold = 2000, paths = 200, manyPaths = 4000, ticks = 50;
constexpr float kDegree = 0.0174532925f;

class OutcomeTest : public GpuTest {
 protected:
  static void expectLegal(const Outcome& outcome) {
    EXPECT_LE(outcome.violation, 1e-4);
    EXPECT_LE(outcome.boneError, 1e-5);
  }
  void note(const std::string& name, const Outcome& outcome) {
    RecordProperty(name + ".solved", std::to_string(100 * outcome.solved));
    RecordProperty(name + ".iterations", std::to_string(outcome.meanIterations));
    RecordProperty(name + ".ratio", std::to_string(outcome.p99Ratio));
    RecordProperty(name + ".violation", std::to_string(1e6 * outcome.violation) + "e-6");
  }
  void expectSolved(const std::string& name, const Outcome& outcome, double least) {
    note(name, outcome);
    EXPECT_GE(outcome.solved, least) << name;
    expectLegal(outcome);
  }
  void expectCold(const std::string& name, const ik::Chain& chain, double least) {
    Random random(11);
    expectSolved(name, solveCold(device(), chain, {}, legalTargets(chain, cold, random)), least);
  }
  // Along paths that legal poses can follow, and round circles that none can reach: without jumps.
  void expectTracking(const std::string& name, const ik::Chain& chain, double least = 0.999,
                      size_t followed = paths) {
    Random random(12);
    const ik::Options options{.iterations = 3};
    const Outcome within = follow(device(), chain, options, legalPaths(chain, followed, ticks, random));
    expectSolved(name, within, least);
    EXPECT_LE(within.p99Ratio, 2) << name;
    const Outcome beyond =
        follow(device(), chain, options, circlesBeyondReach(chain, followed, ticks, random));
    note(name + ".beyond", beyond);
    expectLegal(beyond);
    EXPECT_LE(beyond.p99Ratio, 2) << name << ", out of reach";
  }
};

ik::Chain ellipseChain() {
  ik::Chain chain = evenChain(5, 0.35);
  for (size_t i = 0; i < chain.bones.size(); ++i)
    chain.bones[i].limit =
        i % 2 == 0 ? ik::Ellipse{1.2f, 0.5f, 0.8f, 0.4f} : ik::Ellipse{0.5f, 1.0f, 0.4f, 1.2f};
  return chain;
}

// The spider's leg as its joints are built: the coxa turns about the vertical, the others in the leg's plane.
ik::Chain hingedSpiderLeg() {
  const Rig rig = spiderRig();
  const Leg& leg = rig.legs[0];
  const glm::vec3 up(0, 1, 0), out = leg.home - leg.root(), lateral = glm::normalize(glm::cross(up, out));
  ik::Chain chain;
  for (const Bone& bone : leg.bones) {
    const glm::vec3 axis = chain.bones.empty() ? up : lateral;
    chain.bones.push_back({.length = bone.length,
                           .direction = bone.direction,
                           .limit = ik::Hinge{axis, -bone.coneHalfAngle, bone.coneHalfAngle}});
  }
  return chain;
}

// Equal patterns of kinds share their kernels.
ik::Chain mixedRig(size_t pattern, Random& random) {
  const std::vector<std::string> kinds[] = {
      {"cone", "hinge", "hinge"}, {"ellipse", "hinge", "cone"}, {"hinge", "cone", "ellipse"}};
  return randomRig(kinds[pattern % 3], random);
}

TEST_F(OutcomeTest, FreeChains) {
  for (const size_t joints : {5, 10}) {
    const ik::Chain chain = evenChain(joints, 0.35);
    const std::string name = "free" + std::to_string(joints);
    Random random(13);
    expectSolved(name, solveCold(device(), chain, {}, shellTargets(0.2, 0.95, cold, random)), 1);
    expectSolved(name + ".far", solveCold(device(), chain, {}, shellTargets(0.95, 0.999, cold, random)), 1);
    expectSolved(name + ".track",
                 follow(device(), chain, {.iterations = 4}, wanderingPaths(paths, ticks, random)), 1);
  }
}

TEST_F(OutcomeTest, Cones) {
  for (const int angle : {90, 60, 30}) {
    const ik::Chain chain = evenChain(5, 0.35, ik::Cone{kDegree * static_cast<float>(angle)});
    expectCold("cones" + std::to_string(angle), chain, 0.9999);
    if (angle == 60) expectTracking("cones60.track", chain);
  }
}

TEST_F(OutcomeTest, Ellipses) {
  expectCold("ellipses", ellipseChain(), 0.999);
  expectTracking("ellipses.track", ellipseChain());
}

TEST_F(OutcomeTest, TheSpidersHinges) {
  expectCold("spider", hingedSpiderLeg(), 0.9995);
  // With 200 paths the ratio is one of 1.7 to 2.4, by which paths they are.
  expectTracking("spider.track", hingedSpiderLeg(), 0.9995, manyPaths);
}

TEST_F(OutcomeTest, HingesOnAFreeBall) {
  ik::Chain chain = evenChain(5, 0.35, ik::Hinge{{0, 0, 1}, -60 * kDegree, 60 * kDegree});
  chain.bones[0].limit = ik::Free{};
  expectCold("free-base", chain, 0.9999);
  expectTracking("free-base.track", chain, 0.9998);
}

// Ball joints of 90 degrees, straight at rest, the base free: what Caliko's examples are made of.
TEST_F(OutcomeTest, BallJointsOnAFreeBase) {
  ik::Chain chain = evenChain(6, 0, ik::Cone{90 * kDegree});
  chain.bones[0].limit = ik::Free{};
  Random random(14);
  expectSolved("balls", solveCold(device(), chain, {}, shellTargets(0.2, 0.95, cold, random)), 0.9999);
}

TEST_F(OutcomeTest, RandomRigs) {
  constexpr size_t rigs = 60, each = 300, pathsEach = 50;
  double sum = 0, worst = 1, sumFollowed = 0, worstFollowed = 1;
  for (size_t rig = 0; rig < rigs; ++rig) {
    Random random(1000 + rig);
    const ik::Chain chain = mixedRig(rig, random);
    const Outcome outcome = solveCold(device(), chain, {}, legalTargets(chain, each, random));
    expectLegal(outcome);
    sum += outcome.solved;
    worst = std::min(worst, outcome.solved);
    const Outcome followed =
        follow(device(), chain, {.iterations = 3}, legalPaths(chain, pathsEach, ticks, random));
    expectLegal(followed);
    sumFollowed += followed.solved;
    worstFollowed = std::min(worstFollowed, followed.solved);
  }
  RecordProperty("mean", std::to_string(100 * sum / rigs));
  RecordProperty("worst", std::to_string(100 * worst));
  RecordProperty("mean.track", std::to_string(100 * sumFollowed / rigs));
  RecordProperty("worst.track", std::to_string(100 * worstFollowed));
  EXPECT_GE(sum / rigs, 0.999);
  EXPECT_GE(worst, 0.99);
  EXPECT_GE(sumFollowed / rigs, 0.999);
  EXPECT_GE(worstFollowed, 0.99);
}

}  // namespace
}  // namespace skitter::test
