#include "app/viewer/camera_control.h"

#include <gtest/gtest.h>

#include <cmath>

namespace skitter::app {
namespace {

// A plane that rises to +x: y = slope * x.
Heightfield ground(float slope = 0) {
  Heightfield field;
  field.columns = field.rows = 101;
  for (uint32_t row = 0; row < field.rows; ++row)
    for (uint32_t column = 0; column < field.columns; ++column)
      field.heights.push_back(slope * (static_cast<float>(column) - 50));
  return field;
}

const View scenes{.eye = {0, 4, -8}, .target = {0, 1, 0}, .fieldOfView = 0.8f};

CameraControl started(const View& view = scenes) {
  CameraControl camera;
  camera.advance(view, {}, 0.02f);
  return camera;
}

void expectNear(const glm::vec3& got, const glm::vec3& expected, float within = 1e-4f) {
  EXPECT_LT(glm::distance(got, expected), within) << got.x << ' ' << got.y << ' ' << got.z << ", expected "
                                                  << expected.x << ' ' << expected.y << ' ' << expected.z;
}

// Long enough for all that glides to have arrived.
void settle(CameraControl& camera, const View& view, const std::optional<CameraControl::Followed>& followed) {
  for (int i = 0; i < 200; ++i) camera.advance(view, followed, 0.02f);
}

TEST(CameraControl, IsTheScenesUntilItIsTakenHoldOf) {
  CameraControl camera = started();
  View moved = scenes;
  moved.eye += glm::vec3(3, -20, 1);  // even below the ground
  moved.fieldOfView = 0.5f;
  camera.advance(moved, {}, 0.02f);
  EXPECT_EQ(camera.view(ground()).eye, moved.eye);
  EXPECT_EQ(camera.view(ground()).target, moved.target);
  EXPECT_EQ(camera.view(ground()).fieldOfView, 0.5f);
}

TEST(CameraControl, TakingHoldMovesNothing) {
  CameraControl camera = started();
  camera.orbit(0, 0);
  expectNear(camera.view(ground()).eye, scenes.eye);
  expectNear(camera.view(ground()).target, scenes.target);
}

TEST(CameraControl, OrbitsAtTheSameDistance) {
  CameraControl camera = started();
  camera.orbit(0.5f * 3.14159265f, 0);
  // It looked along +z, so its left is +x.
  expectNear(camera.view(ground()).eye, {8, 4, 0}, 1e-3f);
  camera.orbit(0, 0.3f);
  const View higher = camera.view(ground());
  EXPECT_GT(higher.eye.y, 4);
  EXPECT_NEAR(glm::distance(higher.eye, higher.target), std::sqrt(73.0f), 1e-3f);
  expectNear(higher.target, scenes.target);
}

TEST(CameraControl, NeverTurnsOverItsHead) {
  CameraControl camera = started();
  camera.orbit(0, 100);
  const View above = camera.view(ground());
  EXPECT_GT(above.eye.y, 9);
  EXPECT_LT(above.eye.z, 0);
}

TEST(CameraControl, PansByWhatThePictureShows) {
  CameraControl camera = started();
  // The whole height of the picture at the pivot's distance.
  camera.pan(1, 0);
  const float height = 2 * std::sqrt(73.0f) * std::tan(0.4f);
  // What is seen goes right, so the camera goes left, which is +x.
  expectNear(camera.view(ground()).target, {height, 1, 0}, 1e-3f);
  camera.pan(-1, 0.5f);
  const View down = camera.view(ground());
  EXPECT_LT(down.target.y, 1);
  EXPECT_NEAR(glm::distance(down.target, scenes.target), 0.5f * height, 1e-3f);
}

TEST(CameraControl, ZoomsByTenthsAndStopsShort) {
  CameraControl camera = started();
  camera.zoom(2);
  settle(camera, scenes, {});
  const View nearer = camera.view(ground());
  EXPECT_NEAR(glm::distance(nearer.eye, nearer.target), 0.81f * std::sqrt(73.0f), 1e-2f);
  camera.zoom(1000);
  settle(camera, scenes, {});
  const View nearest = camera.view(ground());
  EXPECT_NEAR(glm::distance(nearest.eye, nearest.target), 0.3f, 1e-2f);
}

TEST(CameraControl, FliesAsItLooks) {
  CameraControl camera = started({.eye = {0, 5, 0}, .target = {0, 5, 10}, .fieldOfView = 0.8f});
  camera.fly({0, 0, 1}, 0.5f);
  expectNear(camera.view(ground()).eye, {0, 5, 5}, 1e-3f);
  camera.fly({1, 0, 0}, 0.1f);
  expectNear(camera.view(ground()).eye, {-1, 5, 5}, 1e-3f);
  camera.fly({0, 1, 0}, 0.1f);
  expectNear(camera.view(ground()).eye, {-1, 6, 5}, 1e-3f);
}

TEST(CameraControl, StaysAboveTheGround) {
  const Heightfield hill = ground(0.5f);
  CameraControl camera = started();
  camera.fly({0.25f, -1, 0}, 10);
  View low = camera.view(hill);
  EXPECT_NEAR(low.eye.y, hill.at(low.eye.x, low.eye.z) + 0.3f, 1e-4f);
  const glm::vec3 line = low.target - low.eye;
  expectNear(glm::normalize(line), glm::normalize(scenes.target - scenes.eye), 1e-3f);
}

TEST(CameraControl, GoesAlongWithTheScenesTargetUntilItIsMoved) {
  View walked = scenes;
  walked.target.z += 3;
  CameraControl camera = started();
  camera.orbit(0, 0);
  camera.advance(walked, {}, 0.02f);
  expectNear(camera.view(ground()).target, {0, 1, 3});
  expectNear(camera.view(ground()).eye, {0, 4, -5});
  camera.pan(0, 0);
  camera.advance(scenes, {}, 0.02f);
  expectNear(camera.view(ground()).target, {0, 1, 3});
  camera.letGo();
  expectNear(camera.view(ground()).target, scenes.target);
}

TEST(CameraControl, FollowsAnAgentAndComesCloser) {
  CameraControl camera = started();
  const CameraControl::Followed agent{{5, 0.5f, 20}, 4};
  settle(camera, scenes, agent);
  const View close = camera.view(ground());
  expectNear(close.target, agent.at, 1e-2f);
  EXPECT_NEAR(glm::distance(close.eye, close.target), 4, 1e-2f);
  expectNear(glm::normalize(close.target - close.eye), glm::normalize(scenes.target - scenes.eye), 1e-3f);
  // It stays there when the agent is let go of.
  settle(camera, scenes, {});
  expectNear(camera.view(ground()).target, agent.at, 1e-2f);
}

TEST(CameraControl, AimsAtTheGroundInTheMiddleOfThePicture) {
  CameraControl camera = started({.eye = {0, 4, -8}, .target = {0, 3, -7}, .fieldOfView = 0.8f});
  camera.aim(ground());
  const View aimed = camera.view(ground());
  expectNear(aimed.eye, {0, 4, -8}, 1e-3f);
  expectNear(aimed.target, {0, 0, -4}, 1e-2f);
}

TEST(CameraControl, FindsTheGroundOnARay) {
  const Heightfield hill = ground(0.5f);
  const auto met = groundAlong(hill, {-10, 10, 0}, {1, 0, 0}, 100);
  ASSERT_TRUE(met);
  EXPECT_NEAR(*met, 30, 1e-3f);
  EXPECT_FALSE(groundAlong(hill, {-10, 10, 0}, {1, 0, 0}, 29));
  EXPECT_FALSE(groundAlong(hill, {-10, 10, 0}, {-1, 0, 0}, 100));
}

}  // namespace
}  // namespace skitter::app
