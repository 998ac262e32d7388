#include "cpu_reference/measure.h"

#include <gtest/gtest.h>

#include "spider.h"
#include "validation/convert.h"

namespace skitter::test {
namespace {

class Measure : public testing::Test {
 protected:
  reference::Metric tick(const glm::dvec3& tip, bool planted = true) {
    chain.tip = tip;
    step.firstTick = planted ? -1 : static_cast<double>(n) - 1;
    step.duration = planted ? 1 : 20;
    ++n;
    foot.progress = step.progress(static_cast<double>(n));
    return metric = reference::measure(heights, limb, body, step, foot, chain, metric);
  }

  Heightfield terrain = flatField();
  reference::Heights heights = validation::heightsOf(terrain, parametersFor(terrain));
  reference::Limb limb = spiderCreature().limbs[0];
  reference::AgentBody body = bodyAt(1, 1);
  reference::Step step = plantedAt(body, {0.5, 0, 0});
  reference::Foot foot;
  reference::Chain chain{std::vector<glm::dvec2>(4), {}, 0, 1, 0};
  reference::Metric metric;
  int n = 10;
};

TEST_F(Measure, footThatStaysDoesNotSlip) {
  for (int i = 0; i < 5; ++i) tick({0.5, 0, 0});
  EXPECT_EQ(metric.slip, 0);
  EXPECT_EQ(metric.ticks, 5);
  EXPECT_EQ(metric.stanceTicks, 5);
  EXPECT_EQ(metric.penetration, 0);
  EXPECT_EQ(metric.floating, 0);
}

TEST_F(Measure, slipAddsUpAndEndsWithTheStance) {
  tick({0.5, 0, 0});
  tick({0.5, 0.3, 0.01});
  tick({0.51, 0, 0.01});
  EXPECT_NEAR(metric.slip, 0.02, 1e-12);
  tick({0.6, 0.1, 0}, false);
  EXPECT_EQ(metric.slip, -1);
  EXPECT_NEAR(metric.finishedSlip, 0.02, 1e-12);
  EXPECT_EQ(metric.finishedStances, 1);
  tick({0.9, 0.1, 0}, false);
  EXPECT_EQ(metric.slip, -1);
  EXPECT_EQ(metric.finishedStances, 1);
  tick({0.9, 0, 0});
  EXPECT_EQ(metric.slip, 0);
}

TEST_F(Measure, depthCountsAlwaysAndHeightOnlyWhenPlanted) {
  tick({0.5, -0.02, 0});
  EXPECT_NEAR(metric.penetration, 0.02, 1e-12);
  tick({0.5, 0.03, 0});
  EXPECT_NEAR(metric.floating, 0.03, 1e-12);
  tick({0.5, 0.5, 0}, false);
  EXPECT_NEAR(metric.floating, 0.03, 1e-12);
}

TEST_F(Measure, keepsTheLargestErrorAndViolation) {
  chain.reachError = 0.1;
  chain.directions[2].x = limb.bones[2].tanHalfCone;
  tick({0.5, 0, 0});
  EXPECT_NEAR(metric.largestViolation, 0, 1e-12);
  chain.directions[2].x = std::tan(std::atan(limb.bones[2].tanHalfCone) + 0.005);
  chain.reachError = 0.05;
  tick({0.5, 0, 0});
  EXPECT_NEAR(metric.largestViolation, 0.01, 1e-4);
  EXPECT_EQ(metric.largestError, 0.1);
}

}  // namespace
}  // namespace skitter::test
