// The planted controller: feet that lock where they stand, and bones turned after them.
#include <gtest/gtest.h>

#include <cmath>

#include "cpu_reference/stages/ik_planted.h"
#include "cpu_reference/stages/pose_clip.h"
#include "cpu_reference/stages/swing_planted.h"
#include "hand_clips.h"
#include "spider.h"
#include "validation/convert.h"

namespace skitter::test {
namespace {

class Plant : public testing::Test {
 protected:
  Plant() {
    tuning.plantStray = 0.3;
    tuning.plantKeep = 0.8;
  }
  reference::PlantedFoot tick(const glm::dvec3& clipFoot, bool stands, const reference::Plant& before) const {
    return reference::plantedSwing(tuning, heights, body, clipFoot, stands, before);
  }

  Heightfield terrain = field(257, 0.25f, [](double x, double z) { return 0.2 * x + 0.1 * z; });
  reference::Tuning tuning = validation::tuningOf(parametersFor(terrain));
  reference::Heights heights = validation::heightsOf(terrain, parametersFor(terrain));
  reference::AgentBody body = bodyAt(15.5, 2, 3.3);
  const glm::dvec3 foot{0.5, 0, 0.25};
};

TEST_F(Plant, feetAreAsHighAboveTheGroundAsAboveTheClips) {
  const auto ground = [&](const glm::dvec3& p) { return 0.2 * (15.5 + p.x) + 0.1 * (2 + p.z) - 3.3; };
  for (const double up : {0.0, 0.1, -0.05}) {
    const auto result = tick({0.5, up, 0.25}, false, {});
    EXPECT_NEAR(glm::length(result.foot.target - glm::dvec3(0.5, ground(foot) + std::max(up, 0.0), 0.25)), 0,
                1e-6);
    EXPECT_EQ(result.foot.progress, 0.5);
  }
}

TEST_F(Plant, locksWhereItStandsAndStaysAsTheBodyGoesOn) {
  reference::PlantedFoot result = tick(foot, true, {});
  EXPECT_TRUE(result.plant.locked);
  EXPECT_EQ(result.foot.progress, 1);
  const glm::dvec3 world = result.foot.target + glm::dvec3(body.world().x, body.y, body.world().y);
  for (int n = 1; n <= 9; ++n) {
    body = bodyAt(15.5 + 0.1 * n, 2, 3.3 - 0.01 * n);  // into the next tile
    result = tick(foot - glm::dvec3(0.08 * n, 0, 0), true, result.plant);
    ASSERT_TRUE(result.plant.locked) << n;
    EXPECT_NEAR(glm::length(result.foot.target + glm::dvec3(body.world().x, body.y, body.world().y) - world),
                0, 1e-9);
    EXPECT_NEAR(result.plant.offset.x, -0.02 * n, 1e-9);
  }
}

TEST_F(Plant, letsGoWhereTheClipLeavesItBehindOrLifts) {
  const reference::PlantedFoot locked = tick(foot, true, {});
  const auto within = tick(foot + glm::dvec3(0.29, 0, 0), true, locked.plant);
  EXPECT_TRUE(within.plant.locked);
  EXPECT_NEAR(within.strayMargin, 0.01, 1e-9);
  const auto strayed = tick(foot + glm::dvec3(0.31, 0, 0), true, locked.plant);
  EXPECT_FALSE(strayed.plant.locked);
  EXPECT_NEAR(strayed.plant.offset.x, -0.31 * 0.8, 1e-9);
  EXPECT_NEAR(glm::length(strayed.foot.target - strayed.wanted - strayed.plant.offset), 0, 1e-12);
  const auto lifted = tick(foot + glm::dvec3(0, 0.1, 0), false, within.plant);
  EXPECT_FALSE(lifted.plant.locked);
  EXPECT_NEAR(lifted.plant.offset.x, -0.29 * 0.8, 1e-9);
}

TEST_F(Plant, comesBackToTheClipByASteadyShare) {
  reference::Plant plant;
  plant.offset = {1, 0.5, -2};
  for (int n = 1; n < 20; ++n) {
    plant = tick(foot, false, plant).plant;
    EXPECT_NEAR(plant.offset.z, -2 * std::pow(0.8, n), 1e-12);
  }
}

TEST_F(Plant, locksOnlyNearTheClipsPlaceAndOnTheGroundThere) {
  reference::Plant plant;
  plant.offset = {0.16, 0.4, 0};
  EXPECT_FALSE(tick(foot, true, plant).plant.locked);
  plant.offset = {0.14, 0.4, 0};
  const auto result = tick(foot, true, plant);
  EXPECT_TRUE(result.plant.locked);
  EXPECT_NEAR(result.foot.target.x, 0.64, 1e-12);
  EXPECT_NEAR(result.foot.target.y, 0.2 * (15.5 + 0.64) + 0.1 * 2.25 - 3.3, 1e-6);
}

class PlantedIk : public testing::Test {
 protected:
  PlantedIk()
      : start{{{0.1, -0.2}, {0.2, 0}, {-0.1, 0.15}, {0, -0.2}}, limb.root + glm::dvec3(0.02, 0.01, 0)} {}
  // p_0 .. p_bones in model space.
  std::vector<glm::dvec3> jointsOf(const std::vector<glm::dvec2>& directions) const {
    const reference::Posture posture(limb, directions);
    std::vector<glm::dvec3> joints;
    for (const glm::dvec3& joint : posture.joints()) joints.push_back(start.root + limb.reach * joint);
    return joints;
  }
  void expectFixed(const std::vector<glm::dvec2>& solved) const {
    const auto fixes = reference::boneFixes(limb, start, solved);
    const auto from = jointsOf(start.directions), to = jointsOf(solved);
    for (size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(glm::length(fixes[i].turn * from[i] + fixes[i].move - to[i]), 0, 1e-6) << i;
      EXPECT_NEAR(glm::length(fixes[i].turn * from[i + 1] + fixes[i].move - to[i + 1]), 0, 1e-6) << i;
      EXPECT_NEAR(glm::determinant(fixes[i].turn), 1, 1e-6);
    }
  }

