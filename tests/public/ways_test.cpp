#include "skitter/ways.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "public/public.h"

namespace skitter::test {
namespace {

// Cells of half a metre on flatGround(): 64 x 64 of them from (-16, -16) on.
const Traveller wayTraveller{.legLength = 1, .footprint = 0.6f};

glm::vec2 middleOf(const CostGrid& grid, uint32_t column, uint32_t row) {
  return grid.origin + grid.cell * (glm::vec2(column, row) + 0.5f);
}

// Cells of the grid cost 1, and those whose distance is less than `near` are impassable.
template <class Distance>
void expectOff(const CostGrid& grid, float near, const Distance& distance) {
  ASSERT_EQ(grid.cost.size(), size_t{grid.columns} * grid.rows);
  size_t impassable = 0;
  for (uint32_t row = 0; row < grid.rows; ++row)
    for (uint32_t column = 0; column < grid.columns; ++column) {
      const float left = distance(middleOf(grid, column, row)) - near;
      const float cost = grid.cost[size_t{row} * grid.columns + column];
      if (std::abs(left) < 1e-4f) continue;  // 16 m in float32 and a root of it
      EXPECT_EQ(std::isinf(cost), left < 0) << column << ", " << row;
      if (left > 0) {
        EXPECT_EQ(cost, 1) << column << ", " << row;
      }
      impassable += left < 0;
    }
  EXPECT_GT(impassable, 0u);
  EXPECT_LT(impassable, grid.cost.size() / 2);
}

TEST(PublicWays, GridsAreOverTheWholeGround) {
  const CostGrid grid = costGrid(flatGround(), {}, wayTraveller);
  EXPECT_EQ(grid.columns, 64u);
  EXPECT_EQ(grid.rows, 64u);
  EXPECT_EQ(grid.cell, 0.5f);
  EXPECT_EQ(grid.origin, glm::vec2(-16));
  EXPECT_EQ(grid.cost, std::vector<float>(64 * 64, 1));
  EXPECT_EQ(costGrid(flatGround(), {}, {.legLength = 4}).columns, 16u);
  // Beyond 14 m of the middle.
  const CostGrid inner = costGrid(flatGround(), {}, {.margin = 2});
  EXPECT_EQ(std::ranges::count(inner.cost, 1.0f), 56 * 56);
}

TEST(PublicWays, GridsKnowWhatStandsThere) {
  const std::vector<Obstacle> obstacles = {
      {Disc{.centre = {-8, -8}, .radius = 2}},
      {Capsule{.from = {-5, 8}, .to = {5, 8}, .radius = 0.5f}},
      {ConvexPolygon{.corners = {{6, -9}, {10, -9}, {10, -3}, {6, -3}}}},
  };
  expectOff(costGrid(flatGround(), obstacles, wayTraveller), 0.6f, [](const glm::vec2& place) {
    const glm::vec2 onLine(std::clamp(place.x, -5.0f, 5.0f), 8);
    const glm::vec2 inPolygon = glm::clamp(place, glm::vec2(6, -9), glm::vec2(10, -3));
    return std::min({glm::distance(place, glm::vec2(-8)) - 2, glm::distance(place, onLine) - 0.5f,
                     glm::distance(place, inPolygon)});
  });
}

// Half of a cell's diagonal, so that a line has no hole.
TEST(PublicWays, ThinWallsAreClosed) {
  const Obstacle line{Capsule{.from = {-9, -7}, .to = {9, -7}}};
  expectOff(costGrid(flatGround(), {&line, 1}, {.legLength = 1}), std::sqrt(0.125f),
            [](const glm::vec2& place) {
              return glm::distance(place, glm::vec2(std::clamp(place.x, -9.0f, 9.0f), -7));
            });
}

TEST(PublicWays, SlopesTakeLongerAndAreNotClimbedWhereSteep) {
  Heightfield ground = flatGround();
  for (size_t i = 0; i < ground.heights.size(); ++i)
    ground.heights[i] = 0.4f * ground.spacingX * static_cast<float>(i % ground.columns);
  // Heights up to 13 m in float32, over a quarter of a metre.
  for (const float cost : costGrid(ground, {}, wayTraveller).cost) ASSERT_NEAR(cost, 1 + 1.5 * 0.4, 1e-4);
  for (const float cost : costGrid(ground, {}, {.ways = {.climb = 5}}).cost) ASSERT_NEAR(cost, 3, 1e-4);
  for (const float cost : costGrid(ground, {}, {.ways = {.steepest = 0.39f}}).cost)
    ASSERT_TRUE(std::isinf(cost));
}

// Up by 0.6 m in the eastern half of cells of a metre: 0.3 m more than their slope of 0.6 makes of it.
TEST(PublicWays, LedgesStopThoseWhoCannotStepSoHigh) {
  Heightfield ground = flatGround();
  for (size_t i = 0; i < ground.heights.size(); ++i)
    ground.heights[i] = i % ground.columns > 33 ? 0.6f : 0.0f;
  const auto costAtLedge = [&](float step) {
    const CostGrid grid = costGrid(ground, {}, {.legLength = 2, .ways = {.step = step}});
    EXPECT_EQ(grid.cost[15], 1);
    EXPECT_EQ(grid.cost[17], 1);
    return grid.cost[16];
  };
  EXPECT_NEAR(costAtLedge(0.16f), 1 + 1.5 * 0.6, 1e-4);
  EXPECT_TRUE(std::isinf(costAtLedge(0.14f)));
}

TEST(PublicWays, ThreatsAreKeptOff) {
  const CostGrid open = costGrid(flatGround(), {}, wayTraveller);
  CostGrid grid = open;
  keepOff(grid, std::vector<Threat>{{.centre = {5, 5}, .radius = 0}}, wayTraveller);
  EXPECT_EQ(grid, open);
  keepOff(grid, std::vector<Threat>{{.centre = {3, -2}, .radius = 4}}, wayTraveller);
  expectOff(grid, 4 + 0.6f + 0.5f,
            [](const glm::vec2& place) { return glm::distance(place, glm::vec2(3, -2)); });
}

TEST(PublicWays, RefusesObstaclesThatAreNone) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto refuse = [](const std::string& text, const Obstacle& wrong) {
    const std::vector<Obstacle> obstacles = {{Disc{}}, wrong};
    expectRefused("obstacles[1]." + text, [&] { costGrid(flatGround(), obstacles, wayTraveller); });
  };
  refuse("disc.centre[0] is nan, expected a number from -4096 to 4096", {Disc{.centre = {nan, 0}}});
  refuse("disc.radius is 0, expected a number from 0.01 to 4096", {Disc{.radius = 0}});
  refuse("capsule.from[1] is 5000", {Capsule{.from = {0, 5000}}});
  refuse("capsule.to[0] is -5000", {Capsule{.to = {-5000, 0}}});
  refuse("capsule.radius is -1, expected a number from 0 to 4096", {Capsule{.radius = -1}});
  refuse("polygon.corners has 2, expected 3 to 64", {ConvexPolygon{.corners = {{0, 0}, {1, 0}}}});
  refuse("polygon.corners has 65", {ConvexPolygon{.corners = std::vector<glm::vec2>(65)}});
  refuse("polygon.corners[2][1] is nan", {ConvexPolygon{.corners = {{0, 0}, {1, 0}, {0, nan}}}});
  refuse("polygon.corners is not convex", {ConvexPolygon{.corners = {{0, 0}, {1, 0}, {2, 0}}}});
}

TEST(PublicWays, RefusesGroundAndTravellersThatCannotBe) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto refuse = [](const std::string& text, const Traveller& wrong) {
    expectRefused(text, [&] { costGrid(flatGround(), {}, wrong); });
    CostGrid grid = costGrid(flatGround(), {}, wayTraveller);
    expectRefused(text, [&] { keepOff(grid, {}, wrong); });
  };
  refuse("traveller.legLength is nan, expected a finite number from 0 on", {.legLength = nan});
  refuse("traveller.footprint is -1", {.footprint = -1});
  refuse("traveller.margin is inf", {.margin = std::numeric_limits<float>::infinity()});
  refuse("traveller.ways.climb is -1", {.ways = {.climb = -1}});
  refuse("traveller.ways.steepest is nan", {.ways = {.steepest = nan}});
  refuse("traveller.ways.step is nan", {.ways = {.step = nan}});
  Heightfield ground = flatGround();
  ground.spacingX = nan;
  expectRefused("a spacing of nan m", [&] { costGrid(ground, {}, wayTraveller); });
  expectRefused("0 x 0 samples", [] { costGrid({}, {}, wayTraveller); });
}

