// Worlds that are hard to find a way in, or have none (docs/ways.md): they are refused, or they work.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "assets/files.h"
#include "cpu_reference/ways/grid.h"
#include "crowd/herd.h"
#include "crowd/radius.h"
#include "crowd/simulation.h"
#include "skitter/error.h"

namespace skitter::test {
namespace {

using HardWaysTest = GpuTest;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// 32 m a side.
Heightfield smallFlatGround() { return generateHeightfield({.columns = 65, .rows = 65, .amplitude = 0}); }

// South of the middle; the goal is in the north.
Scene hardScene(uint32_t agents) {
  Scene scene = sceneOf(agents, 2);
  scene.herds[0].ways = Ways{};
  scene.herds[0].spawn = {.kind = Spawn::Kind::grid, .spacing = 1, .centre = {0, -6}};
  scene.herds[0].goal = {.kind = Goal::Kind::point, .target = {0, 7}, .speed = 2};
  return scene;
}

// A wall along x that leaves a gap of so many metres about x = 0.
std::vector<Obstacle> wallWithGapOf(float metres) {
  const float end = metres / 2;
  return {{ConvexPolygon{.corners = {{-40, -0.3f}, {-end, -0.3f}, {-end, 0.3f}, {-40, 0.3f}}}},
          {ConvexPolygon{.corners = {{end, -0.3f}, {40, -0.3f}, {40, 0.3f}, {end, 0.3f}}}}};
}

std::vector<glm::dvec2> placesOf(const Crowd& crowd, uint32_t herd = 0) {
  const HerdState state = crowd.download(herd);
  std::vector<glm::dvec2> places;
  for (size_t i = 0; i < state.agents; ++i) {
    const glm::dvec3 at = positionOf(state, i);
    EXPECT_TRUE(std::isfinite(at.x) && std::isfinite(at.y) && std::isfinite(at.z)) << "agent " << i;
    places.emplace_back(at.x, at.z);
  }
  return places;
}

// The gap of 0.6 m is narrower than the footprint of 0.7 m, the other one leaves a cell beside it.
TEST_F(HardWaysTest, AGapIsPassedOnlyByThoseWhoFit) {
  const float body = 2 * crowd::footprintRadius(spiderRig());
  for (const float gap : {0.85f * body, 2 * body}) {
    const bool fits = gap > body;
    Scene scene = hardScene(9);
    scene.obstacles = wallWithGapOf(gap);
    Crowd crowd(device(), smallFlatGround(), scene);
    EXPECT_EQ(crowd.cannotReach(0), fits ? 0u : 9u) << gap;
    for (int part = 0; part < 30; ++part) {
      simulate(device(), crowd, 30);
      for (const glm::dvec2& at : placesOf(crowd)) {
        if (!fits) {
          EXPECT_LT(at.y, -0.3) << gap << ", part " << part;
        }
      }
    }
    for (const glm::dvec2& at : placesOf(crowd)) {
      // The wall, its growth by less than a cell, a cell, and the arrival radius of half a leg.
      if (fits)
        EXPECT_LT(glm::distance(at, {0, 7}), 1) << gap;
      else
        EXPECT_LT(glm::distance(at, {0, 0}), 0.3 + 0.5 + 0.5 + 0.5) << gap;
    }
  }
}

TEST_F(HardWaysTest, HerdsOfNobodyAndOfOneAreNoCase) {
  using Kind = Goal::Kind;
  const std::vector<Goal> goals = {{.kind = Kind::point, .target = {2, 3}},
                                   {.kind = Kind::route, .places = {{2, 3}, {-3, 3}}, .loop = true},
                                   {.kind = Kind::roam, .radius = 3},
                                   {.kind = Kind::follow, .leader = 1},
                                   {.kind = Kind::flee}};
  for (const uint32_t agents : {0u, 1u})
    for (const Goal& goal : goals) {
      SCOPED_TRACE(testing::Message() << agents << " agents, kind " << static_cast<int>(goal.kind));
      Scene scene = hardScene(agents);
      scene.herds[0].goal = goal;
      scene.herds.push_back(sceneOf(agents).herds[0]);
      scene.herds[1].threat = goal.kind == Kind::follow ? 0.0f : 2.0f;  // nobody comes to a threat
      scene.threats = {{.centre = {5, 5}, .radius = 2}};
      std::vector<uint64_t> hashes;
      for (const bool again : {false, true}) {
        if (again && agents == 0) continue;
        Crowd crowd(device(), smallFlatGround(), scene);
        simulate(device(), crowd, 60);
        EXPECT_EQ(crowd.cannotReach(0), 0u);
        EXPECT_EQ(placesOf(crowd).size(), agents);
        hashes.push_back(crowd.stateHash());
      }
      EXPECT_EQ(hashes.front(), hashes.back());
    }
}

// With and without avoiding each other. Who avoids stands beside the goal in the end.
TEST_F(HardWaysTest, AllMayBeginAtOnePoint) {
  for (const bool avoid : {false, true}) {
    Scene scene = hardScene(16);
    scene.herds[0].avoid = avoid;
    scene.obstacles = {{Disc{.centre = {0, 0}, .radius = 2}}};
    Crowd crowd(device(), smallFlatGround(), scene);
    std::vector<AgentPlace> places;
    for (uint32_t i = 0; i < 16; ++i) places.push_back({crowd.agentId(0, i), {{0, -6}, 0}});
    crowd.teleport(places);
    simulate(device(), crowd, 1);
    for (const glm::dvec2& at : placesOf(crowd)) EXPECT_LT(glm::distance(at, {0, -6}), 0.1);
    simulate(device(), crowd, 1800);
    // Agents that stand try to keep one and a half footprints apart: sixteen discs of 1.05 m take a disc of
    // 2.1 m and the room between them.
    for (const glm::dvec2& at : placesOf(crowd))
      EXPECT_LT(glm::distance(at, {0, 7}), avoid ? 4 : 1) << (avoid ? "who avoid" : "who do not");
  }
}

// Obstacles that reach beyond the edges and corners of the map, and one that is not on it at all.
TEST(CostGrid, ObstaclesReachBeyondTheEdge) {
  const Heightfield ground = smallFlatGround();
  const std::vector<Obstacle> obstacles = {{Disc{.centre = {-16, -16}, .radius = 3}},
                                           {Disc{.centre = {17, 2}, .radius = 2.5f}},
                                           {Capsule{.from = {-4096, 9}, .to = {-10, 9}, .radius = 0.5f}},
                                           {ConvexPolygon{.corners = {{4, 12}, {9, 12}, {9, 60}, {4, 60}}}}};
  const Traveller traveller{.legLength = 1, .footprint = 0.35f, .margin = 0};
  const CostGrid grid = costGrid(ground, obstacles, traveller);
  const reference::Heights heights{ground.heights.data(),    65, 65, double{ground.originX()},
                                   double{ground.originZ()}, 2,  2};
  const reference::WayGrid expected =
      reference::wayGrid(heights,
                         {.discs = {{{-16, -16}, 3}, {{17, 2}, 2.5}},
                          .capsules = {{{-4096, 9}, {-10, 9}, 0.5}},
                          .polygons = {{{{4, 12}, {9, 12}, {9, 60}, {4, 60}}}}},
                         {.legLength = 1,
                          .footprint = double{0.35f},
                          .edgeMargin = 0,
                          .climb = 1.5,
                          .steepest = 1.5,
                          .step = 0.5});
  ASSERT_EQ(grid.cost.size(), expected.cells());
  size_t blocked = 0, onEdge = 0;
  for (size_t at = 0; at < grid.cost.size(); ++at) {
    if (expected.margin[at] > 1e-4) {  // places of 16 m in float32, of 0.35 m
      EXPECT_EQ(std::isfinite(grid.cost[at]), expected.passable(at)) << at;
    }
    const size_t column = at % grid.columns, row = at / grid.columns;
    const bool isOnEdge = column == 0 || row == 0 || column + 1 == grid.columns || row + 1 == grid.rows;
    blocked += std::isinf(grid.cost[at]);
    onEdge += isOnEdge && std::isinf(grid.cost[at]);
  }
  EXPECT_GT(onEdge, 20u);
  EXPECT_GT(blocked, onEdge);
  EXPECT_LT(blocked, grid.cost.size() / 4);
  // One that is far away is none.
  const Obstacle away{Disc{.centre = {0, -60}, .radius = 40}};
  EXPECT_EQ(costGrid(ground, {&away, 1}, traveller), costGrid(ground, {}, traveller));
}

// The only way leads along the edge of the map, round a wall that begins beyond the other one.
TEST_F(HardWaysTest, TheEdgeOfTheMapIsNoWay) {
  Scene scene = hardScene(9);
  // Agents keep 2 m from the edge at 16 m, where a way of 1 m is left, and then none.
  for (const float end : {12.5f, 14.5f}) {
    scene.obstacles = {{Capsule{.from = {-60, 0}, .to = {end, 0}, .radius = 0.2f}}};
    Crowd crowd(device(), smallFlatGround(), scene);
    EXPECT_EQ(crowd.cannotReach(0), end < 13 ? 0u : 9u) << end;
    simulate(device(), crowd, 1800);
    for (const glm::dvec2& at : placesOf(crowd)) EXPECT_EQ(at.y > 0, end < 13) << end;
  }
}

TEST_F(HardWaysTest, WithoutGroundToWalkOnAgentsStand) {
  Scene scene = hardScene(4);
  scene.obstacles = {{Disc{.centre = {0, 0}, .radius = 100}}};
  Crowd crowd(device(), smallFlatGround(), scene);
  EXPECT_EQ(crowd.cannotReach(0), 4u);
  const std::vector<glm::dvec2> before = placesOf(crowd);
  simulate(device(), crowd, 120);
  for (size_t i = 0; i < before.size(); ++i)
    EXPECT_LT(glm::distance(placesOf(crowd)[i], before[i]), 0.1) << i;
  // A goal that comes then leads nowhere either.
  crowd.steer(0, Goal{.kind = Goal::Kind::point, .target = {5, 5}, .speed = 2});
  simulate(device(), crowd, 60);
  EXPECT_EQ(crowd.cannotReach(0), 4u);
  for (size_t i = 0; i < before.size(); ++i)
    EXPECT_LT(glm::distance(placesOf(crowd)[i], before[i]), 0.1) << i;
}

TEST_F(HardWaysTest, AThreatMayBeEverywhereAndGoAgain) {
  Crowd crowd(device(), smallFlatGround(), hardScene(4));
  simulate(device(), crowd, 30);
  crowd.setThreat(0, {.centre = {0, 0}, .radius = 4096});
  simulate(device(), crowd, 90);
  EXPECT_EQ(crowd.cannotReach(0), 4u);
  const std::vector<glm::dvec2> before = placesOf(crowd);
  simulate(device(), crowd, 60);
  for (size_t i = 0; i < before.size(); ++i)
    EXPECT_LT(glm::distance(placesOf(crowd)[i], before[i]), 0.1) << i;
  crowd.setThreat(0, {.radius = 0});
  simulate(device(), crowd, 900);
  EXPECT_EQ(crowd.cannotReach(0), 0u);
  for (const glm::dvec2& at : placesOf(crowd)) EXPECT_LT(glm::distance(at, {0, 7}), 1);
}

// A goal of each kind with a number that is none, and what is said of it.
struct WrongGoal {
  Goal goal;
  const char* fault;
};
std::vector<WrongGoal> goalsWithNan() {
  using Kind = Goal::Kind;
  return {{{.kind = Kind::cross, .speed = kNan}, "goal.speed is nan m/s, expected 0 to 1000"},
          {{.kind = Kind::point, .target = {kNan, 0}}, "goal.target x is nan m, expected -4096 to 4096"},
          {{.kind = Kind::point, .target = {0, kNan}}, "goal.target z is nan m, expected -4096 to 4096"},
          {{.kind = Kind::point, .speed = kNan}, "goal.speed is nan m/s, expected 0 to 1000"},
          {{.kind = Kind::velocity, .velocity = {0, kNan}},
           "the length of goal.velocity is nan m/s, expected 0 to 1000"},
          {{.kind = Kind::route, .places = {{1, 1}, {kNan, 0}}},
           "a goal.places x is nan m, expected -4096 to 4096"},
          {{.kind = Kind::roam, .target = {0, kNan}}, "goal.target z is nan m, expected -4096 to 4096"},
          {{.kind = Kind::roam, .radius = kNan}, "goal.radius is nan m, expected 0.01 to 4096"},
          {{.kind = Kind::follow, .speed = kNan}, "goal.speed is nan m/s, expected 0 to 1000"},
          {{.kind = Kind::flee, .speed = kNan}, "goal.speed is nan m/s, expected 0 to 1000"}};
}

TEST_F(HardWaysTest, GoalsThatAreNoNumberAreRefused) {
  Scene scene = hardScene(3);
  scene.herds[0].reserve = 1;
  Crowd crowd(device(), smallFlatGround(), scene);
  simulate(device(), crowd, 1);
  const uint64_t hash = crowd.stateHash();
  for (const auto& [goal, fault] : goalsWithNan()) {
    EXPECT_EQ(inputFault([&] { crowd.steer(0, goal); }), std::string("herd 0: ") + fault);
    std::vector<Goal> each(4, scene.herds[0].goal);
    each[2] = goal;
    EXPECT_EQ(inputFault([&] { crowd.steer(0, each); }), std::string("herd 0, agent 2: ") + fault);
    const AgentGoal one{crowd.agentId(0, 1), goal};
    EXPECT_EQ(inputFault([&] { crowd.steer({&one, 1}); }), std::string("herd 0, agent 1: ") + fault);
    EXPECT_EQ(inputFault([&] { crowd.add(0, {}, goal); }), std::string("herd 0, a new agent: ") + fault);
    const auto faultOfScene = [&](const auto& change) {
      Scene wrong = scene;
      change(wrong);
      return inputFault([&] { Crowd(device(), smallFlatGround(), wrong); });
    };
    EXPECT_EQ(faultOfScene([&](Scene& wrong) { wrong.herds[0].goal = goal; }),
              std::string("built-in: herds[0]: ") + fault);
    EXPECT_EQ(faultOfScene([&](Scene& wrong) {
                wrong.events = {{0, GoalChange{.goal = goal}}};
              }),
              std::string("built-in: events[0]: ") + fault);
    EXPECT_EQ(faultOfScene([&](Scene& wrong) {
                wrong.events = {{0, Addition{.arrivals = {{.goal = goal}}}}};
              }),
              std::string("built-in: events[0].add[0]: ") + fault);
  }
  simulate(device(), crowd, 0);
  EXPECT_EQ(crowd.stateHash(), hash);
}

Goal goalNumber(uint32_t i) {
  return {.kind = Goal::Kind::point,
          .target = {0.5f * static_cast<float>(i % 40) - 10, 0.5f * static_cast<float>(i / 40) - 6},
          .speed = 2};
}

// At once they are more than there are fields, and nothing comes of it.
TEST_F(HardWaysTest, AThousandGoalsAtOnceAreRefused) {
  Scene scene = hardScene(1000);
  scene.herds[0].spawn.spacing = 0.5f;
  Crowd crowd(device(), smallFlatGround(), scene);
  simulate(device(), crowd, 1);
  const uint64_t hash = crowd.stateHash();
  std::vector<Goal> goals;
  for (uint32_t i = 0; i < 1000; ++i) goals.push_back(goalNumber(i));
  EXPECT_EQ(inputFault([&] { crowd.steer(0, goals); }),
            "herd 0: its goals, and those of agents like it, are more than 16 places that ways lead to, "
            "expected at most as many");
  simulate(device(), crowd, 0);
  EXPECT_EQ(crowd.stateHash(), hash);
  // Goals that need no field are as many as there are agents.
  for (uint32_t i = 0; i < 1000; ++i)
    goals[i] = {.kind = Goal::Kind::velocity, .velocity = {0, 0.001f * static_cast<float>(i)}};
  crowd.steer(0, goals);
  simulate(device(), crowd, 1);

  Scene herds = hardScene(1);
  herds.herds.resize(1000, herds.herds[0]);
  for (uint32_t i = 0; i < 1000; ++i) herds.herds[i].goal = goalNumber(i);
  EXPECT_EQ(inputFault([&] { Crowd(device(), smallFlatGround(), herds); }),
            "built-in: herd 16: its goal, and those of herds like it, are more than 16 places that ways lead "
            "to, expected at most as many");
}

TEST_F(HardWaysTest, AThousandGoalsOneAfterTheOtherFindRoom) {
  Crowd crowd(device(), smallFlatGround(), hardScene(4));
  for (uint32_t i = 0; i < 1000; ++i) crowd.steer(0, goalNumber(i));
  const crowd::WayFields& ways = *implOf(crowd).kindOf(0).ways;
  EXPECT_LE(ways.goals().size(), 16u);
  EXPECT_TRUE(ways.has(goalNumber(999).target));
  simulate(device(), crowd, 900);
  for (const glm::dvec2& at : placesOf(crowd))
    EXPECT_LT(glm::distance(at, glm::dvec2(goalNumber(999).target)), 1);
}

}  // namespace
}  // namespace skitter::test
