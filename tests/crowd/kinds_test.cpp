// Equal herds share pipelines and dispatches, and nobody moves or is counted otherwise for it.
#include "crowd/kinds.h"

#include <gmock/gmock.h>

#include <limits>

#include "crowd/page.h"
#include "crowd/record.h"
#include "crowd/simulation.h"
#include "gpu/transfer.h"
#include "skitter/error.h"

namespace skitter::test {
namespace {

using KindsTest = GpuTest;

// Herds of one kind, but for the last: nobody in some, page and block ends within others.
Scene severalHerds(Controller controller = Controller::adaptive) {
  Scene scene = sceneOf(0, 1, 1, controller);
  const Herd any = scene.herds[0];
  scene.herds.clear();
  for (const uint32_t agents : {0u, 5u, 129u, 0u, 9u, 21u}) {
    Herd& herd = scene.herds.emplace_back(any);
    herd.agents = agents;
    herd.goal.speed = 0.4f + 0.3f * static_cast<float>(scene.herds.size());
    herd.spawn.heading = static_cast<float>(scene.herds.size());
  }
  scene.herds[1].goal.kind = Goal::Kind::none;
  scene.herds[4].goal = {.kind = Goal::Kind::point, .target = {3, 4}};
  scene.herds[5].controller = controller == Controller::loop ? Controller::adaptive : Controller::loop;
  return scene;
}

// Rigs that differ in their names alone, so that every herd is of a kind of its own.
std::vector<Rig> ownRigs(const Scene& scene) {
  std::vector<Rig> rigs;
  for (size_t h = 0; h < scene.herds.size(); ++h) rigs.emplace_back(spiderRig()).name += std::to_string(h);
  return rigs;
}

std::vector<std::vector<float>> recordsOf(const HerdState& s) {
  std::vector<std::vector<float>> records;
  for (const Record record : allRecords)
    if (crowd::infoOf(record).per != crowd::Per::watched) records.push_back(s.of(record));
  return records;
}

std::vector<std::tuple<uint32_t, uint32_t, uint64_t, float, float, float, float>> eventsOf(
    const HerdState& s) {
  std::vector<std::tuple<uint32_t, uint32_t, uint64_t, float, float, float, float>> events;
  for (const Footfall& f : s.footfalls)
    events.emplace_back(f.agent, f.leg, f.tick, f.place.x, f.place.y, f.place.z, f.speed);
  return events;
}

auto figuresOf(const Fidelity& f) {
  return std::tuple(f.agentTicks, f.stances, f.slip, f.skating, f.penetration, f.floating, f.crossing,
                    f.reachErrorP99, f.reachErrorMost, f.limitViolation, f.footJerk, f.bodyJerk, f.margin,
                    f.unstable, f.lastResorts, f.notFinite);
}

// Steep enough that some landings are last resorts.
Heightfield steepGround() {
  return generateHeightfield({.columns = 129, .rows = 129, .amplitude = 16, .wavelength = 12});
}

class SharedPagesTest : public GpuTest, public ::testing::WithParamInterface<Controller> {};

TEST_P(SharedPagesTest, DoNotShow) {
  const Heightfield ground = steepGround();
  const Scene scene = severalHerds(GetParam());
  for (const CrowdOptions& options :
       {CrowdOptions{.watchEvery = 1, .feet = true, .footfalls = UINT32_MAX},
        CrowdOptions{
            .watchEvery = 1, .feet = true, .footfalls = UINT32_MAX, .sleep = true, .pageAgents = 24}}) {
    SCOPED_TRACE(options.pageAgents);
    CrowdOptions own = options;
    own.rigs = ownRigs(scene);
    Crowd together(device(), ground, scene, options), apart(device(), ground, scene, own);
    ASSERT_EQ(implOf(together).kinds.size(), 2u);
    ASSERT_EQ(implOf(apart).kinds.size(), scene.herds.size());
    for (const int ticks : {1, 30, 30}) {
      simulate(device(), together, ticks);
      simulate(device(), apart, ticks);
      for (Crowd* crowd : {&together, &apart}) {
        const std::vector<float> heights(100, static_cast<float>(ticks));
        crowd->editHeights(60, 60, 10, 10, heights);
      }
      EXPECT_EQ(together.stateHash(), apart.stateHash());
      EXPECT_EQ(together.sleeping(), apart.sleeping());
    }
    EXPECT_EQ(figuresOf(together.fidelity()), figuresOf(apart.fidelity()));
    for (uint32_t h = 0; h < together.herdCount(); ++h) {
      SCOPED_TRACE(h);
      const HerdState ours = together.download(h), theirs = apart.download(h);
      EXPECT_EQ(ours.agents, scene.herds[h].agents);
      EXPECT_EQ(recordsOf(ours), recordsOf(theirs));
      EXPECT_EQ(ours.watch, theirs.watch);
      EXPECT_TRUE(ours.footfallsKept);
      EXPECT_EQ(eventsOf(ours), eventsOf(theirs));
      EXPECT_EQ(figuresOf(together.fidelity(h)), figuresOf(apart.fidelity(h)));
      const AgentSample sample{.first = 2, .stride = 3};
      EXPECT_EQ(recordsOf(together.download(h, sample)), recordsOf(apart.download(h, sample)));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(, SharedPagesTest, ::testing::ValuesIn(allControllers),
                         [](const auto& param) { return testNameOf(param.param); });

// Landings for want of anything better are counted for the herd whose legs they are of.
TEST_F(KindsTest, CountsAreOfTheHerd) {
  const Heightfield ground = steepGround();
  Scene scene = severalHerds();
  for (Herd& herd : scene.herds) herd.controller = Controller::adaptive;
  scene.herds[2].goal.speed = 5;
  Crowd crowd(device(), ground, scene, CrowdOptions{.footfalls = 3, .pageAgents = 100});
  Crowd all(device(), ground, scene, CrowdOptions{.footfalls = UINT32_MAX});
  std::vector<uint64_t> kept(scene.herds.size()), landed(scene.herds.size());
  for (int i = 0; i < 90; ++i) {
    simulate(device(), crowd, 1);
    simulate(device(), all, 1);
    for (uint32_t h = 0; h < crowd.herdCount(); ++h) {
      kept[h] += crowd.footfalls(h).size();
      landed[h] += all.footfalls(h).size();
    }
  }
  uint64_t dropped = 0;
  for (uint32_t h = 0; h < crowd.herdCount(); ++h) {
    EXPECT_EQ(kept[h] + crowd.droppedFootfalls(h), landed[h]) << h;
    dropped += crowd.droppedFootfalls(h);
    EXPECT_EQ(crowd.fidelity(h).lastResorts, all.fidelity(h).lastResorts) << h;
  }
  EXPECT_GT(dropped, 0u);
  EXPECT_GT(crowd.fidelity(2).lastResorts, 0u);
  EXPECT_EQ(crowd.fidelity(1).lastResorts, 0u);
}

TEST_F(KindsTest, LostTargetsAreOfTheHerd) {
  Scene scene = sceneOf(2);
  scene.herds.resize(3, scene.herds[0]);
  Crowd crowd(device(), flatGround(), scene);
  simulate(device(), crowd, 2);
  // A landing of the fourth agent, which is the second herd's.
  const crowd::Page& page = implOf(crowd).kindOf(1).pages[0];
  std::vector<float> steps = gpu::download<float>(context(), page.step);
  steps[3 * 4 * shared::STEP_STRIDE] = std::numeric_limits<float>::quiet_NaN();
  gpu::upload(context(), page.step, steps);
  simulate(device(), crowd, 1);
  EXPECT_EQ(crowd.fidelity(0).notFinite, 0u);
  EXPECT_GE(crowd.fidelity(1).notFinite, 1u);
  EXPECT_EQ(crowd.fidelity(2).notFinite, 0u);
  EXPECT_EQ(crowd.fidelity().notFinite, crowd.fidelity(1).notFinite);
}

// What a herd's agents draw depends on the scene's seed, the herd's number and theirs.
TEST_F(KindsTest, MoveAsEachHerdAlone) {
  Scene scene = sceneOf(9);
  scene.herds.resize(3, scene.herds[0]);
  scene.herds[1].agents = 20;
  Crowd crowd(device(), rollingGround(), scene, CrowdOptions{.watchEvery = 1});
  simulate(device(), crowd, 40);
  for (uint32_t h = 0; h < 3; ++h) {
    Scene alone = scene;
    alone.herds = {scene.herds[h]};
    alone.seed = scene.seed + (uint64_t{h} << 32);
    Crowd one(device(), rollingGround(), alone, CrowdOptions{.watchEvery = 1});
    simulate(device(), one, 40);
    EXPECT_EQ(recordsOf(crowd.download(h)), recordsOf(one.download(0))) << h;
    EXPECT_EQ(figuresOf(crowd.fidelity(h)), figuresOf(one.fidelity())) << h;
  }
}

// Agents of equal herds take turns as those of one herd do, and the reference follows them all.
TEST_F(KindsTest, PassLockStep) {
  const Heightfield ground = rollingGround();
  const Scene scene = severalHerds();
  Crowd crowd(device(), ground, scene,
              CrowdOptions{.watchEvery = 3, .footfalls = UINT32_MAX, .pageAgents = 23});
  simulate(device(), crowd, 120);
  uint32_t number = 0;
  for (uint32_t h = 0; h < 5; ++h)
    for (const Fidelity& agent : crowd.agentFidelity(h))
      EXPECT_EQ(agent.agentTicks, number++ % 3 == 0 ? 120u : 0u) << h;
  const std::vector<std::vector<validation::StageResult>> results = replayAll(device(), crowd, ground, 20);
  for (size_t h = 0; h < results.size(); ++h)
    if (scene.herds[h].agents > 0) expectAllPass(results[h]);
}

TEST_F(KindsTest, AThousandCostWhatOneDoes) {
  Scene scene = sceneOf(10);
  scene.herds.resize(1024, scene.herds[0]);
  Crowd crowd(device(), flatGround(), scene), one(device(), flatGround(), sceneOf(10240));
  ASSERT_EQ(implOf(crowd).kinds.size(), 1u);
  EXPECT_EQ(implOf(crowd).kinds[0].pages.size(), implOf(one).kinds[0].pages.size());
  EXPECT_EQ(crowd.agentCount(), 10240u);
  simulate(device(), crowd, 2);
  EXPECT_EQ(crowd.download(1023).agents, 10u);
  // Rows of counts and of reach errors, 336 bytes a herd.
  EXPECT_EQ(crowd.memoryBytes(), one.memoryBytes() + 1023 * 336u);
}

// However many herds come before a page's own.
TEST_F(KindsTest, APageSearchesItsOwnHerdsAlone) {
  Scene scene = sceneOf(8);
  scene.herds.resize(16, scene.herds[0]);
  const Crowd crowd(device(), flatGround(), scene, CrowdOptions{.pageAgents = 16});
  ASSERT_EQ(implOf(crowd).kinds.size(), 1u);
  EXPECT_EQ(implOf(crowd).kinds[0].pages.size(), 8u);
  EXPECT_EQ(implOf(crowd).kinds[0].herdSteps, 1);
}

TEST_F(KindsTest, SharesOfMemoryAreTheWhole) {
  const Scene scene = severalHerds();
  const Crowd crowd(device(), rollingGround(), scene, CrowdOptions{.pageAgents = 24});
  uint64_t bytes = 0;
  for (const crowd::Kind& kind : implOf(crowd).kinds) bytes += crowd::bytesOf(implOf(crowd), kind);
  EXPECT_EQ(crowd.memoryBytes(), bytes);
  EXPECT_EQ(crowd.memoryUse(2).front().bytes, 129 * 32u);
  EXPECT_EQ(crowd.memoryUse(0).front().bytes, 0u);
}

// As many herds as can differ, and one more.
TEST(KindsRefusalTest, NamesWhatDiffersAndTheMost) {
  Scene scene = sceneOf(1);
  scene.name = "zoo.json";
  for (int i = 0; i < 99; ++i) {
    Herd herd = scene.herds[0];
    herd.clips = {std::to_string(i)};
    scene.herds.insert(scene.herds.end(), 2, herd);
  }
  const crowd::Kinds kinds = crowd::kindsOf(scene);
  EXPECT_EQ(kinds.rigs.size(), 100u);
  EXPECT_EQ(kinds.herds.front().kind, 0u);
  EXPECT_EQ(kinds.herds.back().kind, 99u);
  EXPECT_EQ(kinds.firstHerds.back(), 197u);
  scene.herds.back().keys = 5;
  try {
    crowd::kindsOf(scene);
    FAIL() << "was taken";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::input);
    EXPECT_THAT(error.what(), ::testing::HasSubstr("zoo.json: 101 herds differ in rig, controller, clips"));
    EXPECT_THAT(error.what(), ::testing::HasSubstr("expected at most 100"));
  }
}

// Each of these makes a kind; agents, spawn and goal do not.
TEST(KindsRefusalTest, WhatDiffers) {
  const std::pair<const char*, void (*)(Herd&)> changes[] = {
      {"rig", [](Herd& h) { h.rig = "other.glb"; }},
      {"controller", [](Herd& h) { h.controller = Controller::loop; }},
      {"clips", [](Herd& h) { h.clips = {"walk"}; }},
      {"cuts",
       [](Herd& h) {
         h.cuts = {{"walk", "part", 0, 1}};
       }},
      {"keys", [](Herd& h) { h.keys = 6; }},
      {"solver", [](Herd& h) { h.solver = Solver::ccd; }},
      {"stepping", [](Herd& h) { h.stepping = Stepping::reach; }},
      {"tuning", [](Herd& h) { h.tuning.stepHeight = 0.2f; }}};
  for (const auto& [name, change] : changes) {
    Scene scene = sceneOf(1);
    scene.herds.resize(2, scene.herds[0]);
    change(scene.herds[1]);
    EXPECT_EQ(crowd::kindsOf(scene, {spiderRig(), spiderRig()}).rigs.size(), 2u) << name;
  }
  Scene scene = sceneOf(1);
  scene.herds.resize(2, scene.herds[0]);
  scene.herds[1].agents = 7;
  scene.herds[1].spawn = {.kind = Spawn::Kind::grid, .spacing = 3, .centre = {1, 2}, .heading = 3};
  scene.herds[1].goal = {.kind = Goal::Kind::point, .target = {1, 2}, .speed = 3};
  EXPECT_EQ(crowd::kindsOf(scene, {spiderRig(), spiderRig()}).rigs.size(), 1u);
  EXPECT_EQ(crowd::kindsOf(scene).rigs.size(), 1u);
  // Rigs of the caller's are compared, whatever the scene calls them.
  EXPECT_EQ(crowd::kindsOf(scene, {spiderRig(), scaledSpider(1.7f)}).rigs.size(), 2u);
}

}  // namespace
}  // namespace skitter::test
