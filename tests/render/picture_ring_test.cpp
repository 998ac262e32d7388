#include "render/picture_ring.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "gpu/submit.h"
#include "skitter/renderer.h"
#include "support/gpu_fixture.h"

namespace skitter::test {
namespace {

class PictureRingTest : public GpuTest {};

// Two pictures of one submission are both there afterwards, each as a picture by itself is.
TEST_F(PictureRingTest, keepsEachPictureInItsSlot) {
  Scene scene = builtinScene();
  scene.herds[0].agents = 20;
  const Heightfield terrain = scene.loadTerrain();
  Crowd crowd(device(), terrain, scene);
  Renderer renderer(device(), crowd, 67, 45);
  gpu::submitAndWait(context(), [&](vk::CommandBuffer cmd) { crowd.record(cmd, 1.0f / 60); });
  const View views[] = {viewOf(scene, crowd, 0), {.eye = {0, 9, 0}, .target = {0, 0, 1}}};
  std::vector<uint8_t> alone[2];
  for (int i = 0; i < 2; ++i) {
    gpu::submitAndWait(context(), [&](vk::CommandBuffer cmd) { renderer.record(cmd, views[i]); });
    alone[i] = renderer.download();
  }
  ASSERT_NE(alone[0], alone[1]);
  const render::PictureRing ring(context(), 67, 45, 2);
  gpu::submitAndWait(context(), [&](vk::CommandBuffer cmd) {
    for (uint32_t i = 0; i < 2; ++i) {
      renderer.record(cmd, views[i]);
      ring.record(cmd, renderer.image(), i);
    }
  });
  for (uint32_t i = 0; i < 2; ++i) {
    EXPECT_EQ(ring.pixels(i).size(), 67u * 45 * 4);
    EXPECT_TRUE(std::ranges::equal(ring.pixels(i), alone[i])) << i;
  }
}

}  // namespace
}  // namespace skitter::test
