// Promises of a colony, whatever its ants do.
#include <cmath>

#include "gpu/submit.h"
#include "skitter/error.h"
#include "support/gpu_fixture.h"
#include "ways/maps.h"

namespace skitter::test {
namespace {

class ColonyTest : public GpuTest {
 protected:
  Colony colonyOf(const ColonyCase& each) {
    return Colony(device(), each.grid, each.nest, each.goal, each.options);
  }
};

std::string refusalOf(const auto& work) {
  try {
    work();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::input);
    return error.what();
  }
  return "nothing was refused";
}

const char* const open =
    "1111111\n"
    "n11111g\n"
    "1111111\n";

TEST_F(ColonyTest, FindsTheStraightWay) {
  Colony colony = colonyOf(drawnCase("open", open));
  EXPECT_FALSE(colony.best());
  colony.search(10);
  const std::optional<ColonyPath> best = colony.best();
  ASSERT_TRUE(best);
  ASSERT_EQ(best->cells.size(), 7u);
  for (uint32_t column = 0; column < 7; ++column) {
    EXPECT_EQ(best->cells[column], glm::uvec2(column, 1));
    EXPECT_EQ(best->points[column], glm::vec2(-3 + 0.5f * (static_cast<float>(column) + 0.5f), 2.75f));
  }
  EXPECT_EQ(best->fixedLength, 6u * 512);
  EXPECT_EQ(best->length, 3);
  EXPECT_GE(best->iteration, 1u);
  EXPECT_LE(best->iteration, 10u);
}

TEST_F(ColonyTest, NestAtTheGoalIsAWayOfOneCell) {
  ColonyCase each = drawnCase("open", open);
  each.goal = each.nest;
  Colony colony = colonyOf(each);
  colony.search(2);
  const std::optional<ColonyPath> best = colony.best();
  ASSERT_TRUE(best);
  EXPECT_EQ(best->cells, std::vector{each.nest});
  EXPECT_EQ(best->fixedLength, 0u);
  EXPECT_EQ(best->iteration, 1u);
}

TEST_F(ColonyTest, NobodyArrivesWhereThereIsNoWay) {
  for (const char* picture : {"n1#1g", "n11\n###\n11g", "n1#\n1#1\n#1g"}) {
    Colony colony = colonyOf(drawnCase(picture, picture));
    colony.search(3);
    EXPECT_FALSE(colony.best()) << picture;
    for (const std::optional<ColonyPath>& trip : colony.downloadTrips()) EXPECT_FALSE(trip) << picture;
  }
}

TEST_F(ColonyTest, NobodyArrivesInAWall) {
  for (const bool isGoal : {false, true}) {
    ColonyCase each = drawnCase("open", open);
    each.grid.cost[indexOf(each, isGoal ? each.goal : each.nest)] = INFINITY;
    Colony colony = colonyOf(each);
    colony.search(2);
    EXPECT_FALSE(colony.best());
  }
}

// Without a way nothing is deposited: all pheromone has evaporated alike.
TEST_F(ColonyTest, DeadEndsDepositNothing) {
  Colony colony = colonyOf(drawnCase("closed", "n11#1g"));
  colony.search(1);
  for (const uint32_t each : colony.downloadPheromone()) EXPECT_EQ(each, 1048576u - 104960u);
}

TEST_F(ColonyTest, OneAntComesBackOutOfADeadEnd) {
  ColonyCase each = drawnCase("dead end", "11111n1g");
  each.options.ants = each.options.crew = 1;
  for (each.options.seed = 0; each.options.seed < 16; ++each.options.seed) {
    Colony colony = colonyOf(each);
    colony.search(1);
    ASSERT_TRUE(colony.best());
    EXPECT_EQ(colony.best()->cells, (std::vector<glm::uvec2>{{5, 0}, {6, 0}, {7, 0}}));
  }
}

TEST_F(ColonyTest, SeedsRepeatAndDiffer) {
  ColonyCase each = threatCase(48, 3);
  const auto after = [&](uint64_t seed, const std::vector<uint32_t>& runs) {
    each.options.seed = seed;
    Colony colony = colonyOf(each);
    for (const uint32_t iterations : runs) colony.search(iterations);
    return colony.downloadPheromone();
  };
  const std::vector<uint32_t> once = after(1, {20});
  EXPECT_EQ(once, after(1, {20}));
  EXPECT_EQ(once, after(1, {0, 1, 19}));
  EXPECT_NE(once, after(2, {20}));
  EXPECT_NE(once, after(uint64_t{1} << 32 | 1, {20}));
}

TEST_F(ColonyTest, RecordedIsAsSearched) {
  const ColonyCase each = threatCase(33, 4);
  Colony searched = colonyOf(each), recorded = colonyOf(each);
  searched.search(5);
  device().run([&](VkCommandBuffer cmd) {
    recorded.record(cmd, 2);
    recorded.record(cmd, 3);
  });
  EXPECT_EQ(recorded.iteration(), 5u);
  EXPECT_EQ(searched.downloadPheromone(), recorded.downloadPheromone());
}

TEST_F(ColonyTest, AMapThatCloses) {
  Colony colony = colonyOf(drawnCase("open", "n111g"));
  colony.search(3);
  ASSERT_TRUE(colony.best());
  const glm::uvec2 middle(2, 0);
  const auto set = [&](float cost) { colony.setCosts(std::span(&middle, 1), std::span(&cost, 1)); };
  set(3);
  ASSERT_TRUE(colony.best());
  EXPECT_EQ(colony.best()->fixedLength, 512u + 1024 + 1024 + 512);
  set(INFINITY);
  EXPECT_FALSE(colony.best());
  colony.search(3);
  EXPECT_FALSE(colony.best());
  set(1);
  colony.search(1);
  ASSERT_TRUE(colony.best());
  EXPECT_EQ(colony.best()->iteration, 7u);
}

TEST_F(ColonyTest, RefusesWhatCannotBe) {
  ColonyCase each = drawnCase("open", open);
  const auto refused = [&](const auto& change, const char* text) {
    ColonyCase wrong = each;
    change(wrong);
    EXPECT_THAT(refusalOf([&] { colonyOf(wrong); }), ::testing::HasSubstr(text));
  };
  refused([](ColonyCase& wrong) { wrong.grid = {}; }, "0 x 0 cells, expected 1 to 4096 a side");
  refused([](ColonyCase& wrong) { wrong.grid.cost.pop_back(); }, "7 x 3 cells has 20 costs");
  refused([](ColonyCase& wrong) { wrong.grid.cell = 0; }, "is 0 m, expected more than 0");
  refused([](ColonyCase& wrong) { wrong.grid.cost[8] = 0.5f; }, "cell (1, 1) of a colony's grid costs 0.5");
  refused([](ColonyCase& wrong) { wrong.grid.cost[20] = 0; }, "cell (6, 2) of a colony's grid costs 0");
  refused([](ColonyCase& wrong) { wrong.grid.cost[8] = NAN; }, "costs nan, expected 1 to 1000 or infinity");
  refused([](ColonyCase& wrong) { wrong.nest = {7, 0}; }, "the nest of a colony is cell (7, 0)");
  refused([](ColonyCase& wrong) { wrong.goal = {0, 3}; }, "the goal of a colony is cell (0, 3)");
  refused([](ColonyCase& wrong) { wrong.options.ants = 0; }, "ants of a colony is 0, expected 1 to 4096");
  refused([](ColonyCase& wrong) { wrong.options.evaporation = 1; }, "evaporation of a colony is 1");
  refused([](ColonyCase& wrong) { wrong.options.least = NAN; }, "least of a colony is nan");
  Colony colony = colonyOf(each);
  const glm::uvec2 outside(7, 1), inside(6, 1);
  const float zero = 0, one = 1;
  EXPECT_THAT(refusalOf([&] { colony.setCosts(std::span(&outside, 1), std::span(&one, 1)); }),
              ::testing::HasSubstr("changed cell"));
  EXPECT_THAT(refusalOf([&] { colony.setCosts(std::span(&inside, 1), std::span(&zero, 1)); }),
              ::testing::HasSubstr("costs 0"));
  EXPECT_THAT(refusalOf([&] { colony.setCosts(std::span(&inside, 1), {}); }),
              ::testing::HasSubstr("0 costs for 1 cells"));
}

}  // namespace
}  // namespace skitter::test
