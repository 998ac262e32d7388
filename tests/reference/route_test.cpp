#include "cpu_reference/stages/route.h"

#include <gtest/gtest.h>

#include "cpu_reference/heightfield.h"
#include "cpu_reference/stages/swing.h"
#include "spider.h"
#include "validation/convert.h"

namespace skitter::test {
namespace {

class Route : public testing::Test {
 protected:
  // Height as a function of metres along the step and to its right.
  reference::Route over(const std::function<double(double along, double right)>& height) {
    terrain = field(1025, 0.03125f, [&](double x, double z) { return height(z - 1, 1 - x); });
    heights = validation::heightsOf(terrain, parametersFor(terrain));
    return reference::route(tuning, heights, body, from, to, std::nullopt, 1);
  }
  // The deepest that the foot comes below the ground, the last tenths at either end left out.
  double depth(const glm::dvec3& lift) const {
    reference::Step step;
    step.liftOff = from;
    step.landing = to;
    step.lift = step.startTangent = lift;
    double deepest = -1;
    for (double u = 0.1; u <= 0.9; u += 0.01) {
      const glm::dvec3 p = reference::splineAt(step, u).position;
      deepest = std::max(deepest, reference::heightAt(heights, 1 + p.x, 1 + p.z) - p.y);
    }
    return deepest;
  }

  Heightfield terrain = flatField();
  reference::Heights heights = validation::heightsOf(terrain, parametersFor(terrain));
  reference::Tuning tuning = validation::tuningOf(parametersFor(terrain));
  reference::AgentBody body = bodyAt(1, 1);
  glm::dvec3 from{0, 0, 0}, to{0, 0, 0.7};
};

TEST_F(Route, flatGroundTakesTheUsualArc) {
  const auto route = over([](double, double) { return 0.0; });
  EXPECT_EQ(route.chosen, 0);
  EXPECT_NEAR(glm::length(route.way().lift - glm::dvec3(0, tuning.stepHeight, 0)), 0, 1e-12);
}

TEST_F(Route, aRidgeAnywhereIsCleared) {
  for (const double at : {0.1, 0.2, 0.3, 0.4, 0.5, 0.6}) {
    const auto route = over([=](double along, double) { return std::max(0.0, 0.12 - std::abs(along - at)); });
    EXPECT_EQ(route.chosen, 0) << at;
    // Places lie up to 0.11 apart: the tip between two of them stands out by half of that on slopes of 1 at
    // most.
    EXPECT_LT(depth(route.way().lift), 0.03) << at;
  }
}

TEST_F(Route, aPostIsPassedOnItsLowSide) {
  for (const double side : {0.05, -0.05}) {
    const auto route = over([=](double along, double right) {
      return std::max(0.0, 0.4 - 3 * std::hypot(along - 0.35, right - side));
    });
    EXPECT_GT(route.way().side * side, 0);  // sides count to the left
    EXPECT_LT(glm::length(route.way().lift), 0.35);
    EXPECT_LT(depth(route.way().lift), 0.02);
  }
}

TEST_F(Route, whatNoStepCanClearIsClimbedAsHighAsItCan) {
  const auto route = over([](double along, double) { return along > 0.3 && along < 0.4 ? 2.0 : 0.0; });
  EXPECT_NEAR(glm::length(route.way().lift), tuning.stepHeightMax, 1e-9);
}

TEST_F(Route, aFootInTheAirIsNotLiftedOverWhatItHasPassed) {
  from = {0, 0.15, 0.2};
  terrain = field(1025, 0.03125f, [](double, double z) { return z < 1.1 ? 0.3 : 0.0; });
  heights = validation::heightsOf(terrain, parametersFor(terrain));
  const auto route = reference::route(tuning, heights, body, from, to, glm::dvec3(0, 0.1, 0.3), 0.5);
  EXPECT_NEAR(route.way().height, 0.5 * tuning.stepHeight, 1e-9);
}

}  // namespace
}  // namespace skitter::test
