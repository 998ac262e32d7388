// Foragers by hand (docs/foraging.md).
#include "cpu_reference/ways/forage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace skitter::test {
namespace {

using reference::ForageDeed;
using reference::ForageMap;
using reference::Forager;
using reference::ForageResult;
using reference::ForageTrail;
using reference::ForageTuning;
using reference::Foraging;

constexpr uint64_t kAlways = 0xffffffff;
constexpr uint32_t kUnit = 256;

// Cells of 2 m from (0, 0) on, a row a string: # is impassable, N the nest, F food, a and b branches.
ForageMap mapOf(const std::vector<std::string>& rows, uint32_t amount = 1000) {
  ForageMap map;
  map.columns = static_cast<int64_t>(rows[0].size());
  map.rows = static_cast<int64_t>(rows.size());
  map.cell = 2048;
  map.amounts = {amount};
  map.branches = 2;
  std::vector<std::pair<int64_t, int64_t>> nests;
  for (int64_t row = 0; row < map.rows; ++row)
    for (int64_t column = 0; column < map.columns; ++column) {
      const char at = rows[static_cast<size_t>(row)][static_cast<size_t>(column)];
      map.passable.push_back(at != '#');
      map.nest.push_back(at == 'N');
      map.source.push_back(at == 'F' ? 0 : -1);
      map.branch.push_back(at == 'a' ? 0 : at == 'b' ? 1 : -1);
      if (at == 'N') nests.emplace_back(column, row);
    }
  if (nests.empty()) return map;
  // The middle one of its first row.
  const auto isBeside = [&](const auto& nest) { return nest.second == nests.front().second; };
  const auto beside = std::ranges::count_if(nests, isBeside);
  std::tie(map.nestColumn, map.nestRow) = nests.at(static_cast<size_t>(beside / 2));
  return map;
}

reference::AgentBody standingAt(double x, double z) {
  reference::AgentBody body;
  body.tileX = std::floor(x / 16), body.localX = x - 16 * body.tileX;
  body.tileZ = std::floor(z / 16), body.localZ = z - 16 * body.tileZ;
  return body;
}
reference::AgentBody inCell(int64_t column, int64_t row) {
  return standingAt(2 * static_cast<double>(column) + 1, 2 * static_cast<double>(row) + 1);
}

ForageTuning tuningOf() {
  ForageTuning tuning;
  tuning.leave = kAlways;
  tuning.threshold = 20 * kUnit;
  tuning.layHome = 10 * kUnit;
  tuning.layOut = kUnit;
  tuning.patience = 1000;
  return tuning;
}

// Has come to a cell, heading in +z.
Forager northward(const ForageMap& map, int64_t column, int64_t row, Foraging state) {
  return {.cell = row * map.columns + column, .headingX = 0, .headingZ = 1024, .state = state};
}

TEST(Forage, NoMoveCutsACorner) {
  const ForageMap map = mapOf({"...", "..#", "..."});
  EXPECT_EQ(reference::forageMoves(map, 4), 1u << 2 | 1u << 3 | 1u << 4 | 1u << 5 | 1u << 6);
  EXPECT_EQ(reference::forageMoves(map, 0), 0b00000111u);
  // From an impassable cell any way out.
  EXPECT_EQ(reference::forageMoves(map, 5), 1u << 2 | 1u << 3 | 1u << 4 | 1u << 5 | 1u << 6);
}

TEST(Forage, WhoRestsStandsUntilItLeaves) {
  const ForageMap map = mapOf({"...", ".N.", "..."});
  ForageTuning tuning = tuningOf();
  tuning.leave = 0;
  const ForageTrail trail = reference::freshTrail(map);
  ForageResult result = reference::forage(tuning, map, trail, inCell(1, 1), {}, 2, 5, 1);
  EXPECT_EQ(result.forager.state, Foraging::rest);
  EXPECT_EQ(result.velocity, glm::dvec2(0));
  EXPECT_EQ(result.deed, ForageDeed{});
  tuning.leave = kAlways;
  result = reference::forage(tuning, map, trail, inCell(1, 1), {}, 2, 5, 1);
  EXPECT_EQ(result.forager.state, Foraging::search);
  EXPECT_NEAR(glm::length(result.velocity), 2, 1e-12);
  // One in 16 leaves.
  tuning.leave = uint64_t{1} << 28;
  int left = 0;
  for (int64_t number = 0; number < 16000; ++number)
    left += reference::forage(tuning, map, trail, inCell(1, 1), {}, 2, number, 9).forager.state ==
            Foraging::search;
  EXPECT_NEAR(left, 1000, 150);  // five standard deviations
}

// (20 + 30)^2 to (20 + 10)^2.
TEST(Forage, BranchesAreChosenAsDeneubourgHasIt) {
  const ForageMap map = mapOf({"#.#", "...", "###"});
  ForageTrail trail = reference::freshTrail(map);
  trail.grains[3] = 30 * kUnit;
  trail.grains[5] = 10 * kUnit;
  for (const uint32_t power : {1u, 2u, 4u}) {
    ForageTuning tuning = tuningOf();
    tuning.power = power;
    int left = 0;
    constexpr int draws = 20000;
    for (int number = 0; number < draws; ++number) {
      const ForageResult result = reference::forage(tuning, map, trail, inCell(1, 1),
                                                    northward(map, 1, 1, Foraging::search), 2, number, 3);
      ASSERT_TRUE(result.forager.cell == 3 || result.forager.cell == 5);
      left += result.forager.cell == 3;
    }
    const double expected = 1 / (1 + std::pow(30.0 / 50, power));
    EXPECT_NEAR(static_cast<double>(left) / draws, expected, 0.02) << "power " << power;
  }
}

TEST(Forage, FoodIsTakenAndCarriedHome) {
  const ForageMap map = mapOf({"#N#", "#.#", "#F#"}, 1);
  const ForageTuning tuning = tuningOf();
  ForageTrail trail = reference::freshTrail(map);
  const auto at = [&](int64_t row, Foraging state, int64_t heading = 1024) {
    Forager ant = northward(map, 1, row, state);
    ant.headingZ = heading;
    return reference::forage(tuning, map, trail, inCell(1, row), ant, 2, 0, 1);
  };
  const ForageResult out = at(1, Foraging::search);
  EXPECT_EQ(out.deed, (ForageDeed{.entered = 4, .grains = kUnit, .kind = ForageDeed::Kind::none}));
  const ForageResult found = at(2, Foraging::search);
  EXPECT_EQ(found.deed, (ForageDeed{.entered = 7, .grains = 10 * kUnit, .kind = ForageDeed::Kind::took}));
  EXPECT_EQ(found.forager.state, Foraging::laden);
  EXPECT_EQ(found.forager.cell, 4);
  EXPECT_LT(found.forager.headingZ, 0);
  reference::layTrail(found.deed, trail);
  EXPECT_EQ(trail.taken[0], 1u);
  // There is no more.
  EXPECT_EQ(at(2, Foraging::search).forager.state, Foraging::search);
  const ForageResult home = at(0, Foraging::laden, -1024);
  EXPECT_EQ(home.deed.kind, ForageDeed::Kind::brought);
  EXPECT_EQ(home.deed.grains, 0u);
  EXPECT_EQ(home.forager.state, Foraging::rest);
  EXPECT_EQ(home.velocity, glm::dvec2(0));
  EXPECT_EQ(at(0, Foraging::back, -1024).deed.kind, ForageDeed::Kind::empty);
}

TEST(Forage, ASearchIsGivenUp) {
  const ForageMap map = mapOf({"N....", ".....", "....."});
  ForageTuning tuning = tuningOf();
  tuning.patience = 7;
  Forager ant = northward(map, 3, 1, Foraging::search);
  ant.steps = 6;
  const ForageResult result =
      reference::forage(tuning, map, reference::freshTrail(map), inCell(3, 1), ant, 2, 0, 1);
  EXPECT_EQ(result.forager.state, Foraging::back);
  EXPECT_EQ(result.deed.grains, 0u);
}

TEST(Forage, WhoIsPushedAsideBeginsAnew) {
  const ForageMap map = mapOf({"N....", ".....", "....."});
  const Forager ant = northward(map, 0, 1, Foraging::laden);
  const ForageResult beside =
      reference::forage(tuningOf(), map, reference::freshTrail(map), inCell(1, 2), ant, 2, 0, 1);
  EXPECT_EQ(beside.forager, ant);
  EXPECT_EQ(beside.deed, ForageDeed{});
  const ForageResult lost =
      reference::forage(tuningOf(), map, reference::freshTrail(map), inCell(3, 2), ant, 2, 0, 1);
  EXPECT_EQ(lost.deed.entered, 13);
  EXPECT_EQ(lost.forager.state, Foraging::laden);
}

TEST(Forage, NobodyIsInAnEmptyPlace) {
  const ForageMap map = mapOf({"N..", "...", "..."});
  reference::AgentBody body = inCell(1, 1);
  body.absent = true;
  const ForageResult result = reference::forage(tuningOf(), map, reference::freshTrail(map), body,
                                                northward(map, 1, 1, Foraging::laden), 2, 0, 1);
  EXPECT_EQ(result.forager, Forager{});
  EXPECT_EQ(result.deed, ForageDeed{});
}

// Half of it goes in 0.69 mean lives; what is left at last goes grain by grain.
TEST(Forage, PheromoneEvaporates) {
  const ForageMap map = mapOf({"N."});
  ForageTrail trail = reference::freshTrail(map);
  ForageTuning tuning = tuningOf();
  tuning.every = 60;
  tuning.evaporation = static_cast<uint64_t>(0x1p32 * (1 - std::exp(-1 / 50.0)));
  trail.grains = {1000 * kUnit, 3};
  for (uint64_t n = 1; n <= 60 * 35; ++n) reference::evaporate(tuning, n, trail);
  EXPECT_NEAR(trail.grains[0], 1000 * kUnit * std::exp(-35.0 / 50), 1000);
  EXPECT_EQ(trail.grains[1], 0u);
  trail.grains = {~0u, 0};
  reference::evaporate(tuning, 60, trail);
  EXPECT_LT(trail.grains[0], 1u << 20);
}

// A colony of agents that are points, and go as they want.
struct Points {
  ForageMap map;
  ForageTuning tuning;
  ForageTrail trail;
  std::vector<reference::AgentBody> bodies;
  std::vector<Forager> foragers;
  uint64_t tick = 0;

