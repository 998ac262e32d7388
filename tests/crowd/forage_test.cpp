// Herds that forage (docs/foraging.md).
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include "assets/files.h"
#include "crowd/simulation.h"
#include "crowd/ways/trails.h"
#include "skitter/error.h"
#include "skitter/state.h"
#include "support/rounding.h"
#include "validation/herd_facts.h"
#include "validation/lockstep/lockstep.h"

namespace skitter::test {
namespace {

using ForageTest = GpuTest;
using ForageReplayTest = GpuTest;

// A nest, food 7 m from it, a wall beside the way, and a branch on either side of its middle.
Scene foragingScene(uint32_t agents, Controller controller = Controller::adaptive) {
  Scene scene = sceneOf(agents, 3, 1, controller);
  scene.obstacles = {{Capsule{.from = {-4, -2}, .to = {-4, 3}, .radius = 0.3f}}};
  scene.herds[0].spawn = {.kind = Spawn::Kind::grid, .spacing = 0.7f, .centre = {0, -4}};
  scene.herds[0].forage =
      Forage{.nest = {.centre = {0, -4}, .radius = 1.5f},
             .food = {{.centre = {0, 3}, .radius = 3, .amount = 1000}},
             .branches = {{.centre = {-2, 0}, .radius = 2}, {.centre = {2, 0}, .radius = 2}},
             .cell = 1,
             .life = 20,
             .patience = 30,
             .rest = 0.5f};
  return scene;
}

double unitsOf(const Crowd& crowd) {
  const std::vector<float> units = crowd.pheromone(0).units;
  return std::accumulate(units.begin(), units.end(), 0.0);
}

uint64_t taken(const Crowd& crowd) { return crowd.foraging(0).taken.at(0); }

TEST_F(ForageReplayTest, FewAndMany) {
  const Heightfield ground = smallRollingGround();
  for (const uint32_t agents : {1u, 2u, 45u}) {
    Crowd crowd(device(), ground, foragingScene(agents), {.pageAgents = 7});
    expectAllPass(replayAll(device(), crowd, ground, agents > 2 ? 500 : 120).front());
    if (agents > 2) {
      EXPECT_GT(crowd.foraging(0).brought, 0u);
    }
  }
}

TEST_F(ForageTest, EveryControllerForages) {
  for (const Controller controller : allControllers) {
    Crowd crowd(device(), smallRollingGround(), foragingScene(20, controller));
    expectAllPass(replayAll(device(), crowd, smallRollingGround(), 120).front());
  }
}

TEST_F(ForageTest, ForagersMayAvoidEachOther) {
  Scene scene = foragingScene(24);
  scene.herds[0].avoid = true;
  Crowd crowd(device(), smallRollingGround(), scene);
  expectAllPass(replayAll(device(), crowd, smallRollingGround(), 240).front());
}

TEST_F(ForageTest, FoodIsCarriedHome) {
  Crowd crowd(device(), flatGround(), foragingScene(60));
  simulate(device(), crowd, 2400);
  const Foraging done = crowd.foraging(0);
  EXPECT_GT(done.brought, 20u);
  EXPECT_GE(done.taken.at(0), done.brought);
  EXPECT_LE(done.taken.at(0), done.brought + 60);
  EXPECT_GT(unitsOf(crowd), 0);
  EXPECT_EQ(done.passed.size(), 2u);
  EXPECT_GT(done.passed[0] + done.passed[1], done.brought);
}

// Nobody takes more than there is but who comes in the tick in which the last load goes.
TEST_F(ForageTest, TheTrailFadesWhenTheFoodIsGone) {
  Scene scene = foragingScene(60);
  scene.herds[0].forage->food[0].amount = 40;
  scene.herds[0].forage->life = 2;
  Crowd crowd(device(), flatGround(), scene);
  double most = 0;
  for (int second = 0; second < 120 && taken(crowd) < 40; ++second) {
    simulate(device(), crowd, 60);
    most = std::max(most, unitsOf(crowd));
  }
  EXPECT_GT(most, 0);
  ASSERT_GE(taken(crowd), 40u);
  EXPECT_LE(taken(crowd), 44u);
  // Homewards and lives.
  simulate(device(), crowd, 60 * 60);
  EXPECT_GE(crowd.foraging(0).brought + 3, taken(crowd));
  EXPECT_LT(unitsOf(crowd), 0.01 * most);
}

TEST_F(ForageTest, WhatIsBesideDoesNotShow) {
  const auto hashWith = [&](const CrowdOptions& options) {
    Crowd crowd(device(), smallRollingGround(), foragingScene(61), options);
    simulate(device(), crowd, 300);
    return crowd.stateHash();
  };
  const uint64_t hash = hashWith({});
  EXPECT_EQ(hash, hashWith({}));
  EXPECT_EQ(hash, hashWith({.pageAgents = 7}));
  if (kernelsRoundAlike(device())) {
    EXPECT_EQ(hash, hashWith({.fuse = false}));
  }
  EXPECT_EQ(hash, hashWith({.pose = false, .measure = false, .timestamps = true}));
}

TEST_F(ForageTest, EveryNumberOfAgentsHasTheSameHashTwice) {
  for (const uint32_t agents : {0u, 1u, 37u}) {
    uint64_t hashes[2];
    for (uint64_t& hash : hashes) {
      Crowd crowd(device(), flatGround(), foragingScene(agents));
      simulate(device(), crowd, 90);
      hash = crowd.stateHash();
    }
    EXPECT_EQ(hashes[0], hashes[1]) << agents;
  }
}

TEST_F(ForageTest, AStateGoesOnAsTheCrowdDoes) {
  Crowd crowd(device(), smallRollingGround(), foragingScene(40));
  simulate(device(), crowd, 250);
  ASSERT_GT(taken(crowd), 0u);
  State state = parseState(crowd.saveToMemory(), "a state");
  state.options.pageAgents = 9;
  Crowd again(device(), state);
  EXPECT_EQ(again.pheromone(0).units, crowd.pheromone(0).units);
  EXPECT_EQ(again.foraging(0).taken, crowd.foraging(0).taken);
  for (Crowd* each : {&crowd, &again}) simulate(device(), *each, 150);
  EXPECT_EQ(crowd.stateHash(), again.stateHash());
}

// New ground on the way, agents who come, go and are put elsewhere, in lock step.
TEST_F(ForageTest, TheReferenceFollowsEditsAndComers) {
  Scene scene = foragingScene(20);
  scene.herds[0].reserve = 4;
  Crowd crowd(device(), flatGround(), scene);
  validation::Lockstep lockstep(crowd, scene, kTick, {crowd::StageId::navigate});
  const std::vector<uint32_t> before = implOf(crowd).kindOf(0).trails->groundWords();
  for (int tick = 0; tick < 200; ++tick) {
    if (tick == 60) crowd.teleport(crowd.agentId(0, 3), {{9, 9}, 1});
    if (tick == 70) crowd.remove(crowd.agentId(0, 5));
    if (tick == 80) crowd.add(0, {{2, 5}, 0});
    lockstep.begin();
    if (tick == 100) lockstep.edit(60, 60, 8, 2, std::vector<float>(16, 5.0f));
    simulate(device(), crowd, 1);
    lockstep.end();
  }
  expectAllPass(lockstep.results());
  EXPECT_NE(before, implOf(crowd).kindOf(0).trails->groundWords());
}

TEST_F(ForageTest, WorldsThatHaveNoWay) {
  Scene walled = foragingScene(12), buried = walled, nowhere = walled;
  walled.obstacles = {{Disc{.centre = {0, 3}, .radius = 4}}};   // around the food
  buried.obstacles = {{Disc{.centre = {0, -4}, .radius = 3}}};  // around the nest, and everybody
  nowhere.obstacles = {{Disc{.centre = {0, 0}, .radius = 100}}};
  for (const Scene& scene : {walled, buried, nowhere}) {
    Crowd crowd(device(), flatGround(), scene);
    expectAllPass(replayAll(device(), crowd, flatGround(), 150).front());
    EXPECT_EQ(crowd.foraging(0).brought, 0u);
  }
}

TEST_F(ForageTest, WhoDoesNotForagePaysNothing) {
  Scene scene = foragingScene(20);
  scene.herds.push_back(scene.herds[0]);
  scene.herds[0].forage = {};
  const Crowd crowd(device(), flatGround(), scene);
  const crowd::Kind& plain = implOf(crowd).kindOf(0);
  EXPECT_EQ(plain.trails, nullptr);
  for (const crowd::Page& page : plain.pages) EXPECT_FALSE(page.forager);
  EXPECT_TRUE(crowd.pheromone(0).units.empty());
  EXPECT_FALSE(crowd.pheromone(1).units.empty());
  EXPECT_TRUE(crowd.download(0).trail.empty());
}

// Herds that are equal but for their agents are one colony.
TEST_F(ForageTest, EqualHerdsShareATrail) {
  Scene scene = foragingScene(15);
  scene.herds.push_back(scene.herds[0]);
  Crowd crowd(device(), flatGround(), scene);
  simulate(device(), crowd, 600);
  EXPECT_GT(taken(crowd), 0u);
  EXPECT_EQ(crowd.foraging(0).taken, crowd.foraging(1).taken);
  for (const auto& results : replayAll(device(), crowd, flatGround(), 60)) expectAllPass(results);
}

TEST_F(ForageTest, WhatIsOutOfRangeIsRefused) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto faultOf = [&](const std::function<void(Forage&)>& change) {
    Scene scene = foragingScene(2);
    change(*scene.herds[0].forage);
    return inputFault([&] { Crowd(device(), flatGround(), scene); });
  };
  const auto expectFault = [](const std::string& fault, const char* part) {
    EXPECT_NE(fault.find(part), std::string::npos) << fault;
  };
  expectFault(faultOf([&](Forage& forage) { forage.nest.centre.x = nan; }), "forage.nest.centre[0]");
  expectFault(faultOf([&](Forage& forage) { forage.life = 0; }), "forage.life is 0");
  expectFault(faultOf([&](Forage& forage) { forage.power = 9; }), "forage.power is 9");
  expectFault(faultOf([&](Forage& forage) { forage.food.resize(17); }), "17 sources");
  Scene scene = foragingScene(2);
  scene.herds[0].sizes = {1, 2};
  expectFault(inputFault([&] { Crowd(device(), flatGround(), scene); }), "2 sizes");
}

}  // namespace
}  // namespace skitter::test