TEST(PublicWays, RefusesThreatsThatAreNoneAndGridsThatCannotBe) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const CostGrid open = costGrid(flatGround(), {}, wayTraveller);
  const auto refuseThreat = [&](const std::string& text, const Threat& wrong) {
    CostGrid grid = open;
    expectRefused(text, [&] { keepOff(grid, std::vector<Threat>{{}, wrong}, wayTraveller); });
    EXPECT_EQ(grid, open);
  };
  refuseThreat("threats[1].centre[1] is nan, expected a number from -4096 to 4096", {.centre = {0, nan}});
  refuseThreat("threats[1].radius is -1, expected a number from 0 to 4096", {.radius = -1});
  const auto refuseGrid = [&](const std::string& text, const auto& change) {
    CostGrid grid = open;
    change(grid);
    expectRefused(text, [&] { keepOff(grid, std::vector<Threat>(1), wayTraveller); });
  };
  refuseGrid("64 x 64 cells has 4095 costs", [](CostGrid& grid) { grid.cost.pop_back(); });
  refuseGrid("0 x 0 cells has 0 costs", [](CostGrid& grid) { grid = {}; });
  refuseGrid("is 0 m, expected more than 0", [](CostGrid& grid) { grid.cell = 0; });
  refuseGrid("origin[1] of a grid is nan", [&](CostGrid& grid) { grid.origin.y = nan; });
}

}  // namespace
}  // namespace skitter::test
