// The synchronization layer looks no further than one submission, so everything that a frame loop does stands
// in one here: several ticks, a picture, another tick, another picture.
#include "gpu/submit.h"
#include "skitter/renderer.h"
#include "support/gpu_fixture.h"

namespace skitter::test {
namespace {

using SubmissionTest = GpuLoadTest;
INSTANTIATE_TEST_SUITE_P(, SubmissionTest, bothLoadPaths(), loadPathName);

Scene someSpiders() {
  Scene scene = builtinScene();
  scene.herds[0].agents = 70;
  return scene;
}

TEST_P(SubmissionTest, ticksAndPicturesInOneSubmission) {
  const Scene scene = someSpiders();
  const Heightfield terrain = scene.loadTerrain();
  Crowd together(device(), terrain, scene), apart(device(), terrain, scene);
  Renderer picture(device(), together, 160, 90);
  gpu::submitAndWait(context(), [&](vk::CommandBuffer cmd) {
    for (int tick = 0; tick < 3; ++tick) together.record(cmd, 1.0f / 60);
    picture.record(cmd, viewOf(scene, together, 0.05));
    together.record(cmd, 1.0f / 60);
    picture.record(cmd, viewOf(scene, together, 0.07));
  });
  for (int tick = 0; tick < 4; ++tick)
    gpu::submitAndWait(context(), [&](vk::CommandBuffer cmd) { apart.record(cmd, 1.0f / 60); });
  EXPECT_EQ(together.stateHash(), apart.stateHash());
}

}  // namespace
}  // namespace skitter::test
