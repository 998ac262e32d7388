#include "cpu_reference/navigate.h"

#include <gtest/gtest.h>

#include "spider.h"
#include "validation/convert.h"

namespace skitter::test {
namespace {

using reference::Goal;
using reference::GoalKind;

class Navigate : public testing::Test {
 protected:
  reference::Tuning tuning = validation::tuningOf(parametersFor(flatField()));
};

TEST_F(Navigate, noGoalNoSpeed) {
  const auto result = reference::navigate(tuning, bodyAt(1, 2), {{9, 9}, {0, 0}, 1, 0.5, GoalKind::none});
  EXPECT_EQ(result.desired, glm::dvec2(0));
}

TEST_F(Navigate, pointIsApproachedSlowlyAndArrivedAt) {
  const Goal goal{{3, 4}, {0, 0}, 2, 0.1, GoalKind::point};
  EXPECT_NEAR(glm::length(reference::navigate(tuning, bodyAt(0, 0), goal).desired - glm::dvec2(1.2, 1.6)), 0,
              1e-12);
  EXPECT_NEAR(glm::length(reference::navigate(tuning, bodyAt(3, 3.5), goal).desired), 1, 1e-12);
  EXPECT_EQ(reference::navigate(tuning, bodyAt(3, 3.95), goal).desired, glm::dvec2(0));
}

TEST_F(Navigate, crossTurnsRoundAtItsEnds) {
  const Goal goal{{5, 0}, {-5, 0}, 1, 0.5, GoalKind::cross};
  const auto onTheWay = reference::navigate(tuning, bodyAt(4, 0), goal);
  EXPECT_EQ(onTheWay.goal.target, goal.target);
  EXPECT_NEAR(onTheWay.desired.x, 1, 1e-12);
  const auto there = reference::navigate(tuning, bodyAt(4.6, 0), goal);
  EXPECT_EQ(there.goal.target, goal.otherEnd);
  EXPECT_EQ(there.goal.otherEnd, goal.target);
  EXPECT_NEAR(there.desired.x, -1, 1e-12);
  EXPECT_NEAR(there.arrivalMargin, 0.1, 1e-12);
}

TEST_F(Navigate, edgeTurnsBackOnlyTheOutwardPart) {
  const Goal goal{{100, 100}, {0, 0}, 1, 0.5, GoalKind::point};
  const auto result = reference::navigate(tuning, bodyAt(31, 5), goal);
  EXPECT_LT(result.desired.x, 0);
  EXPECT_GT(result.desired.y, 0);
  const Goal inward{{0, 0}, {0, 0}, 1, 0.5, GoalKind::point};
  EXPECT_LT(reference::navigate(tuning, bodyAt(31, 5), inward).desired.x, 0);
}

}  // namespace
}  // namespace skitter::test