  Points(ForageMap ground, const ForageTuning& numbers, size_t agents)
      : map(std::move(ground)),
        tuning(numbers),
        trail(reference::freshTrail(map)),
        bodies(agents, inCell(map.nestColumn, map.nestRow)),
        foragers(agents) {
    tuning.every = 10;
    tuning.evaporation = static_cast<uint64_t>(0x1p32 * (1 - std::exp(-1 / 200.0)));
  }
  void walk(double seconds) {
    constexpr double dt = 0.1;
    for (const uint64_t last = tick + static_cast<uint64_t>(std::lround(seconds / dt)); tick < last;) {
      ++tick;
      std::vector<ForageDeed> deeds;
      for (size_t i = 0; i < bodies.size(); ++i) {
        const ForageResult result =
            reference::forage(tuning, map, trail, bodies[i], foragers[i], 2, static_cast<int64_t>(i), tick);
        const glm::dvec2 to = bodies[i].world() + dt * result.velocity;
        bodies[i] = standingAt(to.x, to.y);
        foragers[i] = result.forager;
        deeds.push_back(result.deed);
      }
      for (const ForageDeed& deed : deeds) reference::layTrail(deed, trail);
      reference::evaporate(tuning, tick, trail);
    }
  }
  // The part of the entries of branches that are of the first one, from now on.
  double shareOfFirst(double seconds) {
    const std::vector<uint64_t> before = trail.passed;
    walk(seconds);
    const double a = static_cast<double>(trail.passed[0] - before[0]);
    return a / std::max(1.0, a + static_cast<double>(trail.passed[1] - before[1]));
  }
};

TEST(Forage, NobodyTurnsRoundInACorridor) {
  ForageTuning tuning = tuningOf();
  tuning.layOut = 0;
  const ForageMap map = mapOf(std::vector<std::string>(40, "..."));
  for (int64_t number = 0; number < 50; ++number) {
    Forager ant = northward(map, 1, 1, Foraging::search);
    reference::AgentBody body = inCell(1, 1);
    for (uint64_t n = 1; n < 30; ++n) {
      const int64_t row = ant.cell / map.columns;
      ant = reference::forage(tuning, map, reference::freshTrail(map), body, ant, 2, number, n).forager;
      ASSERT_GE(ant.cell / map.columns, row) << "ant " << number << ", move " << n;
      body = inCell(ant.cell % map.columns, ant.cell / map.columns);
    }
  }
}

// assets/scenes/double-bridge.json and double-bridge-equal.json.
// clang-format off
const std::vector<std::string> kUnequalBranches = {
    "..........#FFF#.................",
    "..........#FFF#.................",
    "..........#.F.#.................",
    "..........#...#.................",
    "..........#...#.................",
    "..........#...#.................",
    ".........##...##................",
    "........##.....##...............",
    ".......##.......##..............",
    "......##...###...##.............",
    ".....##...#####...#############.",
    "....##...###.###...############.",
    "...##...###...###.......bbb..##.",
    "..##aa.###.....###......bbb..##.",
    ".##aaaa##.......###########..##.",
    "..##aa.###.....###...........##.",
    "...##...###...###............##.",
    "....##...###.###...############.",
    ".....##...#####...#############.",
    "......##...###...##.............",
    ".......##.......##..............",
    "........##.....##...............",
    ".........##...##................",
    "..........#...#.................",
    "..........#...#.................",
    "..........#...#.................",
    "..........#...#.................",
    "..........#NNN#.................",
    "..........#NNN#................."};
const std::vector<std::string> kEqualBranches = {
    "..........#FFF#..........",
    "..........#FFF#..........",
    "..........#.F.#..........",
    "..........#...#..........",
    "..........#...#..........",
    "..........#...#..........",
    ".........##...##.........",
    "........##.....##........",
    ".......##.......##.......",
    "......##...###...##......",
    ".....##...#####...##.....",
    "....##...###.###...##....",
    "...##...###...###...##...",
    "..##aa.###.....###.bb##..",
    ".##aaaa##.......##bbbb##.",
    "..##aa.###.....###.bb##..",
    "...##...###...###...##...",
    "....##...###.###...##....",
    ".....##...#####...##.....",
    "......##...###...##......",
    ".......##.......##.......",
    "........##.....##........",
    ".........##...##.........",
    "..........#...#..........",
    "..........#...#..........",
    "..........#...#..........",
    "..........#...#..........",
    "..........#NNN#..........",
    "..........#NNN#.........."};
// clang-format on

Points bridgeOf(const std::vector<std::string>& rows, uint64_t seed) {
  ForageTuning tuning = tuningOf();
  tuning.seed = seed;
  tuning.leave = static_cast<uint64_t>(0x1p32 * 0.1 / 30);
  tuning.layHome = tuning.layOut = kUnit;
  tuning.patience = 200;
  return {mapOf(rows, 1u << 30), tuning, 120};
}

// Goss et al. 1989: colonies come to use the shorter branch.
TEST(Forage, TheShorterBranchWins) {
  for (uint64_t seed = 1; seed <= 4; ++seed) {
    Points colony = bridgeOf(kUnequalBranches, seed);
    const double first = colony.shareOfFirst(100);
    colony.walk(700);
    EXPECT_LT(first, 0.85) << "seed " << seed;
    EXPECT_GT(colony.shareOfFirst(100), 0.9) << "seed " << seed;
    EXPECT_GT(colony.trail.brought, 100u);
  }
}

// Deneubourg et al. 1990: of equal branches each colony comes to use one, whichever it is.
TEST(Forage, OneOfTwoEqualBranchesWins) {
  int first = 0, second = 0;
  for (uint64_t seed = 1; seed <= 8; ++seed) {
    Points colony = bridgeOf(kEqualBranches, seed);
    const double before = colony.shareOfFirst(100);
    colony.walk(2000);
    const double share = colony.shareOfFirst(100);
    EXPECT_NEAR(before, 0.5, 0.25) << "seed " << seed;
    EXPECT_GT(std::abs(share - 0.5), 0.3) << "seed " << seed;
    (share > 0.5 ? first : second) += 1;
  }
  EXPECT_GT(first, 0);
  EXPECT_GT(second, 0);
}

// Without food there are no loads; the pheromone of those who carried some is gone after ten mean lives.
TEST(Forage, TheTrailFadesWhenTheFoodIsGone) {
  ForageTuning tuning = tuningOf();
  tuning.leave = static_cast<uint64_t>(0x1p32 * 0.1 / 5);
  tuning.layOut = 0;
  tuning.patience = 40;
  std::vector<std::string> rows(15, std::string(15, '.'));
  rows[3][3] = 'N';
  for (size_t z = 9; z < 12; ++z) rows[z].replace(9, 3, "FFF");
  Points colony(mapOf(rows, 150), tuning, 60);
  colony.walk(300);
  EXPECT_GT(*std::ranges::max_element(colony.trail.grains), 20 * kUnit);
  colony.walk(3500);
  EXPECT_GE(colony.trail.taken[0], 150u);
  EXPECT_LT(colony.trail.taken[0], 155u);
  EXPECT_EQ(colony.trail.brought, colony.trail.taken[0]);
  EXPECT_EQ(*std::ranges::max_element(colony.trail.grains), 0u);
}

}  // namespace
}  // namespace skitter::test
