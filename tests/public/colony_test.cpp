#include "skitter/colony.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "public/public.h"

namespace skitter::test {
namespace {

constexpr float noWay = std::numeric_limits<float>::infinity();

class PublicColony : public PublicTest {
 protected:
  // On flat ground, seven straight moves from the nest to the goal.
  Colony flatColony(const Colony::Options& options = {}) {
    return Colony(device(), flatCosts(), {0, 1}, {7, 1}, options);
  }
  static CostGrid flatCosts() {
    return {.columns = 8, .rows = 4, .cell = 0.5f, .origin = {-2, 1}, .cost = std::vector<float>(32, 1)};
  }
};

void setCost(Colony& colony, const glm::uvec2& cell, float cost) {
  colony.setCosts(std::span(&cell, 1), std::span(&cost, 1));
}

TEST_F(PublicColony, RulesHaveNames) {
  for (const ColonyRule rule : allColonyRules) EXPECT_EQ(colonyRuleNamed(nameOf(rule)), rule);
  EXPECT_STREQ(nameOf(ColonyRule::acs), "acs");
  EXPECT_EQ(colonyRuleNamed("ants"), std::nullopt);
}

TEST_F(PublicColony, FindsTheStraightWay) {
  for (const ColonyRule rule : allColonyRules) {
    Colony first = flatColony({.rule = rule});
    Colony colony = std::move(first);
    EXPECT_FALSE(colony.best());
    EXPECT_EQ(colony.iteration(), 0u);
    colony.search(20);
    EXPECT_EQ(colony.iteration(), 20u);
    const std::optional<ColonyPath> best = colony.best();
    ASSERT_TRUE(best);
    ASSERT_EQ(best->cells.size(), 8u);
    for (uint32_t column = 0; column < 8; ++column) {
      EXPECT_EQ(best->cells[column], glm::uvec2(column, 1));
      EXPECT_EQ(best->points[column], glm::vec2(-2 + 0.5f * (static_cast<float>(column) + 0.5f), 1.75f));
    }
    EXPECT_EQ(best->fixedLength, 7u * 512);
    EXPECT_EQ(best->length, 3.5);
    EXPECT_GE(best->iteration, 1u);
    EXPECT_LE(best->iteration, 20u);
  }
}

TEST_F(PublicColony, TripsLeadFromTheNestToTheGoal) {
  Colony colony = flatColony({.ants = 9});
  for (const std::optional<ColonyPath>& trip : colony.downloadTrips()) EXPECT_FALSE(trip);
  colony.search(3);
  const std::vector<std::optional<ColonyPath>> trips = colony.downloadTrips();
  ASSERT_EQ(trips.size(), 9u);
  size_t arrived = 0;
  for (const std::optional<ColonyPath>& trip : trips) {
    if (!trip) continue;
    ++arrived;
    EXPECT_EQ(trip->cells.front(), glm::uvec2(0, 1));
    EXPECT_EQ(trip->cells.back(), glm::uvec2(7, 1));
    EXPECT_EQ(trip->points.size(), trip->cells.size());
    EXPECT_EQ(trip->iteration, 3u);
    EXPECT_GE(trip->fixedLength, colony.best().value().fixedLength);
  }
  EXPECT_GT(arrived, 0u);
}

TEST_F(PublicColony, PheromoneLiesOnTheBestWay) {
  Colony colony = flatColony();
  EXPECT_EQ(colony.downloadPheromone(), std::vector<uint32_t>(8 * 32, 1 << 20));
  colony.search(10);
  const std::vector<uint32_t> pheromone = colony.downloadPheromone();
  ASSERT_EQ(pheromone.size(), 8u * 32);
  // At the nest. The best way's first move had a deposit in iteration 10, a move off the map never had one.
  const size_t nest = 8 * 8;
  EXPECT_GT(pheromone[nest + 0], pheromone[nest + 4]);
  EXPECT_EQ(*std::ranges::min_element(pheromone), pheromone[nest + 4]);
  EXPECT_LE(*std::ranges::max_element(pheromone), 1u << 20);
  // 0.002 of the most.
  EXPECT_EQ(flatColony({.rule = ColonyRule::acs}).downloadPheromone(), std::vector<uint32_t>(8 * 32, 2097));
}

TEST_F(PublicColony, TellsWhatItUses) {
  const Colony colony = flatColony(), withRule = flatColony({.rule = ColonyRule::acs});
  EXPECT_EQ(colony.options().ants, 64u);
  EXPECT_EQ(colony.options().steps, 8u * (8 + 4));
  EXPECT_EQ(flatColony({.steps = 50}).options().steps, 50u);
  EXPECT_EQ(flatColony({.ants = 2}).options().crew, 2u);
  // docs/colony.md, but for the few numbers that the best path begins with.
  constexpr uint64_t cells = 32, ants = 64, steps = 96, crews = 16;
  constexpr uint64_t bytes =
      72 * cells + ants * (cells / 8 + steps / 2 + 8) + 8 * crews * (steps + 1) + steps / 2;
  EXPECT_GE(colony.memoryBytes(), bytes);
  EXPECT_LE(colony.memoryBytes(), bytes + 32);
  EXPECT_EQ(withRule.memoryBytes(), colony.memoryBytes() + 32 * cells);
}

TEST_F(PublicColony, RecordedIsAsSearched) {
  Colony searched = flatColony(), recorded = flatColony(), other = flatColony({.seed = 2});
  searched.search(1);
  other.search(1);
  device().run([&](VkCommandBuffer commands) { recorded.record(commands, 1); });
  EXPECT_EQ(recorded.downloadPheromone(), searched.downloadPheromone());
  device().run([&](VkCommandBuffer commands) {
    recorded.record(commands, 2);
    recorded.record(commands, 0);
  });
  searched.search(2);
  other.search(2);
  EXPECT_EQ(recorded.iteration(), 3u);
  EXPECT_EQ(recorded.downloadPheromone(), searched.downloadPheromone());
  const auto lengthsOf = [](const Colony& colony) {
    std::vector<uint32_t> lengths;
    for (const std::optional<ColonyPath>& trip : colony.downloadTrips())
      lengths.push_back(trip ? trip->fixedLength : 0);
    return lengths;
  };
  EXPECT_EQ(lengthsOf(recorded), lengthsOf(searched));
  EXPECT_NE(lengthsOf(other), lengthsOf(searched));
}

TEST_F(PublicColony, FollowsChangesOfItsMap) {
  Colony colony = flatColony();
  colony.search(20);
  const std::vector<glm::uvec2> twice(2, glm::uvec2(4, 1));
  colony.setCosts(twice, std::vector<float>{9, 3});
  // Two of the seven moves now take (1 + 3) / 2 of what they did.
  EXPECT_EQ(colony.best().value().fixedLength, 5u * 512 + 2 * 1024);
  setCost(colony, {4, 1}, noWay);
  EXPECT_FALSE(colony.best());
  colony.search(10);
  const std::optional<ColonyPath> best = colony.best();
  ASSERT_TRUE(best);
  EXPECT_EQ(std::ranges::count(best->cells, glm::uvec2(4, 1)), 0);
  EXPECT_GT(best->iteration, 20u);
  // Five straight moves and two diagonal ones at the best.
  EXPECT_GE(best->fixedLength, 5u * 512 + 2 * 724);
}

TEST_F(PublicColony, KnowsWhereThereIsNoWay) {
  CostGrid walled = flatCosts();
  for (size_t row = 0; row < 4; ++row) walled.cost[8 * row + 3] = noWay;
  Colony colony(device(), walled, {0, 1}, {7, 1}, {});
  colony.search(2);
  EXPECT_FALSE(colony.best());
  Colony inWall(device(), walled, {0, 1}, {3, 1}, {});
  inWall.search(2);
  EXPECT_FALSE(inWall.best());
  Colony there(device(), walled, {5, 2}, {5, 2}, {});
  there.search(1);
  EXPECT_EQ(there.best().value().cells, std::vector{glm::uvec2(5, 2)});
  EXPECT_EQ(there.best().value().length, 0);
}

TEST_F(PublicColony, RefusesGridsAndCellsThatCannotBe) {
  const auto refuse = [&](const std::string& text, const auto& change) {
    CostGrid grid = flatCosts();
    glm::uvec2 nest(0, 1), goal(7, 1);
    change(grid, nest, goal);
    expectRefused(text, [&] { Colony(device(), grid, nest, goal, {}); });
  };
  refuse("0 x 0 cells, expected 1 to 4096 a side", [](CostGrid& grid, auto&, auto&) { grid = {}; });
  refuse("4097 x 4 cells", [](CostGrid& grid, auto&, auto&) { grid.columns = 4097; });
  refuse("8 x 4 cells has 31 costs", [](CostGrid& grid, auto&, auto&) { grid.cost.pop_back(); });
  refuse("is 0 m, expected more than 0", [](CostGrid& grid, auto&, auto&) { grid.cell = 0; });
  refuse("cell (1, 1) of a colony's grid costs 0.5, expected 1 to 1000 or infinity",
         [](CostGrid& grid, auto&, auto&) { grid.cost[9] = 0.5f; });
  refuse("costs 1001", [](CostGrid& grid, auto&, auto&) { grid.cost[9] = 1001; });
  refuse("costs nan", [](CostGrid& grid, auto&, auto&) { grid.cost[9] = NAN; });
  refuse("the nest of a colony is cell (8, 0), expected one of 8 x 4", [](auto&, glm::uvec2& nest, auto&) {
    nest = {8, 0};
  });
  refuse("the goal of a colony is cell (0, 4)", [](auto&, auto&, glm::uvec2& goal) { goal = {0, 4}; });
}

TEST_F(PublicColony, RefusesOptionsOutOfTheirRanges) {
  const auto refuse = [&](const std::string& text, const Colony::Options& wrong) {
    expectRefused(text, [&] { flatColony(wrong); });
  };
  refuse("the rule of a colony is 7, expected one of mmas, acs", {.rule = static_cast<ColonyRule>(7)});
  refuse("ants of a colony is 0, expected 1 to 4096", {.ants = 0});
  refuse("ants of a colony is 4097", {.ants = 4097});
  refuse("steps of a colony is 20001, expected 1 to 20000", {.steps = 20001});
  refuse("crew of a colony is 0, expected 1 to 64", {.crew = 0});
  refuse("passes of a colony is 4294967295, expected 0 to 20000", {.passes = UINT32_MAX});
  refuse("beta of a colony is 9, expected 0 to 8", {.beta = 9});
  refuse("margin of a colony is 65", {.margin = 65});
  refuse("evaporation of a colony is 1", {.evaporation = 1});
  refuse("evaporation of a colony is 0", {.evaporation = 0});
  refuse("least of a colony is nan", {.least = NAN});
  refuse("greed of a colony is 2, expected 0 to 1", {.greed = 2});
  refuse("wear of a colony is -1", {.wear = -1});
  refuse("forget of a colony is 2", {.forget = 2});
  refuse("forgetRadius of a colony is 4097, expected 0 to 4096", {.forgetRadius = 4097});
}

TEST_F(PublicColony, RefusesChangesThatCannotBeAndKeepsItsMap) {
  Colony colony = flatColony(), same = flatColony();
  for (Colony* each : {&colony, &same}) each->search(3);
  const std::vector<glm::uvec2> cells = {{4, 1}, {8, 1}};
  const std::vector<float> nine = {9, 9};
  expectRefused("2 costs for 1 cells", [&] { colony.setCosts(std::span(cells).first(1), nine); });
  expectRefused("the changed cell of a colony is cell (8, 1)", [&] { colony.setCosts(cells, nine); });
  expectRefused("cell (4, 1) of a colony's grid costs 0", [&] { setCost(colony, {4, 1}, 0); });
  expectRefused("536870912 iterations of a colony after 3", [&] { colony.search(1u << 29); });
  device().run([&](VkCommandBuffer commands) {
    expectRefused("4294967295 iterations of a colony", [&] { colony.record(commands, UINT32_MAX); });
  });
  EXPECT_EQ(colony.iteration(), 3u);
  for (Colony* each : {&colony, &same}) each->search(1);
  EXPECT_EQ(colony.downloadPheromone(), same.downloadPheromone());
  EXPECT_EQ(colony.best().value().fixedLength, same.best().value().fixedLength);
}

}  // namespace
}  // namespace skitter::test
