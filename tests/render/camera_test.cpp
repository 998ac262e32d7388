#include "support/gpu_fixture.h"

#include "skitter/renderer.h"

namespace skitter::test {
namespace {

class CameraTest : public GpuTest {};

TEST_F(CameraTest, followMovesWithTheHerdAboveTheGround) {
  Scene scene = builtinScene();
  const Heightfield terrain = scene.loadTerrain();
  const Crowd crowd(device(), terrain, scene);
  const float speed = scene.herds[0].goal.speed;
  const View start = viewOf(scene, crowd, 0), later = viewOf(scene, crowd, 5);
  EXPECT_NEAR(later.target.z - start.target.z, 5 * speed, 0.01f);
  EXPECT_NEAR(later.target.x, start.target.x, 0.01f);
  for (double seconds = 0; seconds < 1000; seconds += 3.7) {
    const View view = viewOf(scene, crowd, seconds);
    ASSERT_GT(view.eye.y, terrain.at(view.eye.x, view.eye.z) + 0.2f) << seconds;
    ASSERT_LE(std::abs(view.target.x), terrain.extentX() / 2);
    ASSERT_LE(std::abs(view.target.z), terrain.extentZ() / 2);
  }
}

TEST_F(CameraTest, fixedIsWhereTheSceneSays) {
  Scene scene = builtinScene();
  scene.herds[0].agents = 0;
  const Heightfield terrain = scene.loadTerrain();
  const Crowd crowd(device(), terrain, scene);
  EXPECT_NO_THROW(viewOf(scene, crowd, 3));
  scene.camera = {
      .kind = Camera::Kind::fixed, .position = {1, 2, 3}, .target = {4, 5, 6}, .fieldOfView = 0.5f};
  const View view = viewOf(scene, crowd, 3);
  EXPECT_EQ(view.eye, glm::vec3(1, 2, 3));
  EXPECT_EQ(view.target, glm::vec3(4, 5, 6));
  EXPECT_EQ(view.fieldOfView, 0.5f);
}

}  // namespace
}  // namespace skitter::test
