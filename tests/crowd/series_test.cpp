// Goals from place to place (docs/ways.md#goals-in-series).
#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <vector>

#include "assets/files.h"
#include "crowd/herd.h"
#include "crowd/simulation.h"
#include "crowd/ways/look.h"
#include "crowd/ways/series.h"
#include "shared/ways.h"
#include "skitter/error.h"
#include "skitter/state.h"
#include "validation/herd_facts.h"

namespace skitter::test {
namespace {

using SeriesTest = GpuTest;
using SeriesReplayTest = GpuLoadTest;

Goal routeOver(std::vector<glm::vec2> places, bool loop = false) {
  return {.kind = Goal::Kind::route, .speed = 2, .places = std::move(places), .loop = loop};
}
Goal roamIn(float radius) {
  return {.kind = Goal::Kind::roam, .target = {1, 2}, .speed = 2, .radius = radius};
}
Goal following(uint32_t herd) { return {.kind = Goal::Kind::follow, .speed = 2, .leader = herd}; }

Scene sceneWith(const Goal& goal, uint32_t agents = 9) {
  Scene scene = sceneOf(agents, 2);
  scene.herds[0].ways = Ways{};
  scene.herds[0].spawn = {.kind = Spawn::Kind::grid, .spacing = 1, .centre = {0, -8}};
  scene.herds[0].goal = goal;
  return scene;
}

// The number of the place that each agent goes to.
std::vector<int> numbersIn(const Crowd& crowd) {
  const HerdState state = crowd.download(0);
  std::vector<int> numbers;
  for (size_t i = 0; i < state.agents; ++i) numbers.push_back(static_cast<int>(state.goal[8 * i + 2]));
  return numbers;
}

double farthestOf(const Crowd& crowd, const glm::dvec2& place, uint32_t herd = 0) {
  const HerdState state = crowd.download(herd);
  double farthest = 0;
  for (size_t i = 0; i < state.agents; ++i) {
    const glm::dvec3 at = positionOf(state, i);
    farthest = std::max(farthest, std::hypot(at.x - place.x, at.z - place.y));
  }
  return farthest;
}

TEST(SeriesTable, GivesPlacesTheLowestNumbersThatAreFree) {
  crowd::SeriesTable table;
  const auto put = [&](std::vector<glm::vec2> places, bool loop = false) {
    const Goal goal = routeOver(places, loop);
    return crowd::enlist(table, goal, std::move(places));
  };
  ASSERT_TRUE(put({{1, 1}, {2, 2}, {3, 3}}));
  ASSERT_TRUE(put({{4, 4}, {5, 5}}, true));
  table.erase(table.begin());
  ASSERT_TRUE(put({{6, 6}}));
  ASSERT_TRUE(put({{7, 7}, {8, 8}, {9, 9}}));
  const std::vector<glm::vec4> expected = {{6, 6, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}, {4, 4, 4, 1},
                                           {5, 5, 3, 1}, {7, 7, 6, 1}, {8, 8, 7, 1}, {9, 9, 5, 0}};
  EXPECT_EQ(crowd::placesIn(table), expected);
  EXPECT_EQ(crowd::seriesAt(table, 1), nullptr);
  EXPECT_EQ(crowd::seriesAt(table, 4)->first, 3u);
  Goal faster = routeOver({{6, 6}});
  faster.speed = 9;
  EXPECT_EQ(crowd::findSeries(table, faster)->first, 0u);
  EXPECT_EQ(crowd::findSeries(table, routeOver({{6, 6}}, true)), nullptr);
  EXPECT_FALSE(crowd::enlist(table, routeOver({{0, 0}}), std::vector<glm::vec2>(64)));
}

TEST(SeriesTable, ScattersPlacesWithinTheDisc) {
  const Goal goal = roamIn(5);
  const std::vector<glm::vec2> places = crowd::scattered(goal, 7);
  EXPECT_EQ(places.size(), 8u);
  for (const glm::vec2& place : places) EXPECT_LT(glm::distance(place, goal.target), 5);
  EXPECT_EQ(places, crowd::scattered(goal, 7));
  EXPECT_NE(places, crowd::scattered(goal, 8));
}

TEST_F(SeriesTest, ARouteLeadsOverItsPlacesToTheLast) {
  Scene scene = sceneWith(routeOver({{-9, -2}, {9, 2}, {0, 10}}));
  scene.obstacles = {{Capsule{.from = {-4, 0}, .to = {4, 0}, .radius = 0.3f}}};
  Crowd crowd(device(), flatGround(), scene);
  std::vector<int> last = numbersIn(crowd);
  EXPECT_EQ(std::set<int>(last.begin(), last.end()), std::set<int>{0});
  std::vector<std::set<int>> seen(9);
  for (int part = 0; part < 140; ++part) {
    simulate(device(), crowd, 10);
    const std::vector<int> now = numbersIn(crowd);
    for (size_t i = 0; i < now.size(); ++i) {
      EXPECT_GE(now[i], last[i]);
      seen[i].insert(now[i]);
    }
    last = now;
  }
  for (const std::set<int>& each : seen) EXPECT_EQ(each, (std::set<int>{0, 1, 2}));
  EXPECT_LT(farthestOf(crowd, {0, 10}), 1);
}

TEST_F(SeriesTest, ALoopBeginsAnew) {
  Crowd crowd(device(), flatGround(), sceneWith(routeOver({{-4, -8}, {4, -8}}, true), 4));
  int turns = 0;
  std::vector<int> last = numbersIn(crowd);
  for (int part = 0; part < 120; ++part) {
    simulate(device(), crowd, 10);
    const std::vector<int> now = numbersIn(crowd);
    for (size_t i = 0; i < now.size(); ++i) turns += now[i] < last[i];
    last = now;
  }
  // 20 s at 2 m/s, 16 m and what passing early and turning make of it: two rounds each at least.
  EXPECT_GE(turns, 2 * 4);
}

TEST_F(SeriesTest, RoamersStayInTheirDiscAndGoToAllOfIt) {
  Crowd crowd(device(), flatGround(), sceneWith(roamIn(7), 16));
  simulate(device(), crowd, 600);
  std::set<int> seen;
  for (int part = 0; part < 60; ++part) {
    simulate(device(), crowd, 20);
    const std::vector<int> now = numbersIn(crowd);
    seen.insert(now.begin(), now.end());
    EXPECT_LT(farthestOf(crowd, {1, 2}), 7 + 2) << "part " << part;  // they turn in an arc
  }
  EXPECT_EQ(seen, (std::set<int>{0, 1, 2, 3, 4, 5, 6, 7}));
}

// Each agent draws by its seed alone, however the crowd is paged.
TEST_F(SeriesTest, AHerdHasTheSameHashInEveryPaging) {
  std::vector<uint64_t> hashes;
  for (const uint32_t pageAgents : {0u, 0u, 16u}) {
    Crowd crowd(device(), flatGround(), sceneWith(roamIn(7), 40), {.pageAgents = pageAgents});
    simulate(device(), crowd, 200);
    hashes.push_back(crowd.stateHash());
  }
  EXPECT_EQ(hashes[0], hashes[1]);
  EXPECT_EQ(hashes[0], hashes[2]);
}

// A herd that goes away, and one that follows it.
Scene chase() {
  Scene scene = sceneWith(following(1));
  Herd leader = sceneOf(4).herds[0];
  leader.spawn = {.kind = Spawn::Kind::grid, .spacing = 1, .centre = {6, 0}};
  leader.goal = {.kind = Goal::Kind::point, .target = {-8, 10}, .speed = 1};
  scene.herds.push_back(leader);
  return scene;
}

TEST_F(SeriesTest, FollowersComeToTheMiddleOfTheHerd) {
  Crowd crowd(device(), flatGround(), chase());
  simulate(device(), crowd, 600);
  EXPECT_LT(farthestOf(crowd, {6, 0}), 20);
  simulate(device(), crowd, 900);
  EXPECT_LT(farthestOf(crowd, {-8, 10}, 1), 2);
  EXPECT_LT(farthestOf(crowd, {-8, 10}), 2);
}

TEST_F(SeriesTest, FollowersOfOneAgentComeToIt) {
  Scene scene = chase();
  scene.herds[0].goal.agent = 2;
  Crowd crowd(device(), flatGround(), scene);
  crowd.steer(1, Goal{.kind = Goal::Kind::none});
  const AgentGoal away{crowd.agentId(1, 2), {.kind = Goal::Kind::point, .target = {10, -9}, .speed = 2}};
  crowd.steer({&away, 1});
  simulate(device(), crowd, 900);
  EXPECT_LT(farthestOf(crowd, {10, -9}), 2);
}

// In herds of several sizes and pages, and where the host has just said where somebody is.
TEST_F(SeriesTest, ALeaderIsWhereItsRecordSaysOrTheHost) {
  Scene scene = chase();
  scene.herds[1].agents = 21;
  scene.herds[1].reserve = 2;
  scene.herds[1].sizes = {1, 0.5f};
  Crowd crowd(device(), flatGround(), scene, {.pageAgents = 8});
  simulate(device(), crowd, 40);
  const auto placeOf = [&](std::optional<uint32_t> agent) {
    Goal goal = following(1);
    goal.agent = agent;
    return crowd::leaderOf(implOf(crowd), goal);
  };
  const HerdState state = crowd.download(1);
  glm::dvec2 sum(0);
  uint32_t present = 0;
  for (uint32_t agent = 0; agent < crowd.places(1); ++agent) {
    const std::optional<glm::vec2> place = placeOf(agent);
    const bool isThere = state.body[size_t{agent} * 4 * shared::BODY_STRIDE + 7] == 0;
    ASSERT_EQ(place.has_value(), isThere) << agent;
    if (!isThere) continue;
    const glm::dvec3 at = positionOf(state, agent);
    EXPECT_EQ(*place, glm::vec2(at.x, at.z)) << agent;
    sum += glm::dvec2(at.x, at.z);
    ++present;
  }
  EXPECT_EQ(present, 21u);
  EXPECT_LT(glm::distance(placeOf({}).value(), glm::vec2(sum / 21.0)), 1e-5);
  EXPECT_FALSE(placeOf(23));
  const AgentId told = crowd.agentId(1, 3);
  crowd.teleport(told, {{-7, 5}, 0});
  EXPECT_EQ(placeOf(3), glm::vec2(-7, 5));
  crowd.remove(told);
  EXPECT_FALSE(placeOf(3));
}

TEST_F(SeriesTest, WhoFleesStandsUntilAThreatComes) {
  Crowd crowd(device(), flatGround(), sceneWith({.kind = Goal::Kind::flee, .speed = 2}, 16));
  EXPECT_EQ(crowd.cannotReach(0), 0u);
  simulate(device(), crowd, 120);
  EXPECT_LT(farthestOf(crowd, {0, -8}), 3);
  crowd.setThreat(0, {.centre = {0, -8}, .radius = 5});
  simulate(device(), crowd, 300);
  const HerdState state = crowd.download(0);
  for (size_t i = 0; i < state.agents; ++i) {
    const glm::dvec3 at = positionOf(state, i);
    EXPECT_GT(std::hypot(at.x, at.z + 8), 5.85) << i;  // the threat, its growth and a cell
    EXPECT_LT(std::hypot(at.x, at.z + 8), 5 + 2.5) << i;
  }
}

TEST_F(SeriesTest, EventsAndCallsAreTheSame) {
  Scene scene = sceneWith(roamIn(5));
  Crowd told(device(), flatGround(), scene);
  scene.events = {{0.5f, GoalChange{.agents = {1, 4}, .goal = routeOver({{3, 3}, {-3, 4}}, true)}}};
  Crowd happened(device(), flatGround(), scene);
  simulate(device(), told, 29);
  const Goal goal = routeOver({{3, 3}, {-3, 4}}, true);
  const std::vector<AgentGoal> goals = {{told.agentId(0, 1), goal}, {told.agentId(0, 4), goal}};
  told.steer(goals);
  simulate(device(), told, 91);
  simulate(device(), happened, 120);
  EXPECT_EQ(told.stateHash(), happened.stateHash());
}

TEST_F(SeriesTest, ACrowdOfAStateGoesOnAsBefore) {
  Scene scene = chase();
  Crowd crowd(device(), flatGround(), scene);
  const std::vector<AgentGoal> goals = {{crowd.agentId(0, 0), roamIn(4)},
                                        {crowd.agentId(0, 1), routeOver({{3, 3}, {-3, 4}}, true)},
                                        {crowd.agentId(0, 2), {.kind = Goal::Kind::flee}}};
  crowd.steer(goals);
  simulate(device(), crowd, 100);
  Crowd again(device(), parseState(crowd.saveToMemory(), "a state"));
  for (Crowd* each : {&crowd, &again}) simulate(device(), *each, 200);
  EXPECT_EQ(crowd.stateHash(), again.stateHash());
}

TEST_F(SeriesTest, ManyGoalsOneAfterTheOtherFindRoom) {
  Crowd crowd(device(), flatGround(), sceneWith(roamIn(5)));
  Goal goal;
  for (int i = 0; i < 12; ++i) {
    std::vector<glm::vec2> places;
    for (int n = 0; n < 8; ++n) places.emplace_back(n - 4, i - 6);
    goal = routeOver(places);
    crowd.steer(0, goal);
    simulate(device(), crowd, 2);
  }
  const crowd::Kind& kind = implOf(crowd).kindOf(0);
  const crowd::Series* series = crowd::findSeries(kind.series, goal);
  ASSERT_NE(series, nullptr);
  for (const glm::vec2& place : series->places) EXPECT_TRUE(kind.ways->has(place));
}

TEST_F(SeriesTest, GoalsThatCannotBeAreRefused) {
  Crowd crowd(device(), flatGround(), chase());
  simulate(device(), crowd, 1);
  const uint64_t hash = crowd.stateHash();
  const auto faultOf = [&](const Goal& goal, uint32_t herd = 0) {
    return inputFault([&] { crowd.steer(herd, goal); });
  };
  EXPECT_EQ(faultOf(roamIn(5), 1),
            "herd 1: goal.kind is route, roam, follow or flee, expected a herd with ways");
  EXPECT_EQ(faultOf(routeOver({})), "herd 0: goal.places are 0, expected 1 to 16");
  EXPECT_EQ(faultOf(routeOver({{0, 0}, {0, NAN}})),
            "herd 0: a goal.places z is nan m, expected -4096 to 4096");
  EXPECT_EQ(faultOf(roamIn(0)), "herd 0: goal.radius is 0 m, expected 0.01 to 4096");
  EXPECT_NE(faultOf(following(7)).find("herd 7"), std::string::npos);
  Goal nobody = following(1);
  nobody.agent = 4;
  EXPECT_EQ(faultOf(nobody), "herd 0: goal.agent is 4, expected less than 4, the places of herd 1");
  // 16 places of one goal and another one's place.
  std::vector<glm::vec2> places;
  for (int n = 0; n < 16; ++n) places.emplace_back(n - 7, 1);
  std::vector<Goal> goals(9, routeOver(places));
  goals[3] = routeOver({{0, 9}});
  EXPECT_NE(inputFault([&] { crowd.steer(0, goals); }).find("16 places"), std::string::npos);
  simulate(device(), crowd, 0);
  EXPECT_EQ(crowd.stateHash(), hash);
  Scene scene = sceneWith(following(3));
  EXPECT_NE(inputFault([&] {
              Crowd(device(), flatGround(), scene);
            }).find("herds[0].goal.herd is 3, expected less than 1, the number of herds"),
            std::string::npos);
  scene = sceneWith(roamIn(5));
  scene.herds[0].ways = {};
  EXPECT_NE(inputFault([&] { Crowd(device(), flatGround(), scene); }).find("expected a herd with ways"),
            std::string::npos);
}

TEST_P(SeriesReplayTest, TheReferenceGoesFromPlaceToPlace) {
  const Heightfield ground = smallRollingGround();
  Scene scene = chase();
  scene.herds[0].agents = 24;
  Crowd crowd(device(), ground, scene);
  std::vector<Goal> goals(24, roamIn(4));
  for (size_t i = 0; i < 8; ++i) goals[i] = following(1);
  for (size_t i = 8; i < 12; ++i) goals[i] = routeOver({{-3, -6}, {3, -6}}, true);
  goals[12] = {.kind = Goal::Kind::flee};
  crowd.steer(0, goals);
  // Between two looks at those who lead.
  for (int part = 0; part < 8; ++part) {
    simulate(device(), crowd, 1);
    expectAllPass(replay(device(), crowd, ground, 13));
    simulate(device(), crowd, 1);
  }
}

INSTANTIATE_TEST_SUITE_P(, SeriesReplayTest, bothLoadPaths(), loadPathName);

}  // namespace
}  // namespace skitter::test
