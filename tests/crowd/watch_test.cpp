// Who is measured when, and that nobody is forgotten.
#include "crowd/simulation.h"

namespace skitter::test {
namespace {

using WatchTest = GpuLoadTest;

TEST_P(WatchTest, AgentsTakeTurns) {
  const Heightfield ground = rollingGround();
  Crowd crowd(device(), ground, sceneOf(23), CrowdOptions{.watchEvery = 3, .pageAgents = 7});
  simulate(device(), crowd, 128 + 10);
  const std::vector<Fidelity> agents = crowd.agentFidelity(0);
  ASSERT_EQ(agents.size(), 23u);
  for (size_t agent = 0; agent < 23; ++agent)
    EXPECT_EQ(agents[agent].agentTicks, agent % 3 == 0 ? 128u : (agent % 3 == 1 ? 10u : 0u)) << agent;
  EXPECT_EQ(crowd.fidelity().agentTicks, 8 * 128 + 8 * 10u);
}

// Lock-step over a change of turn, with pages that do not begin with a watched agent.
TEST_P(WatchTest, IsWhatTheReferenceMeasures) {
  const Heightfield ground = rollingGround();
  Crowd crowd(device(), ground, sceneOf(23), CrowdOptions{.watchEvery = 3, .pageAgents = 7});
  simulate(device(), crowd, 100);
  expectAllPass(replay(device(), crowd, ground, 60));
}

TEST_P(WatchTest, PagesDoNotShow) {
  const Heightfield ground = rollingGround();
  Crowd whole(device(), ground, sceneOf(23), CrowdOptions{.watchEvery = 3}),
      paged(device(), ground, sceneOf(23), CrowdOptions{.watchEvery = 3, .pageAgents = 7});
  simulate(device(), whole, 150);
  simulate(device(), paged, 150);
  EXPECT_EQ(whole.download(0).metric, paged.download(0).metric);
}

// Herds that come count from the start, and those that are gone by then do not.
TEST_P(WatchTest, IsOfTheMostAgentsThatThereWillBe) {
  const auto every = [&](const std::vector<decltype(Event::what)>& events) {
    Scene scene = sceneOf(8);
    for (const auto& what : events) scene.events.push_back({1, what});
    return Crowd(device(), flatGround(), scene).watchEvery();
  };
  const auto added = [](uint32_t agents) { return HerdAddition{sceneOf(agents).herds[0]}; };
  EXPECT_EQ(every({}), 1u);
  EXPECT_EQ(every({added(248)}), 1u);
  EXPECT_EQ(every({added(249)}), 64u);
  EXPECT_EQ(every({added(200), HerdRemoval{1}, added(200)}), 1u);
  EXPECT_EQ(every({added(200), added(49), HerdRemoval{1}}), 64u);
}

INSTANTIATE_TEST_SUITE_P(, WatchTest, bothLoadPaths(), loadPathName);

}  // namespace
}  // namespace skitter::test