  reference::Tuning tuning = validation::tuningOf(parametersFor(flatField()));
  reference::Limb limb = spiderCreature().limbs[2];
  reference::PlantedStart start;
  reference::AgentBody body = bodyAt(1, 2, 3);
  const reference::IkPlan plan{reference::IkSolver::fabrik, 4, 2};
};

TEST_F(PlantedIk, theClipsOwnFootNeedsNoCorrection) {
  const glm::dvec3 foot = jointsOf(start.directions).back();
  const auto chain = reference::plantedIk(tuning, limb, body, {foot, 1}, start, plan);
  EXPECT_NEAR(chain.reachError, 0, 1e-4);
  EXPECT_NEAR(glm::length(chain.tip - foot), 0, 1e-4);
  for (const reference::BoneFix& fix : reference::boneFixes(limb, start, start.directions)) {
    EXPECT_NEAR(glm::length(fix.move), 0, 1e-12);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(fix.turn[c][c], 1, 1e-12);
  }
}

TEST_F(PlantedIk, correctionsCarryTheClipsBonesOntoTheSolvedOnes) {
  body.orientation = glm::normalize(glm::dquat(0.95, 0.1, 0.2, -0.05));
  const glm::dvec3 foot =
      body.orientation * (jointsOf(start.directions).back() + glm::dvec3(0.05, 0.1, -0.05));
  const auto chain = reference::plantedIk(tuning, limb, body, {foot, 1}, start, plan);
  EXPECT_LT(chain.reachError, 1e-2);
  expectFixed(chain.directions);
}

TEST_F(PlantedIk, whatWasAnimatedIsAllowed) {
  start.directions[1] = {0.9, 0.4};  // beyond its cone
  const reference::Limb wide = reference::plantedLimb(limb, start);
  EXPECT_EQ(wide.root, start.root);
  EXPECT_NEAR(wide.bones[1].tanHalfCone, std::hypot(0.9, 0.4), 1e-15);
  EXPECT_EQ(wide.bones[0].tanHalfCone, limb.bones[0].tanHalfCone);
  const glm::dvec3 foot = jointsOf(start.directions).back();
  const auto chain = reference::plantedIk(tuning, limb, body, {foot, 1}, start, plan);
  EXPECT_LT(chain.reachError, 1e-5);
  expectFixed(chain.directions);
}

TEST_F(PlantedIk, poseIsCorrectedBeforeItTurnsWithTheBody) {
  const reference::Creature creature = spiderCreature();
  const reference::ClipTable table = restClip(creature);
  reference::BoneFix fix;
  fix.turn = {glm::dvec3(0, 0, -1), glm::dvec3(0, 1, 0), glm::dvec3(1, 0, 0)};
  fix.move = {0, 1, 0};
  body.orientation = glm::angleAxis(std::acos(0.0), glm::dvec3(1, 0, 0));  // y to z, z to -y
  const reference::Affine matrix = reference::plantedPose(table, body, {}, 0, fix);
  // (1, 2, 3) is turned to (3, 2, -1), moved to (3, 3, -1), and the body lays it on its back.
  EXPECT_NEAR(glm::length(matrix * glm::dvec4(1, 2, 3, 1) - glm::dvec3(3, 1, 3)), 0, 1e-12);
}

}  // namespace
}  // namespace skitter::test
