#include "app/run/jams.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace skitter::test {
namespace {

using app::Advance;
using app::FlowMap;
using app::LegLines;
using app::Standing;

// An agent of half a metre that wants to go toward +z and went so far in ten seconds.
Advance agentAt(double x, double z, double moved = 0) {
  return {.now = {x, z}, .moved = moved, .wanted = {0, 1}, .radius = 0.5, .isThere = true, .hasPoint = true};
}

TEST(Jams, WhoStandsWithAFreeWayAheadIsStuck) {
  // Somebody is behind, aside, and ahead more than a body length away.
  const std::vector<Advance> agents = {agentAt(0, 0, 0.09), agentAt(0, -1.2, 3), agentAt(1.2, 0.1, 3),
                                       agentAt(0, 2.1, 3)};
  EXPECT_EQ(app::standingsOf(agents).front(), Standing::stuck);
  EXPECT_EQ(app::standingsOf(std::vector{agentAt(0, 0, 0.11)}).front(), Standing::moves);
}

TEST(Jams, WhoComesBackHasMoved) {
  const std::vector<glm::dvec2> places = {{1, 2}, {1, 2.5}, {1.3, 2.4}, {1, 2}};
  EXPECT_DOUBLE_EQ(app::movedFrom(places, places.back()), 0.5);
  EXPECT_EQ(app::movedFrom(std::vector(3, places[1]), places[1]), 0);
  EXPECT_EQ(app::movedFrom({}, places[1]), 0);
}

TEST(Jams, AQueueWaitsAsLongAsItsHeadMoves) {
  std::vector<Advance> queue = {agentAt(0, 0), agentAt(0, 1.3), agentAt(0.3, 2.6), agentAt(0, 4, 1)};
  using enum Standing;
  EXPECT_EQ(app::standingsOf(queue), (std::vector{waits, waits, waits, moves}));
  queue.back().moved = 0;
  EXPECT_EQ(app::standingsOf(queue), (std::vector{stuck, stuck, stuck, stuck}));
  // It stands where it wants to be, and so do those behind it.
  queue.back().wanted = {0, 0};
  EXPECT_EQ(app::standingsOf(queue), (std::vector{arrived, arrived, arrived, arrived}));
  queue.back().hasPoint = false;
  EXPECT_EQ(app::standingsOf(queue), (std::vector{stuck, stuck, stuck, moves})) << "it never wanted to go";
  queue.back().isThere = false;
  EXPECT_EQ(app::standingsOf(queue)[2], stuck);
  EXPECT_TRUE(app::standingsOf({}).empty());
}

TEST(Jams, FlowIsThatOfTheBusiestSquare) {
  FlowMap flow(2);
  EXPECT_FALSE(flow.most());
  // One agent a second crosses a square of 2 m along z, all 2 m of it: 1 / 2 m and second.
  for (int second = 0; second <= 20; ++second)
    for (int step = 0; step < 4; ++step)
      flow.add({1, 0.5 * step}, {1, 0.5 * (step + 1)}, second + 0.2 * step);
  flow.add({9, 9}, {9, 9.9}, 3);  // too short a time to tell
  ASSERT_TRUE(flow.most());
  EXPECT_NEAR(flow.most()->flow, 21 * 2 / (4 * 20.6), 1e-9);
}

TEST(Jams, APauseEndsWithWhoComesIn) {
  FlowMap flow(2);
  // They come at 0, 1, 2, 7 and 12 s.
  for (const double second : {0, 1, 2, 7, 12}) {
    flow.add({1, -0.5}, {1, 0.5}, second);
    flow.add({1, 0.5}, {1, 1.5}, second + 0.1);
  }
  ASSERT_TRUE(flow.most());
  EXPECT_NEAR(flow.most()->pause, 5, 1e-9);
  flow.add({1, 1.5}, {1, 0.5}, 19);
  EXPECT_NEAR(flow.most()->pause, 7, 1e-9) << "the last one turned about, and nobody has come since";
}

// Most go along z, so squares of 2 m beside the busiest one are those along x.
TEST(Jams, WhoComesInBesideEndsAPauseToo) {
  const auto pauseWith = [](const glm::dvec2& from, const glm::dvec2& to) {
    FlowMap flow(2);
    for (const double x : {-1.0, -3.0, 3.0}) flow.add({x, 1}, {x, 1.1}, 0);  // somebody was there
    for (const double second : {0, 1, 2, 12}) {
      if (second == 12) flow.add(from, to, 9);
      flow.add({1, -0.5}, {1, 0.5}, second);
      flow.add({1, 0.5}, {1, 1.5}, second + 0.1);
    }
    return flow.most().value().pause;
  };
  EXPECT_NEAR(pauseWith({-1, -0.5}, {-1, 0.5}), 7, 1e-9);
  EXPECT_NEAR(pauseWith({3, 2.5}, {3, 1.5}), 7, 1e-9) << "from either side";
  EXPECT_NEAR(pauseWith({-2.5, 1}, {-1.5, 1}), 7, 1e-9) << "from farther aside";
  EXPECT_NEAR(pauseWith({-3, -0.5}, {-3, 0.5}), 10, 1e-9) << "two squares aside";
  EXPECT_NEAR(pauseWith({3, 1}, {1.5, 1}), 10, 1e-9) << "from beside into the busiest one";
  EXPECT_NEAR(pauseWith({1, 1}, {1.5, 1}), 10, 1e-9) << "nobody came in";
  EXPECT_NEAR(pauseWith({1, 2.5}, {1, 1.5}), 7, 1e-9);
}

TEST(Jams, WhoGetsOnAtLessThanHalfOfItsSpeedIsInOne) {
  EXPECT_FALSE(app::isInJam(2, 1.1));
  EXPECT_TRUE(app::isInJam(2, 0.9));
  EXPECT_FALSE(app::isInJam(0, 0)) << "it wants to stand";
  EXPECT_FALSE(app::isInJam(2, NAN)) << "it is not there";
}

TEST(Jams, LegsCrossAsSeenFromAbove) {
  const LegLines along = {{{0, 0}, {1, 0}, {2, 0.5}}}, across = {{{5, 5}, {6, 6}}, {{1.5, -1}, {1.5, 1}}};
  const LegLines beside = {{{1.5, 0.3}, {1.5, 1}}};
  EXPECT_TRUE(app::legsCross(along, across));
  EXPECT_TRUE(app::legsCross(across, along));
  EXPECT_FALSE(app::legsCross(along, beside));
  EXPECT_FALSE(app::legsCross(along, {}));
  const std::vector<LegLines> agents = {along, across, beside, along};
  EXPECT_EQ(app::crossingAgents(agents, std::vector<glm::dvec2>{{0, 0}, {1.5, 0}, {1.5, 0.5}, {NAN, NAN}}, 2),
            (std::vector{true, true, false, false}));
  // Too far from each other to be looked at.
  EXPECT_EQ(app::crossingAgents(agents, std::vector<glm::dvec2>{{0, 0}, {9, 9}, {1.5, 0.5}, {NAN, NAN}}, 2),
            std::vector<bool>(4));
}

}  // namespace
}  // namespace skitter::test
