#include "cpu_reference/stages/avoid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace skitter::test {
namespace {

using reference::AvoidResult;
using reference::Walker;

// Agents of half a metre, and of legs of a metre, who face +z.
class Avoid : public testing::Test {
 protected:
  static constexpr int64_t metre = 1024;
  reference::AvoidTick tick;
  reference::AvoidTuning tuning{.quanta = metre, .look = 2 * metre, .legLength = 1};

  static Walker at(int64_t number, double x, double z, const glm::dvec2& velocity = glm::dvec2(0)) {
    return {.number = number,
            .x = std::llround(x * metre),
            .z = std::llround(z * metre),
            .radius = metre / 2,
            .velocity = velocity,
            .yields = true};
  }
  // The result of the first of them.
  AvoidResult first(const std::vector<Walker>& all, const glm::dvec2& desired, bool mayRest = false) const {
    reference::AgentBody body;
    body.speed = glm::length(all[0].velocity);
    body.heading = body.speed > 0 ? all[0].velocity / body.speed : glm::dvec2(0, 1);
    return reference::avoid(tuning, tick, body, all[0], all, desired, mayRest);
  }
};

TEST(AvoidRound, isAFifteenthOfASecondAtMost) {
  EXPECT_EQ(reference::roundTicks(1.0 / 240), 4);
  EXPECT_EQ(reference::roundTicks(static_cast<double>(1.0f / 60)), 4);
  EXPECT_EQ(reference::roundTicks(static_cast<double>(1.0f / 30)), 2);
  EXPECT_EQ(reference::roundTicks(0.025), 2);
  EXPECT_EQ(reference::roundTicks(static_cast<double>(1.0f / 15)), 1);
  EXPECT_EQ(reference::roundTicks(2.0 / 15), 1);
}

// Blocks of eight take turns.
TEST(AvoidRound, everybodyLooksAroundOnce) {
  for (const int64_t agent : {0, 7, 8, 31, 32})
    for (const int ticks : {1, 2, 4}) {
      int looks = 0;
      for (uint64_t n = 9; n < 9 + static_cast<uint64_t>(ticks); ++n)
        looks += reference::looksAround(agent, n, ticks) ? 1 : 0;
      EXPECT_EQ(looks, 1) << agent << ", " << ticks;
    }
  EXPECT_TRUE(reference::looksAround(7, 8, 4));
  EXPECT_TRUE(reference::looksAround(8, 7, 4));
  EXPECT_FALSE(reference::looksAround(8, 8, 4));
}

TEST_F(Avoid, aLoneAgentGoesAsItWants) {
  const AvoidResult result = first({at(0, 1, 2, {0, 1})}, {0.3, 0.7});
  EXPECT_EQ(result.velocity, glm::dvec2(0.3, 0.7));
  EXPECT_EQ(result.seen, 0);
  EXPECT_TRUE(result.planes.empty());
}

// An agent that stands keeps 1.55 m apart. The two meet within 0.7 s, and the sine of the angle of the cone's
// right side to the way is 1.55 / 3.25.
TEST_F(Avoid, headOnBothPassOnTheirRight) {
  tuning.look = 3 * metre;
  const double sine = 1.55 / 3.25, cosine = std::sqrt(1 - sine * sine), lacking = (3 + 3) * sine / 1.05;
  const AvoidResult result = first({at(3, 0, 0), at(5, 0, 3.25, {0, -6})}, {0, 3});
  ASSERT_EQ(result.planes.size(), 1u);
  EXPECT_EQ(result.planes[0].neighbour, 5);
  EXPECT_EQ(result.planes[0].right, 1);
  EXPECT_NEAR(result.planes[0].n.x, -cosine, 1e-12);
  EXPECT_NEAR(result.planes[0].n.y, -sine, 1e-12);
  EXPECT_NEAR(result.planes[0].bound, 3 * sine, 1e-12);
  EXPECT_NEAR(result.velocity.x, -cosine * lacking, 1e-9);
  EXPECT_NEAR(result.velocity.y, 3 - sine * lacking, 1e-9);
  const AvoidResult other = first({at(5, 0, 3.25), at(3, 0, 0, {0, 6})}, {0, -3});
  EXPECT_NEAR(other.velocity.x, cosine * lacking, 1e-9);
  EXPECT_NEAR(other.velocity.y, -3 + sine * lacking, 1e-9);
}

// The bound is half of what is missing over 0.7 s, and of how fast the two come together.
TEST_F(Avoid, whoGetsOnKeepsMoreRoom) {
  const auto boundAt = [&](double speed, double wanted) {
    return first({at(0, 0, 0, {0, speed}), at(1, 0, 1.25)}, {0, wanted}).planes.at(0).bound;
  };
  EXPECT_NEAR(boundAt(0, 1), (1.55 - 1.25) / 1.4, 1e-12);
  EXPECT_NEAR(boundAt(0.25, 1), (2.55 - 1.25) / 1.4 - 0.125, 1e-12);
  tuning.look = 3 * metre;
  EXPECT_NEAR(boundAt(0.5, 1), (3.55 - 1.25) / 1.4 - 0.25, 1e-12) << "half of what it wants is all";
  EXPECT_NEAR(boundAt(1, 1), (3.55 - 1.25) / 1.4 - 0.5, 1e-12);
  tuning.look = metre;
  EXPECT_NEAR(boundAt(1, 1), (2 - 1.25) / 1.4 - 0.5, 1e-12) << "no farther than it looks";
}

// The wall is 0.5 m from the footprint, which is a second's way at 1 m/s.
TEST_F(Avoid, aWallIsApproachedSlowly) {
  tuning.obstacles = {{.corners = {{-5, 1.2}, {5, 1.2}}, .radius = 0.2}};
  const AvoidResult result = first({at(0, 0, 0)}, {0, 1.5});
  ASSERT_EQ(result.obstaclePlanes.size(), 1u);
  EXPECT_NEAR(result.obstaclePlanes[0].n.y, -1, 1e-12);
  EXPECT_NEAR(result.obstaclePlanes[0].bound, -1, 1e-12);
  EXPECT_NEAR(result.velocity.x, 0, 1e-12);
  EXPECT_NEAR(result.velocity.y, 1, 1e-9);
  EXPECT_EQ(first({at(0, 0, 0)}, {1.5, 0.5}).velocity, glm::dvec2(1.5, 0.5));
}

TEST_F(Avoid, whoIsInAnObstacleIsLedOut) {
  const std::vector<glm::dvec2> square = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  tuning.obstacles = {{.corners = square}};
  const auto expectOut = [&] {
    const AvoidResult result = first({at(0, 0.875, 0)}, {0, 0});
    ASSERT_EQ(result.obstaclePlanes.size(), 1u);
    EXPECT_NEAR(result.obstaclePlanes[0].n.x, 1, 1e-12);
    EXPECT_NEAR(result.obstaclePlanes[0].bound, (0.5 + 0.125) / 0.5, 1e-12);
    EXPECT_NEAR(result.velocity.x, 0.3, 1e-9);
    EXPECT_NEAR(result.velocity.y, 0, 1e-9);
  };
  expectOut();
  std::ranges::reverse(tuning.obstacles[0].corners);
  expectOut();
}

TEST_F(Avoid, discsAndCornersAreRound) {
  tuning.obstacles = {{.corners = {{3, 4}}, .radius = 3.5}, {.corners = {{-3, -4}, {-3, -6}, {-6, -4}}}};
  const AvoidResult result = first({at(0, 0, 0)}, {0, 0});
  ASSERT_EQ(result.obstaclePlanes.size(), 1u) << "5 m are beyond sight";
  EXPECT_NEAR(result.obstaclePlanes[0].n.x, -0.6, 1e-12);
  EXPECT_NEAR(result.obstaclePlanes[0].n.y, -0.8, 1e-12);
  EXPECT_NEAR(result.obstaclePlanes[0].bound, (0.5 - 1.5) / 0.5, 1e-12);
  const glm::dvec2 corner = first({at(0, -2.25, -3)}, {0, 0}).obstaclePlanes.at(0).n;
  EXPECT_NEAR(corner.x, 0.6, 1e-12);
  EXPECT_NEAR(corner.y, 0.8, 1e-12);
}

// The nearest four of five count, in their order.
TEST_F(Avoid, theNearestObstaclesCount) {
  for (const double distance : {1.9, 1.2, 1.0, 1.7, 1.4})
    tuning.obstacles.push_back({.corners = {{0, distance}}, .radius = 0.1});
  const AvoidResult result = first({at(0, 0, 0)}, {0, 0});
  std::vector<size_t> counted;
  for (const reference::ObstaclePlane& plane : result.obstaclePlanes) counted.push_back(plane.obstacle);
  EXPECT_EQ(counted, (std::vector<size_t>{1, 2, 3, 4}));
  EXPECT_NEAR(result.obstacleMargin, 0.2 / 3.6, 1e-9);
  const Walker self = at(0, 0, 0);
  reference::AvoidChoices choices;
  choices.otherObstacle = true;
  EXPECT_EQ(reference::avoid(tuning, tick, {}, self, {&self, 1}, {0, 0}, false, choices)
                .obstaclePlanes.at(0)
                .obstacle,
            0u);
}

// Neighbours push; the obstacle has the last word but for the body's heading, which is toward it.
TEST_F(Avoid, nobodyIsPushedIntoAWall) {
  tuning.obstacles = {{.corners = {{-5, 0.5}, {5, 0.5}}}};
  const AvoidResult result = first({at(0, 0, 0), at(1, 0.1, -0.3), at(2, -0.1, -0.3)}, {0, 0});
  EXPECT_LT(result.velocity.y, 0.1);
  tuning.obstacles.clear();
  EXPECT_GT(first({at(0, 0, 0), at(1, 0.1, -0.3), at(2, -0.1, -0.3)}, {0, 0}).velocity.y, 0.2);
}

// Footprints touch, or are 0.375 m apart, of which 0.005 are kept.
TEST_F(Avoid, nobodyLeavesItsCell) {
  const AvoidResult touching = first({at(0, 0, 0, {0, 0.5}), at(1, 0, 1)}, {0, 1});
  EXPECT_LE(touching.velocity.y, 1e-4 + 1e-9);
  EXPECT_NEAR(touching.mostSpeed, 1e-4, 1e-9);
  const std::vector<Walker> apart = {at(0, 0, 0, {0, 0.5}), at(1, 0, 1.375)};
  EXPECT_NEAR(first(apart, {0, 1}).mostSpeed, 0.5 * 0.37 / 0.4 + 1e-4, 1e-9);
  EXPECT_NEAR(first({apart[0], at(1, 0, 1.375, {0, 0.25})}, {0, 1}).mostSpeed, 0.5 * 0.37 / 0.4 + 0.25 + 1e-4,
              1e-9);
  EXPECT_NEAR(first({apart[0], at(1, 0, -1)}, {0, 1}).mostSpeed, 100, 1e-9) << "behind it";
  // Who overlap much part first.
  EXPECT_NEAR(first({apart[0], at(1, 0, 0.5)}, {0, 1}).mostSpeed, 0.4 / 0.4 + 1e-4, 1e-9);
  Walker stranger = at(1, 0, 1.375);
  stranger.yields = false;  // it takes no part, and all of the gap is the agent's
  EXPECT_NEAR(first({at(0, 0, 0, {0, 0.5}), stranger}, {0, 1}).mostSpeed, 0.37 / 0.4 + 1e-4, 1e-9);
}

// Wishes that are so strong that half-planes yield more than the cell: 0.05 m beyond the room of legs, which
// is 1.55 m, of which 0.4 or 0.6 may be taken in 0.4 s, and 0.5 of 0.6 m at a rate of 0.3 a second. A turn is
// 120 ticks. In the second turn, the numbers' order by 0x9E3779B1 puts 1 before 0.
TEST_F(Avoid, whoGoesFirstMayTakeMoreOfTheRoom) {
  const auto shareOf = [&](int64_t number, Walker other, int64_t now) {
    tick.number = now;
    other.z = std::llround(1.6 * metre);
    const double room = static_cast<double>(other.z) / metre - 1.55;
    const double creep = 0.3 * (other.yields ? 0.5 : 1) * (room + 0.55);
    return (first({at(number, 0, 0), other}, {0, 40}).velocity.y - creep) * 0.4 / room;
  };
  for (const int64_t now : {1, 119, 240}) {
    EXPECT_NEAR(shareOf(0, at(1, 0, 0), now), 0.6, 1e-6) << now;
    EXPECT_NEAR(shareOf(1, at(0, 0, 0), now), 0.4, 1e-6) << now;
  }
  for (const int64_t now : {120, 239}) {
    EXPECT_NEAR(shareOf(0, at(1, 0, 0), now), 0.4, 1e-6) << now;
    EXPECT_NEAR(shareOf(1, at(0, 0, 0), now), 0.6, 1e-6) << now;
  }
  Walker stranger = at(1, 0, 0);
  stranger.yields = false;
  EXPECT_NEAR(shareOf(0, stranger, 1), 1, 1e-6);
}

// A gap of 0.45 is 0.1 less than the room of legs. Who goes first creeps on through half of it, at a rate of
// 0.3 a second.
TEST_F(Avoid, whoIsInTheWayOfATurnGoesBack) {
  const std::vector<Walker> close = {at(1, 0, 0), at(0, 0, 1.45)};
  const double gap = static_cast<double>(close[1].z) / metre - 1, creep = 0.3 * 0.5 * gap;
  EXPECT_NEAR(first(close, {0, 40}).velocity.y, creep - (0.55 - gap) / 0.4, 1e-9);
  EXPECT_NEAR(first({at(0, 0, 0), at(1, 0, 1.45)}, {0, 40}).velocity.y, creep, 1e-9);
  tuning.legLength = 0.25;
  EXPECT_NEAR(first(close, {0, 40}).velocity.y, creep - 0.3 * 0.25, 1e-9)
      << "0.3 leg lengths a second at most";
}

TEST_F(Avoid, nobodyGoesBackIntoAWall) {
  const std::vector<Walker> close = {at(1, 0, 0), at(0, -0.3, 0.97)};
  EXPECT_LT(first(close, {0, 1}).velocity.y, -0.1);
  tuning.obstacles = {{.corners = {{-5, -0.5}, {5, -0.5}}, .radius = 0}};
  EXPECT_GE(first(close, {0, 1}).velocity.y, -1e-3);
}

TEST_F(Avoid, whoIsBlockedTurnsAway) {
  const AvoidResult result = first({at(0, 0, 0), at(1, 0, 1.56)}, {0, 1});
  EXPECT_LT(result.velocity.x, -0.4);
  EXPECT_LT(std::abs(result.velocity.y), 0.1);
  const auto sideways = [&](std::vector<Walker> others) {
    others.insert(others.begin(), at(0, 0, 0));
    return first(others, {0, 1}).velocity.x;
  };
  // +x is to its left. A tangent of the room of legs leads past either side.
  EXPECT_LT(sideways({at(1, 0.3, 1.6)}), -0.2);
  EXPECT_LT(sideways({at(1, -0.1, 1.6)}), -0.2) << "a little to the right";
  EXPECT_GT(sideways({at(1, -0.9, 1.3)}), 0.2);
  EXPECT_NEAR(sideways({at(1, -1, 1.2), at(2, 1, 1.2)}), 0, 0.1) << "between two";
}

TEST_F(Avoid, noSpeedAboveTheWantedOneButToPart) {
  // From all sides but one.
  const std::vector<Walker> all = {at(0, 0, 0), at(1, 0.2, 0), at(2, 0, 0.2), at(3, 0, -0.2)};
  const double parting = glm::length(first(all, {0, 0}).velocity);
  EXPECT_GT(parting, 0.2);
  EXPECT_LE(parting, 0.3 + 1e-9);
  EXPECT_LE(glm::length(first(all, {1, 0}).velocity), 1 + 1e-9);
}

// Lattice points of one distance, the numbers the other way round.
TEST_F(Avoid, theNearestAreOfLeastPowerThenNumber) {
  std::vector<Walker> all = {at(100, 0, 0)};
  int64_t number = 30;
  for (const auto& [x, z] : std::vector<std::pair<int64_t, int64_t>>{{1500, 0},
                                                                     {0, 1500},
                                                                     {-1500, 0},
                                                                     {0, -1500},
                                                                     {900, 1200},
                                                                     {-900, 1200},
                                                                     {900, -1200},
                                                                     {-900, -1200},
                                                                     {1200, 900},
                                                                     {-1200, 900},
                                                                     {1200, -900},
                                                                     {-1200, -900}}) {
    Walker other = at(--number, 0, 0);
    other.x = x, other.z = z;
    all.push_back(other);
  }
  // Farther, but larger: 1,800^2 - 1,612^2 is less than 1,500^2 - 1,024^2.
  Walker large = at(99, 0, 0);
  large.x = 1800, large.radius = 1100;
  all.push_back(large);
  // Just in reach, and just out of it.
  Walker far = at(1, 0, 0);
  far.z = 3072;
  all.push_back(far);
  far.number = 2, far.z = 3073;
  all.push_back(far);
  const AvoidResult result = first(all, {0, 1});
  EXPECT_EQ(result.seen, 14);
  std::vector<int64_t> numbers;
  for (const reference::HalfPlane& plane : result.planes) numbers.push_back(plane.neighbour);
  EXPECT_EQ(numbers, (std::vector<int64_t>{99, 18, 19, 20, 21, 22, 23, 24}));
}

TEST_F(Avoid, theOrderOfOthersDoesNotMatter) {
  std::vector<Walker> all = {at(7, 0, 0, {0, 1}), at(1, 1, 1, {-1, 0}), at(2, -1, 1.5, {0.5, 0}),
                             at(3, 0, 2, {0, -1}), at(4, 0.5, -1, {0, 1})};
  const glm::dvec2 velocity = first(all, {0, 1}).velocity;
  std::reverse(all.begin() + 1, all.end());
  EXPECT_EQ(first(all, {0, 1}).velocity, velocity);
}

TEST_F(Avoid, aSleeperIsWokenByWhoComes) {
  EXPECT_TRUE(first({at(0, 0, 0), at(1, 0, 1.6)}, {0, 0}, true).asleep);
  EXPECT_FALSE(first({at(0, 0, 0), at(1, 0, 1.6, {0, -1})}, {0, 0}, true).asleep);
  EXPECT_FALSE(first({at(0, 0, 0), at(1, 0, 1.5)}, {0, 0}, false).asleep);
}

TEST_F(Avoid, nobodyIsInAnEmptyPlace) {
  reference::AgentBody body;
  body.absent = true;
  const AvoidResult result = reference::avoid(tuning, tick, body, {}, {}, {0, 0}, true);
  EXPECT_TRUE(result.asleep);
  EXPECT_EQ(result.velocity, glm::dvec2(0));
}

TEST_F(Avoid, placesAreWholeQuanta) {
  reference::AgentBody body;
  body.tileX = -2, body.localX = 15.9999;
  body.tileZ = 3, body.localZ = 0.5;
  body.heading = {0.6, 0.8}, body.speed = 2;
  const Walker walker = reference::walkerOf(body, 11, 400, true, 1024);
  EXPECT_EQ(walker.x, -2 * 16384 + 16383);
  EXPECT_EQ(walker.z, 3 * 16384 + 512);
  EXPECT_EQ(walker.radius, 400);
  EXPECT_NEAR(glm::length(walker.velocity - glm::dvec2(1.2, 1.6)), 0, 1e-12);
}

}  // namespace
}  // namespace skitter::test
