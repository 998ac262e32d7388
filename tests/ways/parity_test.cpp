// The colony on the device, held against the reference to the bit after each iteration.
#include <fmt/format.h>

#include <cmath>

#include "support/gpu_fixture.h"
#include "ways/maps.h"

namespace skitter::test {
namespace {

class ColonyParityTest : public GpuTest {
 protected:
  void expectSame(const ColonyCase& each, uint32_t iterations) {
    Colony colony(device(), each.grid, each.nest, each.goal, each.options);
    reference::Colony truth = referenceOf(each);
    EXPECT_EQ(differenceOf(colony, truth, each, iterations), "");
  }
};

const char* const trap =
    "1111111111111\n"
    "1n11199111111\n"
    "1111199111#11\n"
    "1111111111#11\n"
    "111########11\n"
    "1111111111#1g\n"
    "1111111111111\n";

TEST_F(ColonyParityTest, BothRules) {
  for (const ColonyRule rule : allColonyRules) {
    ColonyCase each = drawnCase(nameOf(rule), trap);
    each.options.rule = rule;
    expectSame(each, 12);
  }
}

TEST_F(ColonyParityTest, EveryNumberOfAnts) {
  for (const uint32_t ants : {1u, 7u, 8u, 9u, 65u}) {
    ColonyCase each = drawnCase(fmt::format("{} ants", ants), trap);
    each.options.ants = ants;
    each.options.crew = ants > 3 ? 3 : 1;
    expectSame(each, 4);
  }
}

TEST_F(ColonyParityTest, GridsOfEverySize) {
  for (const char* picture : {"n", "ng", "n11111g", "n\n1\ng", "n1\n1g", "n1#\n#1#\n#1g"}) {
    ColonyCase each = drawnCase(picture, picture);
    each.options.ants = each.options.crew = 5;
    expectSame(each, 3);
  }
}

TEST_F(ColonyParityTest, MapsWithThreats) {
  for (const uint32_t side : {31u, 64u, 97u}) {
    ColonyCase each = threatCase(side, side);
    each.options.seed = 0x123456789ABCDEFu + side;
    expectSame(each, 6);
  }
}

TEST_F(ColonyParityTest, EveryOptionAwayFromItsDefault) {
  ColonyCase each = threatCase(40, 5);
  each.options = {.rule = ColonyRule::mmas,
                  .ants = 33,
                  .seed = ~uint64_t{0},
                  .steps = 201,
                  .crew = 5,
                  .passes = 3,
                  .beta = 3,
                  .margin = 2.37f,
                  .evaporation = 0.31f,
                  .least = 0.013f,
                  .bestEvery = 2,
                  .greed = 0.37f,
                  .wear = 0.23f};
  expectSame(each, 8);
  each.options.rule = ColonyRule::acs;
  expectSame(each, 8);
  each.options.passes = 0;
  each.options.bestEvery = 0;
  each.options.greed = 1;
  expectSame(each, 4);
}

TEST_F(ColonyParityTest, FewSteps) {
  for (const uint32_t steps : {1u, 2u, 30u}) {
    ColonyCase each = drawnCase(fmt::format("{} steps", steps), trap);
    each.options.steps = steps;
    expectSame(each, 2);
  }
}

// A way there and back around a wall: 4001 moves of 512000 are less than the longest trip, 2^31 - 1
// (LONGEST_TRIP), and 4401 are more.
TEST_F(ColonyParityTest, TripsThatBecomeTooLong) {
  for (const uint32_t columns : {2000u, 2200u}) {
    ColonyCase each{.name = fmt::format("{} columns", columns),
                    .grid = {.columns = columns, .rows = 3, .cell = 1, .origin = {0, 0}, .cost = {}},
                    .nest = {0, 0},
                    .goal = {0, 2}};
    each.grid.cost.assign(size_t{3} * columns, 1000.0f);
    for (uint32_t column = 0; column + 1 < columns; ++column)
      each.grid.cost[size_t{columns} + column] = INFINITY;
    each.options.ants = each.options.crew = 3;
    expectSame(each, 1);
    reference::Colony truth = referenceOf(each);
    truth.iterate();
    EXPECT_EQ(truth.best().arrived, columns == 2000);
  }
}

// Where what is near ends at the middle of the map, and where it would end beyond each of its edges.
TEST_F(ColonyParityTest, ChangesOfTheMap) {
  const std::vector<glm::uvec2> places[] = {
      {{1, 4}, {0, 4}, {2, 4}, {4, 4}}, {{1, 0}, {0, 1}}, {{11, 6}, {12, 5}}};
  for (const ColonyRule rule : allColonyRules)
    for (const float forget : {0.0f, 0.4f, 1.0f})
      for (const std::vector<glm::uvec2>& cells : places) {
        ColonyCase each = drawnCase(fmt::format("changes, {}", nameOf(rule)), trap);
        each.options.rule = rule;
        each.options.forget = forget;
        Colony colony(device(), each.grid, each.nest, each.goal, each.options);
        reference::Colony truth = referenceOf(each);
        EXPECT_EQ(differenceOf(colony, truth, each, 3), "");
        std::vector<float> costs = {INFINITY, INFINITY, 7.5f, 1};
        costs.resize(cells.size());
        std::vector<uint32_t> indices;
        for (const glm::uvec2 cell : cells) indices.push_back(indexOf(each, cell));
        colony.setCosts(cells, costs);
        truth.change(indices, costs);
        EXPECT_EQ(differenceNow(colony, truth, each), "");
        EXPECT_EQ(differenceOf(colony, truth, each, 3), "");
      }
}

}  // namespace
}  // namespace skitter::test
