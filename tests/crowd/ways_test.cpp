// Herds that find their way (docs/ways.md).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <variant>
#include <vector>

#include "assets/files.h"
#include "cpu_reference/stages/tolerances.h"
#include "cpu_reference/ways/grid.h"
#include "crowd/radius.h"
#include "crowd/simulation.h"
#include "crowd/ways/fields.h"
#include "gpu/transfer.h"
#include "shared/eikonal.h"
#include "skitter/error.h"
#include "skitter/state.h"
#include "validation/convert.h"
#include "validation/herd_facts.h"

namespace skitter::test {
namespace {

using WayFieldsTest = GpuTest;
using WaysTest = GpuTest;
using WaysReplayTest = GpuLoadTest;

constexpr float kImpassable = std::numeric_limits<float>::infinity();
CostGrid gridOf(uint32_t columns, uint32_t rows, const std::function<float(uint32_t, uint32_t)>& cost) {
  CostGrid grid{.columns = columns, .rows = rows, .cell = 0.5f};
  grid.origin = -0.25f * glm::vec2(columns, rows);
  for (uint32_t row = 0; row < rows; ++row)
    for (uint32_t column = 0; column < columns; ++column) grid.cost.push_back(cost(column, row));
  return grid;
}

CostGrid level(uint32_t columns, uint32_t rows) {
  return gridOf(columns, rows, [](uint32_t, uint32_t) { return 1.0f; });
}
// Walls every four rows, open at alternating ends.
CostGrid maze(uint32_t columns, uint32_t rows) {
  return gridOf(columns, rows, [=](uint32_t column, uint32_t row) {
    const bool open = row % 8 == 3 ? column + 3 >= columns : column < 3;
    return row % 4 == 3 && !open ? kImpassable : 1.0f;
  });
}
CostGrid hillside(uint32_t columns, uint32_t rows) {
  return gridOf(columns, rows, [](uint32_t column, uint32_t row) {
    const auto x = static_cast<float>(column), z = static_cast<float>(row);
    return 1.5f + std::sin(0.3f * x) * std::sin(0.17f * z) * 0.5f;
  });
}
CostGrid wallWithGap(uint32_t columns, uint32_t rows) {
  return gridOf(columns, rows, [=](uint32_t column, uint32_t row) {
    return row == rows / 2 && column != columns / 3 ? kImpassable : 1.0f;
  });
}

reference::WayGrid referenceOf(const CostGrid& grid) {
  return {.columns = grid.columns,
          .rows = grid.rows,
          .cell = grid.cell,
          .origin = grid.origin,
          .cost = {grid.cost.begin(), grid.cost.end()},
          .margin = std::vector<double>(grid.cost.size(), 1)};
}

void expectAsReference(const crowd::WayFields& fields, const glm::vec2& goal) {
  ASSERT_TRUE(fields.has(goal));
  const reference::WayGrid grid = referenceOf(fields.grid());
  const std::vector<double> expected =
      reference::wayTimes(grid, reference::wayStarts(grid, goal), double{shared::WAY_INSIDE_COST});
  const std::vector<float> times = fields.times(goal);
  ASSERT_EQ(times.size(), expected.size());
  for (size_t at = 0; at < times.size(); ++at)
    ASSERT_NEAR(times[at], expected[at], reference::tolerance::wayField * std::max(expected[at], grid.cell))
        << "cell " << at % grid.columns << ", " << at / grid.columns;
}

TEST_F(WayFieldsTest, AreThoseOfTheReference) {
  const std::vector<CostGrid> grids = {level(2, 2),  level(2, 3),       level(129, 1 + 127),
                                       maze(61, 83), hillside(97, 130), wallWithGap(75, 40),
                                       maze(200, 9), level(3, 300)};
  const std::vector<glm::vec2> goals = {{0.1f, 0.2f}, {-0.3f, -0.4f}, {1000, -1000}, {0.25f, 0.25f}};
  for (const CostGrid& grid : grids) {
    SCOPED_TRACE(testing::Message() << grid.columns << " x " << grid.rows);
    crowd::WayFields fields(context(), grid);
    fields.add(goals, {});
    for (const glm::vec2& goal : goals) expectAsReference(fields, goal);
  }
}

// Ground with the obstacles and the creatures of a scene, and the goals that are tried on it.
struct WayWorld {
  const char* name;
  Heightfield ground;
  std::vector<Obstacle> obstacles;
  std::vector<glm::vec2> goals;
};
std::vector<WayWorld> wayWorlds() {
  const auto load = [](const char* file, float scale) {
    return loadHeightfield(std::string(SKITTER_ROOT "/assets/terrain/") + file, {.scale = scale});
  };
  const Scene maze = loadScene(SKITTER_ROOT "/assets/scenes/maze.json");
  return {{"jacksboro", load("jacksboro_403x344.png", 0.0067f), {}, {{-60, 40}, {30.2f, 20.1f}}},
          {"everest", load("everest_513x513.png", 0.005426f), {}, {{-60, 40}, {50.2f, -70.1f}}},
          {"maze", maze.loadTerrain(), maze.obstacles, {maze.herds[0].goal.target, {-3, -24}}}};
}

// Its cost grid by the reference. Where rounding decides whether a cell is passable, it is as in `grid`.
reference::WayGrid referenceOf(const WayWorld& world, const CostGrid& grid, const Traveller& traveller) {
  const Heightfield& ground = world.ground;
  const reference::Heights heights{ground.heights.data(),         static_cast<int>(ground.columns),
                                   static_cast<int>(ground.rows), double{ground.originX()},
                                   double{ground.originZ()},      1 / double{ground.spacingX},
                                   1 / double{ground.spacingZ}};
  reference::WayObstacles obstacles;
  for (const auto& [shape] : world.obstacles) {
    if (const auto* disc = std::get_if<Disc>(&shape))
      obstacles.discs.push_back({disc->centre, double{disc->radius}});
    if (const auto* capsule = std::get_if<Capsule>(&shape))
      obstacles.capsules.push_back({capsule->from, capsule->to, double{capsule->radius}});
    if (const auto* polygon = std::get_if<ConvexPolygon>(&shape))
      obstacles.polygons.push_back({{polygon->corners.begin(), polygon->corners.end()}});
  }
  reference::WayGrid made = reference::wayGrid(heights, obstacles,
                                               {.legLength = double{traveller.legLength},
                                                .footprint = double{traveller.footprint},
                                                .edgeMargin = double{traveller.margin},
                                                .climb = double{traveller.ways.climb},
                                                .steepest = double{traveller.ways.steepest},
                                                .step = double{traveller.ways.step}});
  EXPECT_EQ(made.cells(), grid.cost.size());
  for (size_t at = 0; at < made.cells(); ++at) {
    if (made.passable(at) == std::isfinite(grid.cost[at])) continue;
    // Places of 128 m in float32 on slopes of 4, over half a cell.
    EXPECT_LT(made.margin[at], 1e-3) << world.name << ", cell " << at;
    made.cost[at] = double{grid.cost[at]};
  }
  return made;
}

// How far the times of a field are from those of fast marching in double precision, as shares of these: of
// the cells from which a way leads to the goal, ten cells and more from it.
struct FieldErrors {
  double mean = 0, worst = 0;
  size_t cells = 0;
};
FieldErrors errorsOf(const crowd::WayFields& fields, const reference::WayGrid& grid, const glm::vec2& goal) {
  const std::vector<double> expected =
      reference::wayTimes(grid, reference::wayStarts(grid, goal), double{shared::WAY_INSIDE_COST});
  const std::vector<float> times = fields.times(goal);
  const uint32_t region = fields.stopsAt(goal).region;
  FieldErrors errors;
  for (size_t at = 0; at < times.size(); ++at) {
    if (fields.regions().of[at] != region ||
        glm::distance(grid.middle(at), glm::dvec2(goal)) < 10 * grid.cell)
      continue;
    const double error = std::abs(double{times[at]} - expected[at]) / expected[at];
    errors.mean += error;
    errors.worst = std::max(errors.worst, error);
    ++errors.cells;
  }
  errors.mean /= static_cast<double>(errors.cells);
  return errors;
}

// The costs, stops and times of the reference follow from the same heights and from nothing else.
TEST_F(WayFieldsTest, AreThoseOfFastMarchingOnRealGroundAndInAMaze) {
  const Traveller spider{.legLength = 1, .footprint = crowd::footprintRadius(spiderRig()), .margin = 2};
  for (const WayWorld& world : wayWorlds()) {
    const CostGrid grid = costGrid(world.ground, world.obstacles, spider);
    const reference::WayGrid expected = referenceOf(world, grid, spider);
    crowd::WayFields fields(context(), grid);
    fields.add(world.goals, {});
    for (const glm::vec2& goal : world.goals) {
      SCOPED_TRACE(testing::Message() << world.name << ", goal " << goal.x << ", " << goal.y);
      const FieldErrors errors = errorsOf(fields, expected, goal);
      EXPECT_GT(errors.cells, grid.cost.size() / 2);
      EXPECT_LT(errors.mean, 0.01);
      EXPECT_LT(errors.worst, 0.03);
      fmt::print("{}: {} cells, {:.2g} in the mean, {:.2g} at worst\n", world.name, errors.cells, errors.mean,
                 errors.worst);
    }
    // Fields that know of obstacles but not of slopes are told apart.
    CostGrid flat = grid;
    for (float& cost : flat.cost) cost = std::isfinite(cost) ? 1 : cost;
    fields.setGrid(flat);
    const FieldErrors errors = errorsOf(fields, expected, world.goals[0]);
    EXPECT_GT(errors.mean, 0.01) << world.name;
    EXPECT_GT(errors.worst, 0.03) << world.name;
  }
}

TEST_F(WayFieldsTest, AreTheSameBitsWhateverIsSolvedBeside) {
  crowd::WayFields alone(context(), maze(61, 83)), among(context(), maze(61, 83));
  const glm::vec2 goal(3, 4);
  alone.add(std::vector<glm::vec2>{goal}, {});
  among.add(std::vector<glm::vec2>{{0, 1}, goal}, {});
  among.add(std::vector<glm::vec2>{{-9, 5}, {2, 2}, {3, 3}}, {});
  EXPECT_EQ(alone.times(goal), among.times(goal));
  among.setGrid(level(61, 83));
  EXPECT_NE(alone.times(goal), among.times(goal));
  among.setGrid(maze(61, 83));
  EXPECT_EQ(alone.times(goal), among.times(goal));
}

// The times at random places, of cells of all costs, are those of the equation but for a unit or two of a
// cell and the rounding of float32. None falls where a time beside the cell is later, by however little, and
// each is later than the times that it depends on.
TEST(Eikonal, GrowsWithTheTimesBesideTheCell) {
  std::mt19937 random(7);
  const auto draw = [&](double least, double most) {
    return static_cast<float>(std::uniform_real_distribution<double>(least, most)(random));
  };
  const auto later = [](float time) { return std::nextafter(time, kImpassable); };
  for (int i = 0; i < 200000; ++i) {
    const float h = draw(0.3, 1) * std::exp(draw(0, 4)), a = draw(0, 1) * std::exp(draw(-4, 10));
    const float b = std::max(0.0f, a + draw(-1.1, 1.1) * h);
    const double apart = std::abs(double{a} - double{b}), near = double{std::min(a, b)};
    const double expected =
        apart >= double{h}
            ? near + double{h}
            : 0.5 * (double{a} + double{b} + std::sqrt(2 * double{h} * double{h} - apart * apart));
    const float time = shared::eikonal(a, b, h);
    ASSERT_NEAR(time, expected, 4 * 0x1p-18 * double{h} + 0x1p-23 * expected) << a << ", " << b << ", " << h;
    ASSERT_EQ(time, shared::eikonal(b, a, h));
    ASSERT_GE(shared::eikonal(later(a), b, h), time) << a << ", " << b << ", " << h;
    ASSERT_GE(shared::eikonal(a, later(b), h), time) << a << ", " << b << ", " << h;
    ASSERT_GT(time, std::min(a, b)) << h;
    // It does not depend on a time that is not before it.
    const float far = std::max(a, b);
    if (far >= time) {
      ASSERT_EQ(shared::eikonal(std::min(a, b), shared::WAY_FAR, h), time) << a << ", " << b << ", " << h;
    }
  }
  EXPECT_EQ(shared::eikonal(shared::WAY_FAR, shared::WAY_FAR, 0.5f), shared::WAY_FAR);
  // From 2^24 units on, float32 has not every whole number.
  const float unit = 64 * 0x1p-24f;
  for (int k = 1; k < 1000; ++k) {
    const float a = 63 + static_cast<float>(k) * unit;
    EXPECT_TRUE(shared::eikonal(a, 64, 1) > 64 || a + 1 == 64) << k;
  }
}

// A time is that of the greatest whole number of units whose square and that of its distance from the later
// time are not beyond the crossing's, or the next one after this, whatever of a unit the times beside the
// cell have over whole ones.
TEST(Eikonal, IsTheRootInWholeUnits) {
  std::mt19937 random(11);
  constexpr uint32_t unitsOfPower = 1u << 18;
  for (int i = 0; i < 200000; ++i) {
    const uint64_t across = unitsOfPower + random() % unitsOfPower;
    // A fifth of the later times are within four units of those that do not count any more.
    const uint64_t apart = i % 5 == 0 ? across - 1 - random() % 4 : random() % across;
    const auto over = [&] { return i % 3 == 0 ? 0 : static_cast<float>(random() % 16) / 16; };
    uint64_t root = 0;
    for (uint64_t bit = 2 * unitsOfPower; bit > 0; bit /= 2) {
      const uint64_t next = root + bit, off = next > apart ? next - apart : apart - next;
      if (next * next + off * off <= across * across) root = next;
    }
    const float unit = std::ldexp(1.0f, static_cast<int>(random() % 20) - 30), first = over(),
                second = static_cast<float>(apart) + over(), h = static_cast<float>(across) + over() / 64;
    ASSERT_EQ(shared::eikonal(unit * first, unit * second, unit * h),
              unit * static_cast<float>(std::max(root, apart + 1)))
        << apart << " of " << across << " units of " << unit;
  }
}

// Discs of another cost come, move and go, in the way of some goals and aside of others.
void changeSomewhere(std::mt19937& random, CostGrid& grid) {
  const auto below = [&](uint32_t count) { return random() % count; };
  const auto column = static_cast<double>(below(grid.columns)), row = static_cast<double>(below(grid.rows));
  const double radius = 1 + below(5);
  const std::vector<float> costs = {kImpassable, 1, 1.3f, 2.5f};
  const float cost = costs[below(4)];
  for (size_t at = 0; at < grid.cost.size(); ++at)
    if (std::hypot(static_cast<double>(at % grid.columns) - column,
                   static_cast<double>(at / grid.columns) - row) < radius)
      grid.cost[at] = cost;
}

std::vector<float> wayRecordsOf(const crowd::WayFields& fields, const gpu::Context& context) {
  return gpu::download<float>(context, fields.records());
}

// Of those who flee, too.
TEST_F(WayFieldsTest, FollowChangesToTheBitsOfSolvingAnew) {
  const std::vector<glm::vec2> goals = {{0.1f, 0.2f}, {-4, 6}, {1000, -1000}, glm::vec2(shared::WAY_OUT)};
  std::mt19937 random(3);
  uint32_t updated = 0;
  for (CostGrid grid : {level(40, 31), maze(45, 50), hillside(61, 47), wallWithGap(64, 64)}) {
    crowd::WayFields fields(context(), grid);
    fields.add(goals, {});
    for (int step = 0; step < 12; ++step) {
      SCOPED_TRACE(testing::Message() << grid.columns << " x " << grid.rows << ", step " << step);
      const uint32_t solved = fields.solved(), revision = fields.revision();
      changeSomewhere(random, grid);
      fields.setGrid(grid);
      updated += static_cast<uint32_t>(goals.size()) - (fields.solved() - solved);
      EXPECT_NE(fields.revision(), revision);
      crowd::WayFields anew(context(), grid);
      anew.add(goals, {});
      for (const glm::vec2& goal : goals) ASSERT_EQ(fields.times(goal), anew.times(goal)) << goal.x;
      ASSERT_EQ(wayRecordsOf(fields, context()), wayRecordsOf(anew, context()));
      for (const glm::vec2& goal : goals)
        if (goal.x != shared::WAY_OUT) expectAsReference(fields, goal);
    }
  }
  // Half of them at least did not need to be solved, and those of the beginning were.
  EXPECT_GT(updated, 2u * 12 * goals.size());
  EXPECT_LT(updated, 4u * 12 * goals.size());
}

// What changes far behind an agent is no business of its field; what changes at the goal is.
TEST_F(WayFieldsTest, AreSolvedAnewWhereTooMuchChanges) {
  CostGrid grid = level(64, 64);
  crowd::WayFields fields(context(), grid);
  const glm::vec2 goal(-15.9f, 0.1f);
  fields.add(std::vector<glm::vec2>{goal}, {});
  EXPECT_EQ(fields.solved(), 1u);
  grid.cost[32 * 64 + 60] = kImpassable;
  fields.setGrid(grid);
  EXPECT_EQ(fields.solved(), 1u);
  for (uint32_t row = 1; row < 64; ++row) grid.cost[row * 64 + 3] = kImpassable;
  fields.setGrid(grid);
  EXPECT_EQ(fields.solved(), 2u);
  expectAsReference(fields, goal);
  fields.setGrid(level(32, 64));
  EXPECT_EQ(fields.solved(), 3u);
  expectAsReference(fields, goal);
}

TEST_F(WayFieldsTest, LeaveWhatNobodyUses) {
  crowd::WayFields fields(context(), level(20, 20));
  std::vector<glm::vec2> goals;
  for (int i = 0; i < shared::MOST_WAYS; ++i) goals.emplace_back(0.3f * static_cast<float>(i) - 3, 1);
  fields.add(goals, {});
  std::vector<glm::vec2> kept = goals;
  kept.erase(kept.begin() + 5);
  const glm::vec2 fresh(0.5f, -2);
  fields.add(std::vector<glm::vec2>{fresh}, kept);
  EXPECT_FALSE(fields.has(goals[5]));
  for (const glm::vec2& goal : kept) EXPECT_TRUE(fields.has(goal));
  expectAsReference(fields, fresh);
  expectAsReference(fields, goals[4]);
}

TEST_F(WayFieldsTest, LeadNowhereWhereNothingIsPassable) {
  crowd::WayFields fields(context(), gridOf(7, 5, [](uint32_t, uint32_t) { return kImpassable; }));
  fields.add(std::vector<glm::vec2>{{0, 0}}, {});
  EXPECT_EQ(fields.times({0, 0}), std::vector<float>(35, shared::WAY_FAR));
  fields.setGrid(level(7, 5));
  expectAsReference(fields, {0, 0});
}

TEST(CostGrid, IsThatOfTheReference) {
  const Heightfield ground =
      generateHeightfield({.columns = 150, .rows = 97, .amplitude = 9, .wavelength = 12});
  const std::vector<Obstacle> obstacles = {{Disc{.centre = {3, -4}, .radius = 2.5f}},
                                           {Capsule{.from = {-30, 8}, .to = {12, 10}, .radius = 0}},
                                           {ConvexPolygon{.corners = {{20, 2}, {27, 4}, {22, 11}}}},
                                           {Disc{.centre = {500, 0}, .radius = 1}}};
  const Traveller traveller{.legLength = 0.9f, .footprint = 0.6f, .margin = 2, .ways = {.steepest = 0.9f}};
  CostGrid grid = costGrid(ground, obstacles, traveller);
  keepOff(grid, std::vector<Threat>{{{-12, -9}, 3.5f}, {{1, 1}, 0}}, traveller);
  const reference::Heights heights{ground.heights.data(),    150, 97, double{ground.originX()},
                                   double{ground.originZ()}, 2,   2};
  const reference::WayGrid expected = reference::wayGrid(heights,
                                                         {.discs = {{{3, -4}, 2.5}, {{500, 0}, 1}},
                                                          .capsules = {{{-30, 8}, {12, 10}, 0}},
                                                          .polygons = {{{{20, 2}, {27, 4}, {22, 11}}}},
                                                          .threats = {{{-12, -9}, 3.5}, {{1, 1}, 0}}},
                                                         {.legLength = double{0.9f},
                                                          .footprint = double{0.6f},
                                                          .edgeMargin = 2,
                                                          .climb = 1.5,
                                                          .steepest = double{0.9f},
                                                          .step = 0.5});
  ASSERT_EQ(grid.columns, expected.columns);
  ASSERT_EQ(grid.rows, expected.rows);
  EXPECT_NEAR(grid.cell, expected.cell, 1e-6);
  size_t passable = 0;
  for (size_t at = 0; at < grid.cost.size(); ++at) {
    if (std::isfinite(grid.cost[at]) != expected.passable(at)) {
      // Heights of some metres and places of 40 m in float32, over half a cell.
      EXPECT_LT(expected.margin[at], 1e-4) << at;
      continue;
    }
    if (!expected.passable(at)) continue;
    ++passable;
    EXPECT_NEAR(grid.cost[at], expected.cost[at], 1e-4) << at;
  }
  EXPECT_GT(passable, grid.cost.size() / 10);
  EXPECT_LT(passable, grid.cost.size() * 9 / 10);
}

TEST(CostGrid, RefusesObstaclesThatAreNone) {
  const Heightfield ground = flatGround();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<Obstacle> wrong = {{Disc{.centre = {nan, 0}}},
                                       {Disc{.radius = nan}},
                                       {Capsule{.to = {0, 5000}}},
                                       {ConvexPolygon{}},
                                       {ConvexPolygon{.corners = {{0, 0}, {1, 0}, {0.5f, 0}}}}};
  for (const Obstacle& obstacle : wrong) EXPECT_THROW(costGrid(ground, {&obstacle, 1}, {}), Error);
}

// Agents south of a wall that is open in the east; their goal is north of it.
Scene walledScene(uint32_t agents, Controller controller = Controller::adaptive) {
  Scene scene = sceneOf(agents, 2, 1, controller);
  scene.obstacles = {{Capsule{.from = {-40, 0}, .to = {8, 0}, .radius = 0.3f}}};
  scene.herds[0].ways = Ways{};
  scene.herds[0].spawn = {.kind = Spawn::Kind::grid, .spacing = 1, .centre = {0, -8}};
  scene.herds[0].goal = {.kind = Goal::Kind::point, .target = {0, 7}, .speed = 2};
  return scene;
}

double farthestFrom(const Crowd& crowd, const glm::dvec2& place) {
  const HerdState state = crowd.download(0);
  double farthest = 0;
  for (size_t i = 0; i < state.agents; ++i) {
    const glm::dvec3 at = positionOf(state, i);
    farthest = std::max(farthest, std::hypot(at.x - place.x, at.z - place.y));
  }
  return farthest;
}

TEST_F(WaysTest, AgentsGoRoundAWallToTheirGoal) {
  Crowd crowd(device(), flatGround(), walledScene(9));
  EXPECT_EQ(crowd.cannotReach(0), 0u);
  for (int part = 0; part < 120; ++part) {
    simulate(device(), crowd, 15);
    const HerdState state = crowd.download(0);
    for (size_t i = 0; i < state.agents; ++i) {
      const glm::dvec3 at = positionOf(state, i);
      EXPECT_TRUE(at.x > 8 || std::abs(at.z) > 0.3) << i << " is in the wall at " << at.x << ", " << at.z;
    }
  }
  EXPECT_LT(farthestFrom(crowd, {0, 7}), 1);
}

// An agent that is pressed against a wall goes along it, 17 degrees off it at most, and not back into the
// crowd.
TEST_F(WaysTest, AgentsAtAWallGoAlongIt) {
  Crowd crowd(device(), flatGround(), walledScene(3));
  const float away[] = {0.65f, 0.7f, 0.74f};
  for (uint32_t i = 0; i < 3; ++i)
    crowd.teleport(crowd.agentId(0, i), {{4.1f * static_cast<float>(i) - 6, -away[i]}, 0});
  simulate(device(), crowd, 1);
  const HerdState state = crowd.download(0);
  for (size_t i = 0; i < 3; ++i) {
    const float *steer = &state.steer[4 * i * shared::STEER_STRIDE], along = steer[0] / 2, off = steer[1] / 2;
    EXPECT_GT(along, 0.95f) << away[i] << " m from its middle";
    EXPECT_LT(std::abs(off), 0.3f) << away[i] << " m from its middle";
  }
}

TEST_F(WaysTest, AgentsStopAtTheNearestPlaceThatTheyReach) {
  Scene scene = walledScene(9);
  scene.obstacles = {{Capsule{.from = {-40, 0}, .to = {40, 0}, .radius = 0.3f}}};
  Crowd crowd(device(), flatGround(), scene);
  EXPECT_EQ(crowd.cannotReach(0), 9u);
  simulate(device(), crowd, 900);
  // The wall, its growth, a cell and the arrival radius of half a leg.
  EXPECT_LT(farthestFrom(crowd, {0, 0}), 0.3 + 1 + 0.5 + 0.5);
  EXPECT_EQ(crowd.cannotReach(0), 9u);
}

TEST_F(WaysTest, AGoalInAnObstacleIsApproached) {
  Scene scene = walledScene(9);
  scene.obstacles = {{Disc{.centre = {0, 7}, .radius = 3}}};
  Crowd crowd(device(), flatGround(), scene);
  EXPECT_EQ(crowd.cannotReach(0), 9u);
  simulate(device(), crowd, 1200);
  EXPECT_LT(farthestFrom(crowd, {0, 7}), 3 + 1 + 0.5 + 0.5);
}

TEST_F(WaysTest, EverySizeOfHerdHasTheSameHashTwice) {
  for (const uint32_t agents : {0u, 1u, 37u}) {
    uint64_t hashes[2];
    for (uint64_t& hash : hashes) {
      Crowd crowd(device(), flatGround(), walledScene(agents));
      simulate(device(), crowd, 60);
      hash = crowd.stateHash();
    }
    EXPECT_EQ(hashes[0], hashes[1]) << agents;
  }
}

TEST_F(WaysTest, ObstaclesAreNothingToHerdsWithoutWays) {
  Scene scene = walledScene(20), open = scene;
  scene.herds[0].ways = open.herds[0].ways = {};
  open.obstacles = {};
  Crowd among(device(), flatGround(), scene), without(device(), flatGround(), open);
  for (Crowd* crowd : {&among, &without}) simulate(device(), *crowd, 60);
  EXPECT_EQ(among.stateHash(), without.stateHash());
  EXPECT_EQ(among.cannotReach(0), 0u);
}

TEST_F(WaysTest, ACrowdOfAStateGoesOnAsBefore) {
  Crowd crowd(device(), flatGround(), walledScene(12));
  crowd.steer(0, Goal{.kind = Goal::Kind::point, .target = {-6, 5}, .speed = 1});
  simulate(device(), crowd, 60);
  Crowd again(device(), parseState(crowd.saveToMemory(), "a state"));
  for (Crowd* each : {&crowd, &again}) simulate(device(), *each, 60);
  EXPECT_EQ(crowd.stateHash(), again.stateHash());
}

// Each of a kind's buffers once, however its herds share it.
TEST_F(WaysTest, MemoryOfWallsFieldsAndTrailsIsCounted) {
  Scene scene = walledScene(5);
  scene.herds[0].avoid = true;
  scene.herds.push_back(scene.herds[0]);
  scene.herds[1].agents = 12;
  scene.herds.push_back(sceneOf(3).herds[0]);
  scene.herds.push_back(sceneOf(4).herds[0]);
  scene.herds[3].forage = Forage{};
  const Crowd crowd(device(), flatGround(), scene);
  const auto bytesOf = [&](uint32_t herd, const char* name) {
    uint64_t bytes = 0;
    for (const MemoryUse& use : crowd.memoryUse(herd))
      if (use.name == name) bytes += use.bytes;
    return bytes;
  };
  const crowd::Kind &finding = implOf(crowd).kindOf(0), &foraging = implOf(crowd).kindOf(3);
  ASSERT_EQ(&finding, &implOf(crowd).kindOf(1));
  EXPECT_EQ(bytesOf(0, "walls") + bytesOf(1, "walls"), finding.wallBuffer.size());
  EXPECT_EQ(bytesOf(0, "ways") + bytesOf(1, "ways"), finding.ways->memoryBytes());
  EXPECT_GT(bytesOf(0, "walls"), 0u);
  EXPECT_GT(bytesOf(1, "ways"), bytesOf(0, "ways"));
  // 128 x 128 cells: a cost, a time and a record of one field.
  EXPECT_GE(finding.ways->memoryBytes(), 128u * 128 * (4 + 20));
  EXPECT_EQ(bytesOf(3, "trails"), foraging.trails->memoryBytes());
  EXPECT_GT(bytesOf(3, "trails"), 0u);
  for (const char* name : {"walls", "ways", "trails"}) EXPECT_EQ(bytesOf(2, name), 0u) << name;
  EXPECT_EQ(bytesOf(0, "trails") + bytesOf(3, "ways") + bytesOf(3, "walls"), 0u);
  uint64_t all = 0;
  for (uint32_t herd = 0; herd < 4; ++herd)
    for (const MemoryUse& use : crowd.memoryUse(herd)) all += use.bytes;
  EXPECT_EQ(all, crowd.memoryBytes());
}

TEST_F(WaysTest, GoalsAreRefusedWhereFieldsAreTooMany) {
  Crowd crowd(device(), flatGround(), walledScene(20));
  const auto goalOf = [](uint32_t i) {
    return Goal{.kind = Goal::Kind::point, .target = {static_cast<float>(i), 9}};
  };
  std::vector<Goal> goals;
  for (uint32_t i = 0; i < 20; ++i) goals.push_back(goalOf(i % 15));
  crowd.steer(0, goals);
  simulate(device(), crowd, 1);
  const AgentGoal last{crowd.agentId(0, 15), goalOf(15)};
  crowd.steer({&last, 1});
  simulate(device(), crowd, 1);
  const uint64_t hash = crowd.stateHash();
  const AgentGoal more{crowd.agentId(0, 0), goalOf(17)};
  EXPECT_NE(inputFault([&] { crowd.steer({&more, 1}); }).find("16"), std::string::npos);
  const AgentGoal wrong{crowd.agentId(0, 0), {.kind = Goal::Kind::point, .target = {NAN, 0}}};
  EXPECT_THROW(crowd.steer({&wrong, 1}), Error);
  EXPECT_EQ(crowd.stateHash(), hash);
  // Those that nobody has any more make room.
  crowd.steer(0, goalOf(3));
  simulate(device(), crowd, 1);
  crowd.steer({&more, 1});
  simulate(device(), crowd, 1);
  EXPECT_EQ(crowd.cannotReach(0), 0u);
}

// New goals and new ground on the way, in lock step.
TEST_P(WaysReplayTest, TheReferenceFollowsGoalsAndEdits) {
  Heightfield ground = smallRollingGround();
  Crowd crowd(device(), ground, walledScene(24));
  for (int part = 0; part < 4; ++part) {
    if (part == 1) crowd.steer(0, Goal{.kind = Goal::Kind::point, .target = {-5, 4}, .speed = 2});
    if (part == 2) {
      const std::vector<float> ridge(4 * 3, 5.0f);
      crowd.editHeights(30, 30, 4, 3, ridge);
    }
    if (part == 3) crowd.steer(0, Goal{.kind = Goal::Kind::point, .target = {40, 40}, .speed = 2});
    simulate(device(), crowd, 1);
    expectAllPass(replay(device(), crowd, crowd.terrain(), 40));
  }
}

INSTANTIATE_TEST_SUITE_P(, WaysReplayTest, bothLoadPaths(), loadPathName);

// In the middle, in two corners, along an edge, and of one sample.
TEST_F(WaysTest, EditsMakeOnlyTheCostsAroundThemAnew) {
  Scene scene = walledScene(1);
  scene.obstacles.push_back({Disc{.centre = {-20, 20}, .radius = 3}});
  Heightfield ground = smallRollingGround();
  ground.spacingZ = 0.7f;
  Crowd crowd(device(), ground, scene);
  const crowd::Kind& kind = implOf(crowd).kindOf(0);
  const Traveller traveller{.legLength = kind.rig.legLength,
                            .footprint = crowd::footprintRadius(kind.rig),
                            .margin = kind.parameters.edgeMargin,
                            .ways = *scene.herds[0].ways};
  struct Edit {
    uint32_t x, z, columns, rows;
  };
  for (const auto& [x, z, columns, rows] :
       {Edit{30, 30, 4, 3}, Edit{0, 0, 9, 9}, Edit{60, 58, 5, 7}, Edit{0, 20, 65, 1}, Edit{17, 11, 1, 1}}) {
    const CostGrid before = kind.ground;
    crowd.editHeights(x, z, columns, rows, std::vector<float>(size_t{columns} * rows, 3.0f));
    simulate(device(), crowd, 1);
    EXPECT_NE(kind.ground, before) << x << ", " << z;
    EXPECT_EQ(kind.ground, costGrid(crowd.terrain(), scene.obstacles, traveller)) << x << ", " << z;
  }
}

TEST_F(WaysTest, EditsMakeFieldsAnew) {
  Crowd crowd(device(), flatGround(), walledScene(4));
  const auto times = [&] {
    const crowd::WayFields& ways = *implOf(crowd).kindOf(0).ways;
    return ways.times(ways.goals().at(0));
  };
  const std::vector<float> before = times();
  const std::vector<float> ridge(20 * 3, 4.0f);
  crowd.editHeights(60, 40, 20, 3, ridge);
  EXPECT_EQ(times(), before);
  simulate(device(), crowd, 1);
  EXPECT_NE(times(), before);
  expectAsReference(*implOf(crowd).kindOf(0).ways, implOf(crowd).kindOf(0).ways->goals().at(0));
}

}  // namespace
}  // namespace skitter::test
