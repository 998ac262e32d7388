#include "cpu_reference/stages/navigate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

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

TEST_F(Navigate, velocityIsPassedOnUpToTheSpeed) {
  const auto desired = [&](double speed) {
    return reference::navigate(tuning, bodyAt(1, 2), {{3, -4}, {0, 0}, speed, 0.5, GoalKind::velocity})
        .desired;
  };
  EXPECT_EQ(desired(6), glm::dvec2(3, -4));
  EXPECT_EQ(desired(5), glm::dvec2(3, -4));
  EXPECT_NEAR(glm::length(desired(2.5) - glm::dvec2(1.5, -2)), 0, 1e-12);
  EXPECT_EQ(desired(0), glm::dvec2(0));
  const auto atTheEdge =
      reference::navigate(tuning, bodyAt(31, 5), {{3, -4}, {0, 0}, 6, 0.5, GoalKind::velocity});
  EXPECT_EQ(atTheEdge.desired, glm::dvec2(-3, -4));
}

TEST_F(Navigate, nobodySleepsWhateverTheGoalIs) {
  reference::AgentBody body = bodyAt(1, 2);
  body.absent = true;
  const auto result = reference::navigate(tuning, body, {{9, 9}, {0, 0}, 1, 0.5, GoalKind::point});
  EXPECT_TRUE(result.asleep);
  EXPECT_EQ(result.desired, glm::dvec2(0));
}

TEST_F(Navigate, edgeTurnsBackOnlyTheOutwardPart) {
  const Goal goal{{100, 100}, {0, 0}, 1, 0.5, GoalKind::point};
  const auto result = reference::navigate(tuning, bodyAt(31, 5), goal);
  EXPECT_LT(result.desired.x, 0);
  EXPECT_GT(result.desired.y, 0);
  const Goal inward{{0, 0}, {0, 0}, 1, 0.5, GoalKind::point};
  EXPECT_LT(reference::navigate(tuning, bodyAt(31, 5), inward).desired.x, 0);
}

// An agent that sleeps, by a hair wherever numbers are compared.
struct Sleeper {
  Sleeper() {
    body.still = tuning.sleepTime;
    goal.speed = std::nextafter(1e-2 * tuning.legLength, 0);
    rest = {.gait = {}, .allowed = true, .edited = false, .breathes = true};
    rest.gait.cycle = 1.2;
    rest.gait.phase = std::nextafter(tuning.dt / 1.2, 0);
  }
  reference::NavigateResult navigate(const reference::NavigateChoices& choices = {}) const {
    return reference::navigate(tuning, body, goal, rest, choices);
  }

  reference::Tuning tuning = validation::tuningOf(parametersFor(flatField()));
  reference::AgentBody body = bodyAt(1, 2);
  reference::Goal goal{{1, 5}, {1, -5}, 0, 0.5, GoalKind::cross};
  reference::Rest rest;
};

// One thing else about it, and whether it sleeps then.
struct Case {
  const char* name;
  bool sleeps;
  void (*change)(Sleeper& s);
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

class SleepLaw : public testing::TestWithParam<Case> {};

TEST_P(SleepLaw, eachConditionDecidesAlone) {
  Sleeper sleeper;
  ASSERT_TRUE(sleeper.navigate().asleep);
  GetParam().change(sleeper);
  EXPECT_EQ(sleeper.navigate().asleep, GetParam().sleeps);
}

INSTANTIATE_TEST_SUITE_P(
    conditions, SleepLaw,
    testing::Values(
        Case{"asSlowAsStanding", false, [](Sleeper& s) { s.goal.speed = 1e-2 * s.tuning.legLength; }},
        Case{"walks", false, [](Sleeper& s) { s.goal.speed = 1; }},
        Case{"wantsNothing", true,
             [](Sleeper& s) {
               s.goal.speed = 1;
               s.goal.kind = GoalKind::none;
             }},
        Case{"wantsToBeElsewhere", false,
             [](Sleeper& s) {
               s.goal.speed = 1;
               s.goal.kind = GoalKind::point;
             }},
        Case{"isThere", true,
             [](Sleeper& s) {
               s.goal = {s.body.world() + glm::dvec2(0, 0.4), {0, 0}, 1, 0.5, GoalKind::point};
             }},
        Case{"stoodTooShort", false, [](Sleeper& s) { s.body.still = std::nextafter(s.body.still, 0); }},
        Case{"stoodForHours", true, [](Sleeper& s) { s.body.still = 1e4; }},
        Case{"aLegLifts", false, [](Sleeper& s) { s.rest.gait.lift = 1u << 7; }},
        Case{"aLegIsAimedAnew", false, [](Sleeper& s) { s.rest.gait.reaim = 1; }},
        Case{"aLegIsInTheAir", false, [](Sleeper& s) { s.rest.gait.air = 1u << 3; }},
        Case{"breathesIn", false, [](Sleeper& s) { s.rest.gait.phase = s.tuning.dt / s.rest.gait.cycle; }},
        Case{"breathesOut", false, [](Sleeper& s) { s.rest.gait.phase = 0.999; }},
        Case{"hasBreathedOut", true, [](Sleeper& s) { s.rest.gait.phase = 0; }},
        Case{"shorterBreaths", true,
             [](Sleeper& s) {
               s.rest.gait.phase *= 1.5;
               s.rest.gait.cycle /= 1.6;
             }},
        Case{"longerBreaths", false, [](Sleeper& s) { s.rest.gait.cycle *= 1.01; }},
        Case{"doesNotBreathe", true,
             [](Sleeper& s) {
               s.rest.breathes = false;
               s.rest.gait.phase = 0.5;
             }},
        Case{"mayNot", false, [](Sleeper& s) { s.rest.allowed = false; }},
        Case{"theGroundMovedLately", false, [](Sleeper& s) { s.rest.edited = true; }}),
    [](const auto& param) { return std::string(param.param.name); });

TEST(SleepMargins, marginsAreThoseOfTheRoundedNumbers) {
  Sleeper sleeper;
  const double first = sleeper.tuning.dt / sleeper.rest.gait.cycle;
  auto result = sleeper.navigate();
  EXPECT_LT(result.standMargin, 1e-15);
  EXPECT_LT(result.breathMargin, 1e-15);
  sleeper.goal.speed = 0.004;
  sleeper.rest.gait.phase = 3 * first;
  result = sleeper.navigate();
  EXPECT_NEAR(result.standMargin, 0.006, 1e-12);
  EXPECT_NEAR(result.breathMargin, 2 * first, 1e-12);
  sleeper.rest.breathes = false;
  EXPECT_EQ(sleeper.navigate().breathMargin, std::numeric_limits<double>::infinity());
  sleeper.rest.edited = true;
  EXPECT_EQ(sleeper.navigate().standMargin, std::numeric_limits<double>::infinity());
}

TEST(SleepMargins, decisionsCanBeForced) {
  Sleeper sleeper;
  EXPECT_FALSE(sleeper.navigate({.stands = 0}).asleep);
  EXPECT_FALSE(sleeper.navigate({.breathedOut = 0}).asleep);
  sleeper.goal.speed = 1;
  sleeper.rest.gait.phase = 0.5;
  EXPECT_FALSE(sleeper.navigate({.stands = 1}).asleep);
  EXPECT_FALSE(sleeper.navigate({.breathedOut = 1}).asleep);
  EXPECT_TRUE(sleeper.navigate({.stands = 1, .breathedOut = 1}).asleep);
}

}  // namespace
}  // namespace skitter::test
