#include "skitter/crowd.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "public/public.h"
#include "skitter/decode.h"
#include "skitter/state.h"

namespace skitter::test {
namespace {

using PublicCrowd = PublicTest;

BodyState bodyIn(const Crowd& crowd, uint32_t herd, size_t agent) {
  const std::vector<float> records = crowd.download(herd).body;
  return bodyOf(std::span(records).subspan(16 * agent, 16));
}

Goal goingBy(float x, float z) { return {.kind = Goal::Kind::velocity, .velocity = {x, z}}; }

// Two kinds, of which one has room for two more.
Scene twoKinds() {
  Scene scene = standingScene(4, 2);
  scene.herds.push_back(standingScene(3).herds[0]);
  scene.herds[1].controller = Controller::loop;
  return scene;
}

TEST_F(PublicCrowd, CountsWhoIsThere) {
  Crowd first(device(), flatGround(), twoKinds(), {});
  Crowd crowd = std::move(first);
  EXPECT_EQ(crowd.herdCount(), 2u);
  EXPECT_EQ(crowd.agentCount(), 7u);
  EXPECT_EQ(crowd.agentCount(0), 4u);
  EXPECT_EQ(crowd.places(0), 6u);
  EXPECT_EQ(crowd.capacity(), 9u);
  EXPECT_EQ(crowd.watchEvery(), 1u);
  EXPECT_EQ(crowd.rig(1).legCount(), 8);
  EXPECT_EQ(&crowd.rig(0, 5), &crowd.rig(0));
  EXPECT_EQ(crowd.size(0, 0), 1);
  EXPECT_EQ(crowd.terrain().columns, 65u);
  EXPECT_EQ(crowd.tick(), 0u);
  walk(device(), crowd, 2);
  EXPECT_EQ(crowd.tick(), 2u);
  crowd = Crowd(device(), flatGround(), standingScene(1));
  EXPECT_EQ(crowd.agentCount(), 1u);
}

TEST_F(PublicCrowd, SharesOfMemoryAreTheWhole) {
  const Crowd crowd(device(), flatGround(), twoKinds());
  uint64_t bytes = 0;
  for (uint32_t herd = 0; herd < 2; ++herd)
    for (const MemoryUse& use : crowd.memoryUse(herd)) bytes += use.bytes;
  EXPECT_EQ(bytes, crowd.memoryBytes());
  EXPECT_GT(bytes, 9u * 64);
  EXPECT_GT(crowd.stateBytes(), 9u * 64);
}

TEST_F(PublicCrowd, GoesTheWayThatItIsToldTo) {
  Crowd crowd(device(), flatGround(), twoKinds());
  walk(device(), crowd, 1);
  crowd.steer(0, goingBy(1, 0));
  crowd.steer(1, std::vector<Goal>(3, goingBy(0, 1)));
  const AgentGoal one{crowd.agentId(1, 2), goingBy(0, -1)};
  crowd.steer({&one, 1});
  walk(device(), crowd, 240);
  const float along0 = bodyIn(crowd, 0, 1).velocity.x, along1 = bodyIn(crowd, 1, 0).velocity.z;
  EXPECT_GT(along0, 0.5f);
  EXPECT_GT(along1, 0.5f);
  EXPECT_LT(bodyIn(crowd, 1, 2).velocity.z, -0.5f);

  crowd.setSpeed(0, 0.0f);
  crowd.setSpeed(1, std::vector<float>(3, 0.0f));
  const AgentSpeed slower{crowd.agentId(1, 2), 0.5f};
  crowd.setSpeed({&slower, 1});
  walk(device(), crowd, 120);
  EXPECT_LT(glm::length(bodyIn(crowd, 0, 1).velocity), 0.1f);
  EXPECT_LT(glm::length(bodyIn(crowd, 1, 0).velocity), 0.1f);
  EXPECT_GT(glm::length(bodyIn(crowd, 1, 2).velocity), 0.3f);
}

TEST_F(PublicCrowd, RefusesToBeSteeredWhereNobodyIs) {
  Crowd crowd(device(), flatGround(), twoKinds());
  const uint64_t before = crowd.stateHash();
  const AgentGoal goal{AgentId(), {}};
  const AgentSpeed speed{AgentId(1, 9), 1};
  const AgentPlace place{AgentId(0, 5), {}};
  const float nan = std::numeric_limits<float>::quiet_NaN();
  expectRefused("herd 7: expected one of the crowd's 2", [&] { crowd.steer(7, Goal{}); });
  expectRefused("herd 7", [&] { crowd.steer(7, std::vector<Goal>(1)); });
  expectRefused("herd 0: found 3 goals, expected 6", [&] { crowd.steer(0, std::vector<Goal>(3)); });
  expectRefused("herd 1023", [&] { crowd.steer({&goal, 1}); });
  expectRefused("goal.speed is nan", [&] { crowd.steer(0, Goal{.speed = nan}); });
  expectRefused("the length of goal.velocity is 2000", [&] { crowd.steer(0, goingBy(2000, 0)); });
  expectRefused("herd 7", [&] { crowd.setSpeed(7, 1); });
  expectRefused("herd 0: found 1 speeds, expected 6", [&] { crowd.setSpeed(0, std::vector<float>(1)); });
  expectRefused("herd 1, agent 9 of generation 0: nobody", [&] { crowd.setSpeed({&speed, 1}); });
  expectRefused("the speed is -1 m/s, expected 0 to 1000", [&] { crowd.setSpeed(0, -1); });
  expectRefused("herd 0, agent 5", [&] { crowd.teleport({&place, 1}); });
  expectRefused("x is 99 m", [&] { crowd.teleport(crowd.agentId(0, 0), {.position = {99, 0}}); });
  expectRefused("the heading is nan", [&] { crowd.teleport(crowd.agentId(0, 0), {.heading = nan}); });
  expectRefused("herd 7", [&] { crowd.agentId(7, 0); });
  expectRefused("herd 0, agent 5", [&] { crowd.agentId(0, 5); });
  expectRefused("herd 7", [&] { crowd.goalBuffers(7); });
  walk(device(), crowd, 1);
  Crowd same(device(), flatGround(), twoKinds());
  EXPECT_EQ(same.stateHash(), before);
  walk(device(), same, 1);
  EXPECT_EQ(crowd.stateHash(), same.stateHash());
}

TEST_F(PublicCrowd, PutsAgentsElsewhere) {
  Crowd crowd(device(), flatGround(), twoKinds());
  const AgentPlace place{crowd.agentId(0, 1), {.position = {5, -6}, .heading = 1}};
  crowd.teleport({&place, 1});
  crowd.teleport(crowd.agentId(1, 0), {.position = {-7, 8}});
  walk(device(), crowd, 1);
  // They stand; what a tick moves them is far below a millimetre.
  EXPECT_NEAR(bodyIn(crowd, 0, 1).position.x, 5, 1e-3);
  EXPECT_NEAR(bodyIn(crowd, 0, 1).position.z, -6, 1e-3);
  EXPECT_NEAR(bodyIn(crowd, 0, 1).heading.x, std::sin(1), 1e-3);
  EXPECT_NEAR(bodyIn(crowd, 1, 0).position.x, -7, 1e-3);
  EXPECT_NEAR(bodyIn(crowd, 1, 0).position.z, 8, 1e-3);
}

TEST_F(PublicCrowd, AgentsComeAndGo) {
  Crowd crowd(device(), flatGround(), twoKinds());
  const AgentId gone = crowd.agentId(0, 2);
  crowd.remove(gone);
  EXPECT_FALSE(crowd.has(gone));
  const AgentId came = crowd.add(0, {.position = {1, 2}});
  EXPECT_EQ(came.agent(), 2u);
  EXPECT_TRUE(crowd.has(came));
  EXPECT_EQ(crowd.add(0, {}, goingBy(1, 0)).agent(), 4u);
  EXPECT_EQ(crowd.agentCount(0), 5u);
  crowd.add(0, {.position = {4, 4}});
  walk(device(), crowd, 1);
  EXPECT_TRUE(bodyIn(crowd, 0, 5).present);
  expectRefused("herd 0: all of its 6 places are taken", [&] { crowd.add(0, {}); });
  expectRefused("nobody", [&] { crowd.remove(gone); });
  expectRefused("herd 1: its reserve is 0", [&] { crowd.remove(crowd.agentId(1, 0)); });
  expectRefused("herd 1: its reserve is 0", [&] { crowd.add(1, {}, {}); });
  expectRefused("herd 7", [&] { crowd.add(7, {}); });
  expectRefused("x is 99 m", [&] { crowd.add(0, {.position = {99, 0}}); });
}

TEST_F(PublicCrowd, HerdsComeAndGo) {
  Crowd crowd(device(), flatGround(), twoKinds());
  const HerdId loop = crowd.herdId(1);
  crowd.removeHerd(loop);
  EXPECT_FALSE(crowd.has(loop));
  EXPECT_EQ(crowd.places(1), 0u);
  Herd herd = standingScene(2).herds[0];
  herd.controller = Controller::clip;
  const HerdId came = crowd.addHerd(herd);
  EXPECT_EQ(came.index, 1u);
  EXPECT_NE(came, loop);
  EXPECT_TRUE(crowd.has(came));
  EXPECT_EQ(crowd.herdId(1), came);
  walk(device(), crowd, 1);
  EXPECT_EQ(crowd.agentCount(), 6u);
  expectRefused("herd 1 of generation 0", [&] { crowd.removeHerd(loop); });
  expectRefused("herd 7", [&] { crowd.herdId(7); });
  herd.rig = "nowhere.glb";
  expectRefused("nowhere.glb", [&] { crowd.addHerd(herd); });
  crowd.removeHerd(came);
  expectRefused("herd 1: was removed", [&] { crowd.herdId(1); });
}

TEST_F(PublicCrowd, PicksAgents) {
  Crowd crowd(device(), flatGround(), twoKinds());
  walk(device(), crowd, 1);
  const glm::dvec3 origin(3, 0, 1), above = bodyIn(crowd, 0, 3).position + glm::dvec3(0, 9, 0) - origin;
  const std::optional<Picked> picked = crowd.pick({.start = above, .direction = {0, -3, 0}}, origin);
  ASSERT_TRUE(picked);
  EXPECT_EQ(picked->agent, 3u);
  EXPECT_LT(picked->distance, 9);
  EXPECT_FALSE(crowd.pick({.start = above, .direction = {0, -3, 0}, .length = 1}, origin));
  EXPECT_EQ(crowd.nearest(above, origin).value().agent, 3u);
  expectRefused("the ray's direction is (0, 0, 0)", [&] { crowd.pick({.direction = glm::dvec3(0)}); });
  expectRefused("the ray's direction is (nan, 0, 0)", [&] { crowd.pick({.direction = {NAN, 0, 0}}); });
}

TEST_F(PublicCrowd, HandsOutItsBuffers) {
  Crowd crowd(device(), flatGround(), twoKinds(), {.footfalls = 100});
  const std::vector<RecordBuffer> bodies = crowd.buffers(0, Record::body);
  ASSERT_EQ(bodies.size(), 1u);
  EXPECT_EQ(bodies[0].agents, 6u);
  EXPECT_EQ(bodies[0].stride, 4u);
  EXPECT_EQ(bodies[0].bytes, 6u * 64);
  const OwnBuffer copy(device(), bodies[0].bytes);
  device().run([&](VkCommandBuffer commands) {
    crowd.record(commands, tickSeconds);
    copy.copyFrom(commands, bodies[0].buffer, bodies[0].offset);
  });
  EXPECT_EQ(std::vector(copy.floats(), copy.floats() + 6 * 16), crowd.download(0).body);
  ASSERT_EQ(crowd.goalBuffers(1).size(), 1u);
  EXPECT_EQ(crowd.goalBuffers(1)[0].agents, 3u);
  ASSERT_EQ(crowd.footfallBuffers(0).size(), 1u);
  EXPECT_GT(crowd.footfallBuffers(0)[0].room, 0u);
  EXPECT_TRUE(crowd.buffers(0, Record::watch).empty());
  expectRefused("herd 7", [&] { crowd.buffers(7, Record::body); });
  expectRefused("herd 7", [&] { crowd.footfallBuffers(7); });
}

TEST_F(PublicCrowd, DownloadsASample) {
  const Crowd crowd(device(), flatGround(), standingScene(10));
  const std::vector<float> all = crowd.download(0).body;
  const HerdState some = crowd.download(0, {.first = 1, .stride = 4});
  ASSERT_EQ(some.agents, 3u);  // 1, 5 and 9
  EXPECT_TRUE(std::equal(some.body.begin() + 16, some.body.begin() + 32, all.begin() + 5 * 16));
  EXPECT_EQ(crowd.download(0, {.first = 9, .stride = UINT32_MAX}).agents, 1u);
  EXPECT_EQ(crowd.download(0, {.first = 10, .stride = 1}).agents, 0u);
  expectRefused("stride 0", [&] { crowd.download(0, {.stride = 0}); });
}

TEST_F(PublicCrowd, TellsHowWellItWalks) {
  Scene scene = standingScene(4);
  scene.herds[0].goal = goingBy(0, 1);
  Crowd crowd(device(), flatGround(), scene, {.footfalls = 100});
  size_t landed = 0;
  for (int i = 0; i < 120; ++i) {
    walk(device(), crowd, 1);
    for (const Footfall& each : crowd.footfalls(0)) {
      EXPECT_LT(each.agent, 4u);
      EXPECT_EQ(each.tick, crowd.tick());
      ++landed;
    }
  }
  EXPECT_GT(landed, 8u);
  EXPECT_EQ(crowd.droppedFootfalls(0), 0u);
  EXPECT_GT(crowd.fidelity().agentTicks, 0u);
  EXPECT_LE(crowd.fidelity().agentTicks, 4u * 120);
  EXPECT_EQ(crowd.fidelity(0).agentTicks, crowd.fidelity().agentTicks);
  EXPECT_EQ(crowd.agentFidelity(0).size(), 4u);
  EXPECT_LT(crowd.fidelity().penetration, 0.01);
  EXPECT_EQ(crowd.sleeping(), 0u);
}

TEST_F(PublicCrowd, RefusesHerdsThatAreNotThere) {
  const Crowd crowd(device(), flatGround(), twoKinds());
  const std::string text = "herd 7: expected one of the crowd's 2 herds";
  expectRefused(text, [&] { crowd.memoryUse(7); });
  expectRefused(text, [&] { crowd.download(7); });
  expectRefused(text, [&] { crowd.fidelity(7); });
  expectRefused(text, [&] { crowd.agentFidelity(7); });
  expectRefused(text, [&] { crowd.footfalls(7); });
  expectRefused(text, [&] { crowd.droppedFootfalls(7); });
  expectRefused(text, [&] { crowd.cannotReach(7); });
  expectRefused(text, [&] { crowd.places(7); });
  expectRefused(text, [&] { crowd.agentCount(7); });
  expectRefused(text, [&] { crowd.rig(7); });
  expectRefused(text, [&] { crowd.rig(7, 0); });
  expectRefused("herd 0, agent 6: expected one of its 6 places", [&] { crowd.rig(0, 6); });
  expectRefused("herd 0, agent 6: expected one of its 6 places", [&] { crowd.size(0, 6); });
  EXPECT_FALSE(crowd.has(AgentId()));
  EXPECT_FALSE(crowd.has(HerdId{7, 0}));
}

TEST_F(PublicCrowd, FallsAsleep) {
  Crowd crowd(device(), flatGround(), standingScene(4), {.sleep = true});
  // Within 20 s.
  for (int i = 0; i < 20 && crowd.sleeping() < 4; ++i) walk(device(), crowd, 60);
  EXPECT_EQ(crowd.sleeping(), 4u);
  crowd.steer(0, goingBy(0, 1));
  walk(device(), crowd, 1);
  EXPECT_EQ(crowd.sleeping(), 0u);
}

TEST_F(PublicCrowd, TimesItsStages) {
  Crowd crowd(device(), flatGround(), standingScene(4), {.timestamps = true});
  walk(device(), crowd, 1);
  if (device().report().limits.timestampBits > 0) {
    EXPECT_FALSE(crowd.stageTimes().empty());
  }
  crowd.timeStages(false);
  walk(device(), crowd, 1);
  EXPECT_TRUE(crowd.stageTimes().empty());
}

TEST_F(PublicCrowd, TakesEditsOfTheGround) {
  Crowd crowd(device(), flatGround(), standingScene(4));
  crowd.editHeights(0, 0, 2, 1, std::vector<float>{1, 2});
  EXPECT_EQ(crowd.terrain().heights[1], 2);
  expectRefused("leaves the 65 x 65", [&] { crowd.editHeights(64, 0, 2, 1, std::vector<float>(2)); });
  expectRefused("has 1 samples", [&] { crowd.editHeights(0, 0, 2, 1, std::vector<float>(1)); });
  expectRefused("not finite", [&] { crowd.editHeights(0, 0, 1, 1, std::vector<float>{NAN}); });
  EXPECT_NO_THROW(walk(device(), crowd, 1));
}

// Agents south of a wall across the whole ground, whose goal is north of it.
Scene walledOff() {
  Scene scene = standingScene(4);
  scene.obstacles = {{Capsule{.from = {-40, 6}, .to = {40, 6}, .radius = 0.3f}}};
  scene.herds[0].ways = Ways{};
  scene.herds[0].goal = {.kind = Goal::Kind::point, .target = {0, 10}};
  return scene;
}

TEST_F(PublicCrowd, CountsWhoCannotReachTheirGoals) {
  Crowd crowd(device(), flatGround(), walledOff());
  EXPECT_EQ(crowd.cannotReach(0), 4u);
  const AgentGoal near{crowd.agentId(0, 0), {.kind = Goal::Kind::point, .target = {0, -8}}};
  crowd.steer({&near, 1});
  walk(device(), crowd, 1);
  EXPECT_EQ(crowd.cannotReach(0), 3u);
  crowd.steer(0, goingBy(0, 1));
  walk(device(), crowd, 1);
  EXPECT_EQ(crowd.cannotReach(0), 0u);
  EXPECT_EQ(Crowd(device(), flatGround(), twoKinds()).cannotReach(0), 0u);
}

TEST_F(PublicCrowd, RefusesMoreGoalsThanWaysLeadTo) {
  Scene scene = standingScene(17);
  scene.herds[0].ways = Ways{};
  Crowd crowd(device(), flatGround(), scene);
  std::vector<Goal> goals;
  for (int i = 0; i < 17; ++i)
    goals.push_back({.kind = Goal::Kind::point, .target = {static_cast<float>(i) - 8, 10}});
  const uint64_t before = crowd.stateHash();
  expectRefused("are more than 16 places that ways lead to", [&] { crowd.steer(0, goals); });
  EXPECT_EQ(crowd.stateHash(), before);
  goals[16] = goals[0];
  crowd.steer(0, goals);
  walk(device(), crowd, 1);
  EXPECT_EQ(crowd.cannotReach(0), 0u);
}

// The farthest of the agents of herd 0 from a place.
double farthestFrom(const Crowd& crowd, const glm::dvec2& place, uint32_t agents) {
  double farthest = 0;
  for (uint32_t i = 0; i < agents; ++i) {
    const glm::dvec3 at = bodyIn(crowd, 0, i).position;
    farthest = std::max(farthest, std::hypot(at.x - place.x, at.z - place.y));
  }
  return farthest;
}

TEST_F(PublicCrowd, GoesFromPlaceToPlace) {
  Scene scene = walledOff();
  scene.herds.push_back(standingScene(1).herds[0]);
  scene.herds[1].spawn.centre = {6, -2};
  Crowd crowd(device(), flatGround(), scene);
  walk(device(), crowd, 1);
  crowd.steer(0, Goal{.kind = Goal::Kind::route, .speed = 2, .places = {{0, 4}, {-5, 3}}});
  walk(device(), crowd, 600);
  EXPECT_LT(farthestFrom(crowd, {-5, 3}, 4), 1);
  crowd.steer(0, Goal{.kind = Goal::Kind::roam, .target = {3, -4}, .speed = 2, .radius = 3});
  walk(device(), crowd, 600);
  EXPECT_LT(farthestFrom(crowd, {3, -4}, 4), 3 + 2);
  crowd.steer(0, Goal{.kind = Goal::Kind::follow, .speed = 2, .leader = 1});
  walk(device(), crowd, 900);
  EXPECT_LT(farthestFrom(crowd, {6, -2}, 4), 1.5);
  crowd.steer(0, Goal{.kind = Goal::Kind::flee, .speed = 2});
  crowd.setThreat(0, {.centre = {6, -2}, .radius = 2});
  walk(device(), crowd, 300);
  for (uint32_t i = 0; i < 4; ++i)
    EXPECT_GT(std::hypot(bodyIn(crowd, 0, i).position.x - 6, bodyIn(crowd, 0, i).position.z + 2), 2) << i;
  expectRefused("goal.places are 0, expected 1 to 16",
                [&] { crowd.steer(0, Goal{.kind = Goal::Kind::route}); });
  expectRefused("expected a herd with ways", [&] { crowd.steer(1, Goal{.kind = Goal::Kind::flee}); });
}

TEST_F(PublicCrowd, LeavesThreats) {
  Scene scene = standingScene(1);
  scene.herds[0].ways = Ways{};
  scene.herds[0].goal = {.kind = Goal::Kind::point, .target = {0, 0}, .speed = 2};
  Crowd crowd(device(), flatGround(), scene);
  EXPECT_TRUE(crowd.threats().empty());
  const Threat threat{.centre = {0.5f, 0}, .radius = 2};
  crowd.setThreat(1, threat);
  ASSERT_EQ(crowd.threats().size(), 2u);
  EXPECT_EQ(crowd.threats()[0].radius, 0);
  EXPECT_EQ(crowd.threats()[1], threat);
  walk(device(), crowd, 300);
  const glm::dvec3 place = bodyIn(crowd, 0, 0).position;
  EXPECT_GT(std::hypot(place.x - 0.5, place.z), 2);

  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<Threat> before = crowd.threats();
  expectRefused("threat 64: expected a number less than 64", [&] { crowd.setThreat(64, {}); });
  expectRefused("threat 1.centre[1] is nan", [&] { crowd.setThreat(1, {.centre = {0, nan}}); });
  expectRefused("threat 1.radius is -1, expected a number from 0",
                [&] { crowd.setThreat(1, {.radius = -1}); });
  EXPECT_EQ(crowd.threats(), before);
  crowd.setThreat(1, {.radius = 0});
  EXPECT_TRUE(crowd.threats().empty());
}

TEST_F(PublicCrowd, GivesLoadsAndTakesThem) {
  Scene scene = standingScene(3);
  scene.herds[0].hurt = true;
  scene.herds.push_back(standingScene(1).herds[0]);
  scene.herds[1].hurt = false;
  scene.herds[0].goal = goingBy(0, 1);
  Crowd crowd(device(), flatGround(), scene);
  const AgentId free = crowd.agentId(0, 0), laden = crowd.agentId(0, 1);
  const Load own{.mass = 1, .offset = {0, 0.1f, -0.2f}};
  crowd.carry(laden, own);
  const AgentLoad light{.agent = crowd.agentId(0, 2), .load = {.mass = 0.1f}};
  crowd.carry({&light, 1});
  EXPECT_EQ(crowd.carried(free), Load{});
  EXPECT_EQ(crowd.carried(laden), own);
  EXPECT_EQ(crowd.carried(light.agent), light.load);
  walk(device(), crowd, 60);
  const double freeBegan = bodyIn(crowd, 0, 0).position.z, began = bodyIn(crowd, 0, 1).position.z;
  walk(device(), crowd, 120);
  EXPECT_NEAR(bodyIn(crowd, 0, 1).position.z - began, (bodyIn(crowd, 0, 0).position.z - freeBegan) / 2, 0.1);
  crowd.carry(laden, {});
  EXPECT_EQ(crowd.carried(laden), Load{});
  walk(device(), crowd, 1);

  const uint64_t before = crowd.stateHash();
  expectRefused("herd 1, agent 0: hurt is false", [&] { crowd.carry(crowd.agentId(1, 0), own); });
  expectRefused("load.mass is 5", [&] { crowd.carry(laden, {.mass = 5}); });
  expectRefused("nobody", [&] { crowd.carried(AgentId(0, 9)); });
  EXPECT_EQ(crowd.stateHash(), before);
}

TEST_F(PublicCrowd, HurtsLegsAndHealsThem) {
  Scene scene = standingScene(3);
  scene.herds[0].hurt = true;
  scene.herds.push_back(standingScene(1).herds[0]);
  scene.herds[0].goal = goingBy(0, 1);
  Crowd crowd(device(), flatGround(), scene);
  const AgentId agent = crowd.agentId(0, 1);
  const auto legs = static_cast<uint32_t>(crowd.rig(0).legs.size());
  EXPECT_EQ(crowd.legState(agent, 2), LegState::whole);
  crowd.hurt(agent, 2);
  const AgentLeg lame{.agent = agent, .leg = 5, .state = LegState::lame};
  crowd.hurt({&lame, 1});
  EXPECT_EQ(crowd.legState(agent, 2), LegState::lost);
  EXPECT_EQ(crowd.legState(agent, 5), LegState::lame);
  EXPECT_EQ(crowd.legState(crowd.agentId(0, 0), 2), LegState::whole);
  const double began = bodyIn(crowd, 0, 1).position.z;
  walk(device(), crowd, 120);
  EXPECT_GT(bodyIn(crowd, 0, 1).position.z, began + 1);
  crowd.heal(agent);
  EXPECT_EQ(crowd.legState(agent, 2), LegState::whole);
  walk(device(), crowd, 1);

  const uint64_t before = crowd.stateHash();
  expectRefused("herd 1, agent 0: hurt is false", [&] { crowd.hurt(crowd.agentId(1, 0), 0); });
  expectRefused("expected less than", [&] { crowd.hurt(agent, legs); });
  expectRefused("bone is 99", [&] { crowd.hurt(agent, 0, LegState::lost, 99); });
  expectRefused("nobody", [&] { crowd.heal(AgentId(0, 9)); });
  expectRefused("expected less than", [&] { crowd.legState(agent, legs); });
  EXPECT_EQ(crowd.stateHash(), before);
}

TEST_F(PublicCrowd, WhoIsPushedFallsAndStandsAgain) {
  Scene scene = standingScene(4);
  scene.herds[0].reactions = true;
  Crowd crowd(device(), flatGround(), scene);
  const AgentPush strong{crowd.agentId(0, 1), {12, 0}};
  crowd.push({&strong, 1});
  crowd.push(crowd.agentId(0, 2), {0.2f, 0});
  walk(device(), crowd, 20);
  EXPECT_EQ(crowd.reactions(0)[0].phase, ReactionPhase::steady);
  EXPECT_EQ(crowd.reactions(0)[1].phase, ReactionPhase::falling);
  EXPECT_EQ(crowd.reactions(0)[2].falls, 0u);
  walk(device(), crowd, 280);
  EXPECT_EQ(crowd.reactions(0)[1].stands, 1u);
  EXPECT_GT(crowd.reactions(0)[1].downBefore, 0.5f);
  expectRefused("the length of the push is 200 m/s, expected 0 to 100", [&] {
    crowd.push(crowd.agentId(0, 2), {200, 0});
  });
}

TEST_F(PublicCrowd, WhoIsNotToldWhatItLostTriesGaits) {
  Scene scene = standingScene(2);
  scene.herds[0].hurt = scene.herds[0].adapts = true;
  scene.herds[0].goal = {.kind = Goal::Kind::velocity, .velocity = {0, 1}};
  Crowd crowd(device(), flatGround(), scene);
  crowd.hurt(crowd.agentId(0, 1), 3);
  walk(device(), crowd, 260);
  EXPECT_EQ(crowd.searches(0)[0].phase, SearchPhase::atEase);
  EXPECT_NE(crowd.searches(0)[1].phase, SearchPhase::atEase);
  EXPECT_EQ(crowd.searches(0)[1].trials, 1u);
  EXPECT_GT(crowd.searches(0)[1].best, 0.5f);
}

// Two of four in one place, the others far from anybody.
TEST_F(PublicCrowd, MeasuresHowFarAgentsOverlap) {
  Crowd crowd(device(), flatGround(), standingScene(4), {.crowding = true});
  for (uint32_t i = 0; i < 4; ++i)
    crowd.teleport(crowd.agentId(0, i), {.position = {i < 2 ? 0.0f : 5.0f * static_cast<float>(i - 1), 0}});
  walk(device(), crowd, 10);
  const Crowding crowding = crowd.crowding();
  EXPECT_FALSE(crowding.droppedNeighbours);
  // Places are whole quanta, of a millimetre.
  EXPECT_NEAR(crowding.overlapMost.value(), 1, 4e-3);
  EXPECT_NEAR(crowding.overlapMean.value(), 1.0 / 4, 4e-3);
  EXPECT_NEAR(crowding.pairs.value(), 1.0 / 4, 1e-12);
  EXPECT_FALSE(Crowd(device(), flatGround(), standingScene(4)).crowding().pairs);
}

TEST_F(PublicCrowd, CountsNeighboursThatAgentsCannotKeepClearOf) {
  Scene scene = standingScene(12);
  scene.herds[0].avoid = true;
  Crowd crowd(device(), flatGround(), scene);
  EXPECT_EQ(crowd.crowding().droppedNeighbours, 0u);
  EXPECT_FALSE(crowd.crowding().overlapMost);
  for (uint32_t i = 0; i < 12; ++i) crowd.teleport(crowd.agentId(0, i), {.position = {2, 2}});
  // Everybody looks around once in four ticks. Each has 11 in reach, and keeps clear of 8.
  walk(device(), crowd, 4);
  EXPECT_EQ(crowd.crowding().droppedNeighbours, 12u * 3);
}

TEST_F(PublicCrowd, SavesItself) {
  const OwnFolder folder;
  Crowd crowd(device(), flatGround(), standingScene(4));
  crowd.save(folder / "own.state");
  EXPECT_EQ(std::filesystem::file_size(folder / "own.state"), crowd.saveToMemory().size());
  EXPECT_EQ(Crowd(device(), loadState(folder / "own.state")).stateHash(), crowd.stateHash());
  expectRefused("not JSON", [&] { crowd.saveToMemory("no JSON"); });
  expectRefused("nowhere", [&] { crowd.save(folder / "nowhere" / "own.state"); });
}

TEST_F(PublicCrowd, KeepsItsTick) {
  Crowd crowd(device(), flatGround(), standingScene(1));
  const auto record = [&](float dt) {
    device().run([&](VkCommandBuffer commands) { crowd.record(commands, dt); });
  };
  record(tickSeconds);
  device().run([&](VkCommandBuffer commands) {
    expectRefused("dt changed from", [&] { crowd.record(commands, 1.0f / 30); });
    expectRefused("expected a finite time above 0", [&] { crowd.record(commands, 0); });
    expectRefused("dt nan", [&] { crowd.record(commands, NAN); });
  });
  EXPECT_EQ(crowd.tick(), 1u);
}

TEST_F(PublicCrowd, ForagesWhereAHerdDoes) {
  Scene scene = standingScene(6);
  scene.herds[0].goal = {.speed = 2};
  scene.herds[0].forage = Forage{.nest = {.centre = {0, 0}, .radius = 3},
                                 .food = {{.centre = {0, 8}, .radius = 3, .amount = 50}},
                                 .cell = 1,
                                 .rest = 0};
  scene.herds.push_back(standingScene(2).herds[0]);
  Crowd crowd(device(), flatGround(), scene);
  EXPECT_EQ(crowd.foraging(0).taken, std::vector<uint64_t>{0});
  const PheromoneGrid before = crowd.pheromone(0);
  EXPECT_EQ(before.units.size(), size_t{before.columns} * before.rows);
  EXPECT_EQ(before.cell, 1);
  EXPECT_EQ(std::ranges::max(before.units), 0);
  for (int second = 0; second < 60 && crowd.foraging(0).brought == 0; ++second) walk(device(), crowd, 60);
  EXPECT_GT(crowd.foraging(0).brought, 0u);
  EXPECT_GE(crowd.foraging(0).taken.at(0), crowd.foraging(0).brought);
  EXPECT_GT(std::ranges::max(crowd.pheromone(0).units), 0);
  EXPECT_TRUE(crowd.foraging(1).taken.empty());
  EXPECT_TRUE(crowd.pheromone(1).units.empty());
  expectRefused("herd 7", [&] { crowd.foraging(7); });
  expectRefused("herd 7", [&] { crowd.pheromone(7); });
}

TEST_F(PublicCrowd, RefusesScenesThatCannotBe) {
  const auto refuse = [&](const std::string& text, const auto& change) {
    Scene scene = standingScene(4);
    change(scene);
    expectRefused(text, [&] { Crowd(device(), flatGround(), scene); });
  };
  refuse("nowhere.glb", [](Scene& scene) { scene.herds[0].rig = "nowhere.glb"; });
  refuse("standing: herds[0].tuning.stepHeight", [](Scene& scene) { scene.herds[0].tuning.stepHeight = -1; });
  refuse("standing: herds[0]: spawn.spacing is 0 m", [](Scene& scene) { scene.herds[0].spawn.spacing = 0; });
  refuse("goal.speed is 2000", [](Scene& scene) { scene.herds[0].goal = {.speed = 2000}; });
  refuse("a herd's solver is two-bone", [](Scene& scene) { scene.herds[0].solver = Solver::twoBone; });
  refuse("herds[0].sizes[0] is 30", [](Scene& scene) { scene.herds[0].sizes = {30}; });
  refuse("standing: herds[0]: ways.steepest is 0",
         [](Scene& scene) { scene.herds[0].ways = Ways{.steepest = 0}; });
  refuse("standing: obstacles[0].disc.radius is 0",
         [](Scene& scene) { scene.obstacles = {{Disc{.radius = 0}}}; });
  refuse("standing: threats[1].radius is -1", [](Scene& scene) { scene.threats = {{}, {.radius = -1}}; });
  refuse("65 threats, expected at most 64", [](Scene& scene) { scene.threats.resize(65); });
  refuse("standing: events[0]", [](Scene& scene) { scene.events = {{.at = 0, .what = HerdRemoval{7}}}; });
}

TEST_F(PublicCrowd, WhoIsFarFromTheCameraTicksLess) {
  Scene scene = standingScene(8);
  EXPECT_TRUE(Crowd(device(), flatGround(), scene).levels().empty());
  Crowd crowd(device(), flatGround(), scene, {.levels = Levels{.distances = {1, 20, 60}}});
  crowd.lookFrom(glm::vec3(30, 0, 0));
  walk(device(), crowd, 40);
  const std::vector<LevelFigures> levels = crowd.levels();
  ASSERT_EQ(levels.size(), Levels::count);
  EXPECT_EQ(levels[0].rate, 1u);
  EXPECT_EQ(levels[2].rate, 4u);
  EXPECT_EQ(levels[2].agents, 8u);
  EXPECT_GT(levels[2].agentTicks, 0u);
  expectRefused("sleep", [&] { Crowd(device(), flatGround(), scene, {.sleep = true, .levels = Levels{}}); });
}

TEST_F(PublicCrowd, RefusesGroundAndRigsThatCannotBe) {
  const auto refuseGround = [&](const std::string& text, const auto& change) {
    Heightfield ground = flatGround();
    change(ground);
    expectRefused(text, [&] { Crowd(device(), ground, standingScene(1)); });
  };
  refuseGround("65 x 65 samples with 4224 heights", [](Heightfield& ground) { ground.heights.pop_back(); });
  refuseGround("height 7 is inf", [](Heightfield& ground) { ground.heights[7] = INFINITY; });
  refuseGround("a spacing of -1 m", [](Heightfield& ground) { ground.spacingX = -1; });
  refuseGround("expected at most 8192 m a side", [](Heightfield& ground) { ground.spacingX = 1000; });
  const auto refuseRig = [&](const std::string& text, const auto& change) {
    Rig rig = spiderRig();
    change(rig);
    expectRefused(text, [&] { Crowd(device(), flatGround(), standingScene(1), {.rigs = {rig}}); });
  };
  refuseRig("0 legs, expected 1 to 24", [](Rig& rig) { rig.legs.clear(); });
  refuseRig("has 0 bones, expected 1 to 15", [](Rig& rig) { rig.legs[3].bones.clear(); });
  refuseRig("a leg length of 0 m", [](Rig& rig) { rig.legLength = 0; });
  refuseRig("is of group 9", [](Rig& rig) { rig.legs[0].group = 9; });
  expectRefused("2 rigs were given, expected one for each of 1 herds", [&] {
    Crowd(device(), flatGround(), standingScene(1), {.rigs = {spiderRig(), spiderRig()}});
  });
}

}  // namespace
}  // namespace skitter::test
