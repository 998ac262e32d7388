// Sizes that are no multiple of anything, and inputs that are nasty.
#include <cmath>
#include <limits>

#include "crowd/herd.h"
#include "crowd/simulation.h"
#include "gpu/transfer.h"
#include "skitter/error.h"

namespace skitter::test {
namespace {

using EdgeTest = GpuLoadTest;

void expectFinite(const HerdState& state) {
  for (const auto* records : {&state.body, &state.gait, &state.step, &state.foot, &state.chain, &state.pose})
    for (const float value : *records) ASSERT_TRUE(std::isfinite(value));
}

TEST_P(EdgeTest, AnyNumberOfAgents) {
  const Heightfield ground = rollingGround();
  for (const uint32_t agents : {0u, 1u, 63u, 64u, 65u, 1234u}) {
    SCOPED_TRACE(agents);
    Crowd crowd(device(), ground, sceneOf(agents));
    expectAllPass(replay(device(), crowd, ground, 3));
    const HerdState state = crowd.download(0);
    EXPECT_EQ(state.agents, agents);
    expectFinite(state);
  }
}

TEST_P(EdgeTest, CliffsAndTheTerrainsEdge) {
  const Heightfield ground = cliffGround();
  Crowd crowd(device(), ground, sceneOf(64, 2));
  simulate(device(), crowd, 300);
  expectAllPass(replay(device(), crowd, ground, 60));
  expectFinite(crowd.download(0));
}

TEST_P(EdgeTest, TheSmallestTerrain) {
  Heightfield tiny;
  tiny.columns = tiny.rows = 2;
  tiny.heights = {0, 0.2f, 0.1f, 0.3f};
  Crowd crowd(device(), tiny, sceneOf(5));
  expectAllPass(replay(device(), crowd, tiny, 60));
  expectFinite(crowd.download(0));
}

TEST_P(EdgeTest, FeetThatCannotBeFollowedKeepThePose) {
  const Heightfield ground = flatGround();
  Crowd crowd(device(), ground, sceneOf(3));
  simulate(device(), crowd, 2);
  // A landing that is not a number, as a broken caller might write it.
  const crowd::Page& page = crowd.impl().herds[0].pages[0];
  std::vector<float> steps = gpu::download<float>(context(), page.step);
  steps[0] = std::numeric_limits<float>::quiet_NaN();
  gpu::upload(context(), page.step, steps);
  const HerdState before = crowd.download(0);
  simulate(device(), crowd, 1);
  const HerdState after = crowd.download(0);
  EXPECT_GE(crowd.fidelity().notFinite, 1u);
  // Its legs keep their directions, and nobody else notices.
  const auto stride = static_cast<size_t>(shared::chainStride(crowd.rig(0).maxBones())) * 4;
  for (size_t leg = 0; leg < 8; ++leg)
    for (size_t i = 0; i < 8; ++i)
      EXPECT_NEAR(after.chain[leg * stride + i], before.chain[leg * stride + i], 1e-6) << leg;
  for (size_t i = after.pose.size() / 3; i < after.pose.size(); ++i)
    ASSERT_TRUE(std::isfinite(after.pose[i]));
}

INSTANTIATE_TEST_SUITE_P(, EdgeTest, bothLoadPaths(), loadPathName);

using InputTest = GpuTest;

TEST_F(InputTest, RefusesWhatItDoesNotKnow) {
  Scene scene = sceneOf(1);
  scene.herds[0].controller = "magic";
  EXPECT_THROW(Crowd(device(), flatGround(), scene), Error);
  scene.herds[0].controller = "planted";
  scene.herds[0].solver = "ccd";
  EXPECT_THROW(Crowd(device(), flatGround(), scene), Error);
  Crowd crowd(device(), flatGround(), sceneOf(1));
  EXPECT_THROW(simulate(device(), crowd, 1, 0), Error);
  EXPECT_THROW(simulate(device(), crowd, 1, std::numeric_limits<float>::quiet_NaN()), Error);
}

}  // namespace
}  // namespace skitter::test
