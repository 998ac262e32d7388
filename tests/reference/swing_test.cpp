#include "cpu_reference/stages/swing.h"

#include <gtest/gtest.h>

#include "spider.h"

namespace skitter::test {
namespace {

reference::Step someStep() {
  reference::Step step;
  step.liftOff = {1, 0, 2};
  step.landing = {1.5, 0.2, 2.9};
  step.lift = {0.01, 0.15, 0};
  step.startTangent = step.lift;
  step.firstTick = 10;
  step.duration = 20;
  return step;
}

TEST(Swing, beginsAndEndsWhereItShould) {
  const reference::AgentBody body = bodyAt(1, 2);
  const reference::Step step = someStep();
  EXPECT_NEAR(glm::length(reference::swing(step, body, 10).target - glm::dvec3(0, 0, 0)), 0, 1e-12);
  const reference::Foot landed = reference::swing(step, body, 30);
  EXPECT_EQ(landed.progress, 1);
  EXPECT_NEAR(glm::length(landed.target - glm::dvec3(0.5, 0.2, 0.9)), 0, 1e-12);
  EXPECT_EQ(reference::swing(step, body, 500).target, landed.target);
  EXPECT_DOUBLE_EQ(reference::swing(step, body, 15).progress, 0.25);
}

TEST(Swing, placeAndWayAreContinuousAtTheKnot) {
  const reference::Step step = someStep();
  const auto left = reference::splineAt(step, 0.5 - 1e-9), right = reference::splineAt(step, 0.5);
  EXPECT_NEAR(glm::length(left.position - right.position), 0, 1e-7);
  EXPECT_NEAR(glm::length(left.tangent - right.tangent), 0, 1e-7);
  EXPECT_NEAR(glm::length(right.position - ((step.liftOff + step.landing) / 2.0 + step.lift)), 0, 1e-12);
}

TEST(Swing, tangentIsTheDerivative) {
  const reference::Step step = someStep();
  for (double u = 0.05; u < 1; u += 0.1) {
    const glm::dvec3 numeric =
        (reference::splineAt(step, u + 1e-6).position - reference::splineAt(step, u - 1e-6).position) / 4e-6;
    EXPECT_NEAR(glm::length(numeric - reference::splineAt(step, u).tangent), 0, 1e-6);
  }
}

TEST(Swing, clearsTheStraightWayByTheWeightsOfTheGaps) {
  // At s = 3/16 of the way across, the foot is 5/8 of the lift up: what the clearance rule relies on.
  reference::Step step = someStep();
  step.lift = step.startTangent = {0, 0.2, 0};
  for (const auto& [u, share] : {std::pair{0.25, 5.0 / 8}, {0.5, 1.0}, {0.75, 5.0 / 8}}) {
    const glm::dvec3 point = reference::splineAt(step, u).position;
    const double along = (point.z - step.liftOff.z) / (step.landing.z - step.liftOff.z);
    const double straight = step.liftOff.y + along * (step.landing.y - step.liftOff.y);
    EXPECT_NEAR(along, u == 0.25 ? 3.0 / 16 : u == 0.5 ? 0.5 : 13.0 / 16, 1e-12);
    EXPECT_NEAR(point.y - straight, share * 0.2, 1e-12);
  }
}

TEST(Swing, leavesTheGroundAndTouchesItAtRest) {
  const reference::AgentBody body = bodyAt(1, 2);
  const reference::Step step = someStep();
  const auto at = [&](double tick) { return reference::swing(step, body, tick).target; };
  const double way = glm::length(step.landing - step.liftOff);
  EXPECT_LT(glm::length(at(10.001) - at(10)), 1e-6);
  EXPECT_LT(glm::length(at(30) - at(29.999)), 1e-6);
  double fastest = 0;
  for (double t = 10; t < 30; t += 0.05)
    fastest = std::max(fastest, glm::length(at(t + 0.05) - at(t)) / 0.05);
  EXPECT_LT(fastest, 2.2 * way / 20);
  // The last twentieth of its height it falls all but straight down.
  const glm::dvec3 last = at(28.5) - at(30);
  EXPECT_GT(last.y, 3 * std::hypot(last.x, last.z));
}

TEST(Swing, aStepAimedAnewIsUnderWay) {
  reference::Step step = someStep();
  step.startTangent = {0.2, 0.1, 0.3};
  EXPECT_EQ(reference::eased(step, 0).rate, 1);
  EXPECT_EQ(reference::eased(step, 1).rate, 0);
  EXPECT_EQ(reference::eased(step, 0).progress, 0);
  EXPECT_EQ(reference::eased(step, 1).progress, 1);
  for (double u = 0.05; u < 1; u += 0.05) {
    const double numeric =
        (reference::eased(step, u + 1e-6).progress - reference::eased(step, u - 1e-6).progress) / 2e-6;
    EXPECT_NEAR(numeric, reference::eased(step, u).rate, 1e-7);
    EXPECT_GT(numeric, 0);
  }
}

TEST(Swing, followsTheBodyAcrossTiles) {
  reference::Step step = someStep();
  step.tileX = 3;
  const reference::AgentBody body = bodyAt(4 * 16 + 0.5, 2);
  EXPECT_NEAR(reference::swing(step, body, 30).target.x, 3 * 16 + 1.5 - (4 * 16 + 0.5), 1e-12);
}

}  // namespace
}  // namespace skitter::test
