// Lock-step replay: every tick, each stage of the reference starts from what the device's stage started from.
#include "crowd/simulation.h"

namespace skitter::test {
namespace {

using ReplayTest = GpuLoadTest;

TEST_P(ReplayTest, SixHundredTicksOnRollingGround) {
  const Heightfield ground = rollingGround();
  Crowd crowd(device(), ground, sceneOf(64), CrowdOptions{.footfalls = UINT32_MAX});
  const auto results = replay(device(), crowd, ground, 600);
  expectAllPass(results);
  for (const validation::StageResult& stage : results) EXPECT_GT(stage.samples, 0u) << stage.name;
}

TEST_P(ReplayTest, FastAndTurning) {
  const Heightfield ground = flatGround();
  Crowd crowd(device(), ground, sceneOf(16, 3, 7), CrowdOptions{.footfalls = UINT32_MAX});
  simulate(device(), crowd, 600);
  expectAllPass(replay(device(), crowd, ground, 240));
}

// A leg may meet its limit to within rounding, so that one of device and reference holds it and the other
// does not: on lavapipe one does, in tick 9.
TEST_P(ReplayTest, LimitMetToWithinRounding) {
  Scene scene = builtinScene();
  scene.herds.resize(1);
  scene.herds[0].agents = 24;
  scene.herds[0].controller = Controller::loop;
  const Heightfield ground = scene.loadTerrain();
  Crowd crowd(device(), ground, scene);
  expectAllPass(replay(device(), crowd, ground, 30, 0.1f));
}

INSTANTIATE_TEST_SUITE_P(, ReplayTest, bothLoadPaths(), loadPathName);

}  // namespace
}  // namespace skitter::test
