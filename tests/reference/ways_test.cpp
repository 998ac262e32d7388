// Cost grids, times and the way along them, by hand (docs/ways.md).
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "cpu_reference/stages/navigate.h"
#include "cpu_reference/ways/grid.h"
#include "spider.h"
#include "validation/convert.h"

namespace skitter::test {
namespace {

using reference::WayGrid;
using reference::WayObstacles;

constexpr double kWall = std::numeric_limits<double>::infinity();
// The method itself errs by this, ten cells and more from a goal: 0.073 at most and 0.021 in the mean where
// docs/ways.md has it, for a goal at a middle.
constexpr double kWorstError = 0.075, kMeanError = 0.022;

// 8 m a side, a sample every 0.25 m: cells of 1 m for legs of 2 m.
struct Ground {
  template <class Height>
  explicit Ground(const Height& height) {
    for (int z = 0; z < 33; ++z)
      for (int x = 0; x < 33; ++x) samples.push_back(static_cast<float>(height(0.25 * x - 4)));
  }
  reference::Heights heights() const { return {samples.data(), 33, 33, -4, -4, 4, 4}; }
  std::vector<float> samples;
};
Ground level() {
  return Ground([](double) { return 0.0; });
}

reference::WayTuning usual() {
  return {.legLength = 2, .footprint = 0, .edgeMargin = 0, .climb = 1.5, .steepest = 1.5, .step = 0.5};
}

size_t cellAtPlace(const WayGrid& grid, double x, double z) {
  return static_cast<size_t>(std::floor(z + 4)) * grid.columns + static_cast<size_t>(std::floor(x + 4));
}

TEST(WayGrid, OfLevelGroundIsOneEverywhere) {
  const Ground ground = level();
  const WayGrid grid = reference::wayGrid(ground.heights(), {}, usual());
  ASSERT_EQ(grid.columns, 8u);
  ASSERT_EQ(grid.rows, 8u);
  EXPECT_EQ(grid.cell, 1);
  EXPECT_EQ(grid.middle(0), glm::dvec2(-3.5, -3.5));
  EXPECT_EQ(grid.middle(10), glm::dvec2(-1.5, -2.5));
  for (const double cost : grid.cost) EXPECT_EQ(cost, 1);
}

TEST(WayGrid, HasTwoCellsASideAtLeast) {
  const Ground ground = level();
  reference::WayTuning tuning = usual();
  tuning.legLength = 100;
  const WayGrid grid = reference::wayGrid(ground.heights(), {}, tuning);
  EXPECT_EQ(grid.columns, 2u);
  EXPECT_EQ(grid.rows, 2u);
  EXPECT_EQ(grid.cell, 50);
}

TEST(WayGrid, SlopesCostTimeUntilTheyAreTooSteep) {
  const Ground ground([](double x) { return 0.5 * x; });
  reference::WayTuning tuning = usual();
  for (const double cost : reference::wayGrid(ground.heights(), {}, tuning).cost) {
    EXPECT_NEAR(cost, 1.75, 1e-12);
  }
  tuning.steepest = 0.49;
  for (const double cost : reference::wayGrid(ground.heights(), {}, tuning).cost) EXPECT_EQ(cost, kWall);
}

TEST(WayGrid, LedgesStopWhoseLegsAreShort) {
  const Ground ground([](double x) { return x < 0 ? 0.0 : 1.0; });
  reference::WayTuning tuning = usual();
  tuning.steepest = 2;
  // The rise of 1 m at the side of a cell of 1 m is a slope of 1 and a ledge of 0.5 m.
  tuning.step = 0.26;  // 0.52 m
  const WayGrid climbed = reference::wayGrid(ground.heights(), {}, tuning);
  EXPECT_NEAR(climbed.cost[cellAtPlace(climbed, -0.5, 0.5)], 2.5, 1e-12);
  EXPECT_EQ(climbed.cost[cellAtPlace(climbed, 0.5, 0.5)], 1);
  tuning.step = 0.24;
  const WayGrid stopped = reference::wayGrid(ground.heights(), {}, tuning);
  EXPECT_EQ(stopped.cost[cellAtPlace(stopped, -0.5, 0.5)], kWall);
  EXPECT_EQ(stopped.cost[cellAtPlace(stopped, -1.5, 0.5)], 1);
}

TEST(WayGrid, ObstaclesGrowByTheFootprint) {
  const Ground ground = level();
  reference::WayTuning tuning = usual();
  tuning.footprint = 0.9;
  const auto isFree = [&](const WayObstacles& obstacles, double x, double z) {
    const WayGrid grid = reference::wayGrid(ground.heights(), obstacles, tuning);
    return grid.passable(cellAtPlace(grid, x, z));
  };
  // Distances of middles from the disc: below 0, 0.58, 1.12.
  const WayObstacles disc{.discs = {{{0, 0}, 1}}};
  EXPECT_FALSE(isFree(disc, 0.5, 0.5));
  EXPECT_FALSE(isFree(disc, 1.5, 0.5));
  EXPECT_TRUE(isFree(disc, 1.5, 1.5));
  // From the line of the capsule: 0.5, 1.5 less 0.7, and 1.5 beyond its end.
  const WayObstacles capsule{.capsules = {{{-4, 0}, {0, 0}, 0.7}}};
  EXPECT_FALSE(isFree(capsule, -2.5, 0.5));
  EXPECT_FALSE(isFree(capsule, -2.5, 1.5));
  EXPECT_TRUE(isFree(capsule, -2.5, 2.5));
  EXPECT_TRUE(isFree(capsule, 2.5, 0.5));
  for (const bool reversed : {false, true}) {
    WayObstacles square{.polygons = {{{{0, 0}, {2, 0}, {2, 2}, {0, 2}}}}};
    if (reversed) square.polygons[0].corners = {{0, 2}, {2, 2}, {2, 0}, {0, 0}};
    EXPECT_FALSE(isFree(square, 1.5, 1.5));
    EXPECT_FALSE(isFree(square, -0.5, 0.5));
    EXPECT_FALSE(isFree(square, -0.5, -0.5));  // 0.71 from the corner
    EXPECT_TRUE(isFree(square, -1.5, 0.5));
  }
}

TEST(WayGrid, WallsWithoutWidthHaveNoHole) {
  const Ground ground = level();
  const WayObstacles wall{.capsules = {{{-4, -3}, {4, 2.3}, 0}}};
  const WayGrid grid = reference::wayGrid(ground.heights(), wall, usual());
  // A region on either side: the goal's has its cells, the other one stop.
  size_t stops = 0;
  for (const reference::WayStart& start : reference::wayStarts(grid, {-2.5, 2.5})) stops += start.time == 0;
  EXPECT_EQ(stops, 2u);
}

// 5 x 2 cells of 2 m.
WayGrid strip() {
  return {.columns = 5,
          .rows = 2,
          .cell = 2,
          .origin = {0, 0},
          .cost = std::vector<double>(10, 1.0),
          .margin = std::vector<double>(10, 1.0)};
}

TEST(WayTimes, FollowFromTheirNeighbours) {
  const std::vector<reference::WayStart> start = {{0, 0}};
  const std::vector<double> times = reference::wayTimes(strip(), start, 10);
  EXPECT_EQ(times[0], 0);
  EXPECT_EQ(times[1], 2);
  EXPECT_EQ(times[2], 4);
  EXPECT_EQ(times[5], 2);
  EXPECT_NEAR(times[6], 2 + std::sqrt(2.0), 1e-12);
  // Between 3.41421 and 4.
  EXPECT_NEAR(times[7], 5.0906579, 1e-6);
}

TEST(WayTimes, WallsAreGoneRoundAndLeft) {
  WayGrid grid = strip();
  grid.cost[1] = kWall;
  const std::vector<reference::WayStart> start = {{0, 0}};
  const std::vector<double> times = reference::wayTimes(grid, start, 10);
  EXPECT_EQ(times[5], 2);
  EXPECT_EQ(times[6], 4);
  EXPECT_EQ(times[7], 6);
  EXPECT_EQ(times[2], 8);
  // From 0 and 8 in x, from 4 in z, where a cell takes 20: (0 + 4 + sqrt(800 - 16)) / 2.
  EXPECT_NEAR(times[1], 16, 1e-12);
}

TEST(WayTimes, AreNoneWhereNothingLeadsTo) {
  const std::vector<double> times = reference::wayTimes(strip(), {}, 10);
  for (const double time : times) EXPECT_EQ(time, kWall);
}

TEST(WayTimes, AreAFewPercentLongerThanDistancesFromTenCellsOn) {
  WayGrid grid = strip();
  grid.columns = grid.rows = 101;
  grid.cell = 1;
  grid.cost.assign(grid.cells(), 1);
  grid.margin.assign(grid.cells(), 1);
  const glm::dvec2 goal(50.5, 50.5);
  const std::vector<double> times = reference::wayTimes(grid, reference::wayStarts(grid, goal), 10);
  double worst = 0, sum = 0;
  int count = 0;
  for (size_t at = 0; at < grid.cells(); ++at) {
    const double distance = glm::length(grid.middle(at) - goal);
    if (distance < 10) continue;
    const double error = (times[at] - distance) / distance;
    EXPECT_GT(error, -1e-12);
    worst = std::max(worst, error);
    sum += error;
    ++count;
  }
  EXPECT_LT(worst, kWorstError);
  EXPECT_LT(sum / count, kMeanError);
}

TEST(WayStarts, AreAroundTheGoalAndNearestToItElsewhere) {
  WayGrid grid = strip();
  for (const size_t wall : {2u, 7u}) grid.cost[wall] = kWall;
  const std::vector<reference::WayStart> starts = reference::wayStarts(grid, {2.5, 2});
  // Middles at (1, 1), (3, 1), (1, 3), (3, 3); beyond the wall (7, 1) before (7, 3), as near.
  ASSERT_EQ(starts.size(), 5u);
  EXPECT_NEAR(starts[0].time, std::hypot(1.5, 1), 1e-12);
  EXPECT_NEAR(starts[1].time, std::hypot(0.5, 1), 1e-12);
  EXPECT_EQ(starts[4].cell, 3u);
  EXPECT_EQ(starts[4].time, 0);
  // In the wall.
  const std::vector<reference::WayStart> beside = reference::wayStarts(grid, {4.9, 1});
  ASSERT_EQ(beside.size(), 2u);
  EXPECT_EQ(beside[0].cell, 1u);
  EXPECT_EQ(beside[1].cell, 3u);
}

class FollowWay : public testing::Test {
 protected:
  reference::Tuning tuning = validation::tuningOf(parametersFor(flatField()));
  // Times rise by 2 in x and by 1 in z from cell to cell.
  reference::WayField way{.goal = {50, 50},
                          .stop = {40, 41},
                          .columns = 4,
                          .rows = 3,
                          .cell = 1,
                          .origin = {0, 0},
                          .cost = std::vector<double>(12, 1),
                          .times = {9, 11, 13, 15, 10, 12, 14, 16, 11, 13, 15, 17}};
};

TEST_F(FollowWay, GoesDownTheTimes) {
  const auto result = reference::followWay(tuning, way, {1.25, 1.75}, 3, 0.5);
  EXPECT_FALSE(result.straight);
  EXPECT_NEAR(result.desired.x, -3 * 2 / std::sqrt(5.0), 1e-12);
  EXPECT_NEAR(result.desired.y, -3 * 1 / std::sqrt(5.0), 1e-12);
  EXPECT_NEAR(result.lowerMargin.x, 0.75, 1e-12);
  EXPECT_NEAR(result.upperMargin.y, 0.75, 1e-12);
}

// Between cells 5, 6, 9 and 10, of which some are walls. A wall's own time, which leads out of it, is 50.
TEST_F(FollowWay, LeadsAlongWallsBesideThem) {
  const auto gradientWith = [&](std::vector<size_t> walls) {
    reference::WayField walled = way;
    for (const size_t wall : walls) {
      walled.cost[wall] = kWall;
      walled.times[wall] = 50;
    }
    // In the middle of the four, so that the gradient is the mean of the differences.
    const glm::dvec2 desired = reference::followWay(tuning, walled, {2, 2}, 1, 0.5).desired;
    return desired / -glm::length(desired);
  };
  const auto expectAlong = [&](std::vector<size_t> walls, const glm::dvec2& gradient) {
    const glm::dvec2 found = gradientWith(walls), unit = glm::normalize(gradient);
    EXPECT_NEAR(found.x, unit.x, 1e-12) << walls.size() << " walls";
    EXPECT_NEAR(found.y, unit.y, 1e-12) << walls.size() << " walls";
  };
  expectAlong({}, {2, 1});
  // Above: 12 and 14 go on as 12.3 and 14.3. On the left: 14 and 15 as 14.3 and 15.3.
  expectAlong({9, 10}, {2, 0.3});
  expectAlong({5, 9}, {-0.3, 1});
  // One: 14 + 13 - 12 and more where the way comes from there; not less than beside it where it goes there.
  expectAlong({10}, {2 + 0.15, 1 + 0.15});
  expectAlong({5}, {((14 - 14.3) + 2) / 2, ((13 - 14.3) + 1) / 2});
  // Across from each other, 12 and 15: 15.3 both. Three, about 15: 15.3, 15.3 and 15.6.
  expectAlong({6, 9}, {((15.3 - 12) + (15 - 15.3)) / 2, ((15.3 - 12) + (15 - 15.3)) / 2});
  expectAlong({5, 6, 9}, {-0.3, -0.3});
  // Inside, a wall's own times lead.
  reference::WayField inside = way;
  inside.cost.assign(12, kWall);
  EXPECT_EQ(reference::followWay(tuning, inside, {2, 2}, 1, 0.5).desired,
            reference::followWay(tuning, way, {2, 2}, 1, 0.5).desired);
}

TEST_F(FollowWay, SlowsAndStopsByTheTime) {
  for (double& time : way.times) time -= 8.9;
  // At (0.5, 0.5) the time is 0.1; half a cell further 1.1.
  EXPECT_EQ(reference::followWay(tuning, way, {0.5, 0.5}, 3, 0.5).desired, glm::dvec2(0));
  const double share = std::min(1.0, 1.1 / tuning.slowRadius);
  EXPECT_NEAR(glm::length(reference::followWay(tuning, way, {1, 0.5}, 3, 0.5).desired), 3 * share, 1e-12);
}

TEST_F(FollowWay, IsStraightNearTheStop) {
  way.stop = {1, 1};
  EXPECT_TRUE(reference::followWay(tuning, way, {2.2, 1}, 3, 0.5).straight);
  EXPECT_FALSE(reference::followWay(tuning, way, {2.3, 1}, 3, 0.5).straight);
}

TEST(WayNext, DrawsOneOfTheChoices) {
  reference::WayPlace place{{0, 0}, 10, 1};
  EXPECT_EQ(reference::wayNext(place, 5).number, 10u);
  // 5 * 1140671485 + 12820163 = 5716177588 = 340 * 2^24 + 11924148.
  EXPECT_EQ(reference::wayNext(place, 5).draw, 11924148u);
  place.choices = 8;
  std::vector<size_t> counts(8, 0);
  uint32_t draw = 5;
  for (int i = 0; i < 8000; ++i) {
    const reference::WayNext next = reference::wayNext(place, draw);
    ASSERT_LT(next.draw, 1u << 24);
    ++counts.at(next.number - 10);
    draw = next.draw;
  }
  // Binomial with a standard deviation of 30.
  for (const size_t count : counts) EXPECT_NEAR(static_cast<double>(count), 1000, 5 * 30);
}

TEST(WayStarts, OfThoseWhoFleeAreAllPassableCells) {
  WayGrid grid{.columns = 3, .rows = 2, .cell = 1, .cost = {1, kWall, 2, 1, 1, kWall}};
  const auto starts = reference::wayStarts(grid, glm::dvec2(reference::wayOut));
  ASSERT_EQ(starts.size(), 4u);
  for (const reference::WayStart& start : starts) {
    EXPECT_TRUE(grid.passable(start.cell));
    EXPECT_EQ(start.time, 0);
  }
  const std::vector<double> times = reference::wayTimes(grid, starts, 10);
  // Cells beside passable ones on both axes, at cost 10.
  EXPECT_NEAR(times[1], 10 / std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(times[5], 10 / std::sqrt(2.0), 1e-12);
}

TEST_F(FollowWay, GoesOnFromPlaceToPlace) {
  std::vector<reference::WayField> ways = {way, way};
  ways[0].goal = {50, 50};
  ways[1].goal = {60, 60};
  std::vector<reference::WayPlace> places = {{{50, 50}, 1, 1}, {{60, 60}, 0, 0}};
  reference::Goal goal{{7, 7}, {0, 123}, 1, 0.5, reference::GoalKind::series};
  const auto run = [&] { return reference::navigate(tuning, bodyAt(1, 1), goal, {}, {}, ways, places); };
  // Its time is more than four arrival radii; the place is where the table has it.
  EXPECT_EQ(run().goal.target, glm::dvec2(50, 50));
  EXPECT_EQ(run().goal.otherEnd, glm::dvec2(0, 123));
  EXPECT_LT(run().desired.x, 0);
  for (double& time : ways[0].times) time -= 8.9;
  const reference::NavigateResult passed = run();
  EXPECT_EQ(passed.goal.target, glm::dvec2(60, 60));
  EXPECT_EQ(passed.goal.otherEnd, glm::dvec2(1, reference::wayNext(places[0], 123).draw));
  // The last place of a route stays, and without a field an agent stands.
  places[0].choices = 0;
  EXPECT_EQ(run().goal.otherEnd, glm::dvec2(0, 123));
  ways.clear();
  EXPECT_EQ(run().desired, glm::dvec2(0));
}

TEST_F(FollowWay, IsForGoalsOfKindPointThatHaveAField) {
  reference::Goal goal{{50, 50}, {0, 0}, 1, 0.5, reference::GoalKind::point};
  const std::vector<reference::WayField> ways = {way};
  const auto velocity = [&] { return reference::navigate(tuning, bodyAt(1, 1), goal, {}, {}, ways).desired; };
  EXPECT_LT(velocity().x, 0);
  goal.target.x = 50.001;
  EXPECT_GT(velocity().x, 0);
  goal.target.x = 50;
  goal.kind = reference::GoalKind::cross;
  EXPECT_GT(velocity().x, 0);
}

}  // namespace
}  // namespace skitter::test
