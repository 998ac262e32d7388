// The reference's colony against values computed by hand from docs/colony.md.
#include "cpu_reference/ways/colony.h"

#include <gtest/gtest.h>

#include <limits>

namespace skitter::reference {
namespace {

constexpr float noColonyWay = std::numeric_limits<float>::infinity();

ColonyMap flatMap(uint32_t columns, uint32_t rows) {
  return {columns, rows, std::vector<float>(size_t{columns} * rows, 1.0f)};
}

TEST(Colony, AMoveIsAsLongAsItsCellsCost) {
  ColonyMap map = flatMap(3, 2);
  map.cost[1] = 2;
  map.cost[5] = noColonyWay;
  const Colony colony(map, {}, 0, 3);
  EXPECT_EQ(colony.moveLength(0, 3), 256u + 256);
  EXPECT_EQ(colony.moveLength(0, 1), 256u + 512);
  EXPECT_EQ(colony.moveLength(0, 4), 724u);   // (181 * 512 + 64) / 128 = 724.5
  EXPECT_EQ(colony.moveLength(1, 3), 1086u);  // (181 * 768 + 64) / 128 = 1086.5
  EXPECT_EQ(colony.moveLength(4, 5), Colony::noWay);
}

TEST(Colony, NobodyCutsACorner) {
  ColonyMap map = flatMap(2, 2);
  EXPECT_EQ(Colony(map, {}, 0, 3).moveLength(0, 3), 724u);
  map.cost[1] = noColonyWay;
  EXPECT_EQ(Colony(map, {}, 0, 3).moveLength(0, 3), Colony::noWay);
  EXPECT_EQ(Colony(map, {}, 0, 3).moveLength(2, 3), 512u);
}

// From the middle of five by five to the goal at (4, 2): detours 0, 724 + 724 - 1024 = 424 and 1024.
TEST(Colony, DetoursAreLessDesirable) {
  const auto towards = [](uint32_t to, uint32_t beta) {
    return Colony(flatMap(5, 5), {.beta = beta, .margin = 512}, 12, 14).desirability(12, to);
  };
  EXPECT_EQ(towards(13, 1), 4096u);
  EXPECT_EQ(towards(18, 1), 2240u);  // 4096 * 512 / 936 = 2240.5
  EXPECT_EQ(towards(11, 1), 1365u);  // 4096 * 512 / 1536
  EXPECT_EQ(towards(11, 2), 454u);   // 1365 * 1365 / 4096 = 454.9
  EXPECT_EQ(towards(11, 0), 4096u);
}

TEST(Colony, PheromoneEvaporatesAndIsDeposited) {
  Colony colony(flatMap(4, 1), {.ants = 2, .crew = 2, .steps = 9, .evaporation = 410}, 0, 3);
  colony.iterate();
  EXPECT_EQ(colony.best().cells, (std::vector<uint32_t>{0, 1, 2, 3}));
  EXPECT_EQ(colony.best().length, 1536u);
  EXPECT_EQ(colony.found(), 1u);
  // 2^20 * 410 / 4096 = 104960 evaporate.
  EXPECT_EQ(colony.pheromone()[0], 1048576u);
  EXPECT_EQ(colony.pheromone()[1], 943616u);
  EXPECT_EQ(colony.pheromone()[8 * 3], 943616u);
}

// Two ants cross each move; 2^19 is the least. On the way: (2^20 - 2^19) * 2048 / 4096 = 2^18 are deposited.
TEST(Colony, OfAcsOnlyTheBestWayIsDeposited) {
  const uint32_t half = 1u << 19;
  ColonyRecipe recipe{.rule = ColonyRule::acs, .ants = 2, .crew = 1, .steps = 9, .evaporation = 2048};
  recipe.least = half;
  recipe.wear = 1024;
  Colony colony(flatMap(3, 1), recipe, 0, 2);
  colony.iterate();
  EXPECT_EQ(colony.pheromone()[0], half + half / 2);
  EXPECT_EQ(colony.pheromone()[8 * 1 + 4], half);
  colony.iterate();
  // 2^18 above the least: less a quarter twice, 147456; half of the 376832 that the most is above that more.
  EXPECT_EQ(colony.pheromone()[0], half + 147456 + 188416);
}

TEST(Colony, AnAntComesBackOutOfADeadEnd) {
  for (uint64_t seed = 0; seed < 32; ++seed) {
    Colony colony(flatMap(6, 1), {.steps = 12, .seed = seed}, 3, 5);
    colony.iterate();
    ASSERT_TRUE(colony.trips()[0].arrived) << seed;
    EXPECT_EQ(colony.trips()[0].cells, (std::vector<uint32_t>{3, 4, 5}));
    EXPECT_EQ(colony.trips()[0].length, 1024u);
  }
}

TEST(Colony, AWayIsTightened) {
  const Colony colony(flatMap(3, 3), {}, 0, 8);
  ColonyTrip trip{.arrived = true, .length = 2048, .cells = {0, 1, 2, 5, 8}};
  EXPECT_TRUE(colony.tighten(trip));
  EXPECT_EQ(trip.cells, (std::vector<uint32_t>{0, 4, 8}));
  EXPECT_EQ(trip.length, 1448u);
  EXPECT_FALSE(colony.tighten(trip));
}

TEST(Colony, TheShortestWayGoesAroundWhatCosts) {
  ColonyMap map = flatMap(3, 3);
  for (const uint32_t cell : {1u, 4u}) map.cost[cell] = 9;
  const Colony colony(map, {}, 3, 5);
  // 3, 4, 5: twice 256 + 2304. 3, 7, 5: twice 724.
  EXPECT_EQ(colony.shortest(), 1448u);
}

TEST(Colony, AChangeIsForgottenNearItAlone) {
  Colony colony(flatMap(6, 1), {.steps = 20, .evaporation = 410, .forget = 2048, .forgetRadius = 1}, 0, 2);
  colony.iterate();
  colony.change({3}, {4.0f});
  const uint32_t evaporated = 943616, half = evaporated + 104960 / 2;
  for (const uint32_t cell : {2u, 3u, 4u}) EXPECT_EQ(colony.pheromone()[8 * size_t{cell}], half) << cell;
  for (const uint32_t cell : {5u}) EXPECT_EQ(colony.pheromone()[8 * size_t{cell}], evaporated) << cell;
  EXPECT_EQ(colony.best().length, 1024u);
  colony.change({1}, {2.0f});
  EXPECT_EQ(colony.best().length, 1536u);
  colony.change({1}, {noColonyWay});
  EXPECT_FALSE(colony.best().arrived);
  EXPECT_EQ(colony.shortest(), std::numeric_limits<uint64_t>::max());
}

}  // namespace
}  // namespace skitter::reference
