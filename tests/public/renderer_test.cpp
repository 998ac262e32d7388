#include "skitter/renderer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "public/public.h"

namespace skitter::test {
namespace {

using PublicRenderer = PublicTest;

TEST_F(PublicRenderer, DrawsTheCrowdIntoItsImage) {
  const Scene scene = standingScene(4);
  Crowd crowd(device(), flatGround(), scene);
  walk(device(), crowd, 1);
  Renderer first(device(), crowd, 64, 48);
  Renderer renderer = std::move(first);
  EXPECT_EQ(renderer.width(), 64u);
  EXPECT_EQ(renderer.height(), 48u);
  EXPECT_NE(renderer.image(), VkImage{VK_NULL_HANDLE});
  renderer.timeStages(true);
  const View view = viewOf(scene, crowd, 0);
  bool called = false;
  device().run([&](VkCommandBuffer commands) {
    renderer.record(commands, view, [&](VkCommandBuffer within) { called = within == commands; });
  });
  EXPECT_TRUE(called);
  if (device().report().limits.timestampBits > 0) {
    EXPECT_FALSE(renderer.stageTimes().empty());
  }
  EXPECT_TRUE(renderer.notes().empty());
  const std::vector<uint8_t> pixels = renderer.download();
  ASSERT_EQ(pixels.size(), 64u * 48 * 4);
  // Ground, sky and legs differ.
  const auto [least, most] = std::ranges::minmax(pixels);
  EXPECT_GT(most - least, 30);
  // The same picture again, to the bit.
  device().run([&](VkCommandBuffer commands) { renderer.record(commands, view); });
  EXPECT_EQ(renderer.download(), pixels);
}

// As many agents as the camera has in sight, and more triangles with them than without.
TEST_F(PublicRenderer, CountsWhatIsInThePicture) {
  const Scene scene = standingScene(4);
  Crowd crowd(device(), flatGround(), scene);
  walk(device(), crowd, 1);
  Renderer renderer(device(), crowd, 64, 48);
  EXPECT_EQ(renderer.counts().triangles, 0u);
  const View above{.eye = {0, 60, 0}, .target = {0, 0, 0.1f}};
  const View away{.eye = {0, 60, 0}, .target = {0, 120, 0.1f}};
  device().run([&](VkCommandBuffer commands) { renderer.record(commands, above); });
  const PictureCounts seen = renderer.counts();
  EXPECT_EQ(seen.agents, 4u);
  device().run([&](VkCommandBuffer commands) { renderer.record(commands, away); });
  EXPECT_EQ(renderer.counts().agents, 0u);
  EXPECT_LT(renderer.counts().triangles, seen.triangles);
}

TEST_F(PublicRenderer, LooksFromTheScenesCamera) {
  Scene scene = standingScene(4);
  const Crowd crowd(device(), flatGround(), scene);
  scene.camera = {.kind = Camera::Kind::fixed, .position = {1, 2, 3}, .target = {4, 5, 6}};
  scene.camera.fieldOfView = 0.5f;
  EXPECT_EQ(viewOf(scene, crowd, 1).eye, glm::vec3(1, 2, 3));
  EXPECT_EQ(viewOf(scene, crowd, 1).target, glm::vec3(4, 5, 6));
  EXPECT_EQ(viewOf(scene, crowd, 1).fieldOfView, 0.5f);
  scene.camera.kind = Camera::Kind::follow;
  EXPECT_GT(viewOf(scene, crowd, 1).eye.y, 0);
  scene.camera.kind = Camera::Kind::path;
  scene.camera.keys = {{.time = 0}};
  expectRefused("1 points", [&] { viewOf(scene, crowd, 1); });
}

// Agents that only play clips are posed where they are shown, in the same picture; all others need poses.
TEST_F(PublicRenderer, PosesThoseWhoOnlyPlayClips) {
  Scene scene = standingScene(9);
  EXPECT_TRUE(Renderer::needsPoses(scene));
  scene.herds[0].controller = Controller::clip;
  EXPECT_FALSE(Renderer::needsPoses(scene));
  std::vector<std::vector<uint8_t>> pictures;
  for (const bool pose : {true, false}) {
    Crowd crowd(device(), flatGround(), scene, {.pose = pose});
    Renderer renderer(device(), crowd, 160, 90);
    walk(device(), crowd, 10);
    device().run([&](VkCommandBuffer cmd) {
      renderer.record(cmd, {.eye = {0, 4, -8}, .target = {0, 0, 0}});
    });
    EXPECT_EQ(crowd.download(0).pose.empty(), !pose);
    pictures.push_back(renderer.download());
  }
  EXPECT_EQ(pictures[0].size(), pictures[1].size());
  int apart = 0;
  for (size_t i = 0; i < pictures[0].size(); ++i)
    apart += std::abs(int(pictures[0][i]) - int(pictures[1][i])) > 3;
  EXPECT_LT(apart, 40);
  Crowd crowd(device(), flatGround(), scene, {.pose = false});
  Renderer renderer(device(), crowd, 160, 90);
  crowd.addHerd(standingScene(1).herds[0]);
  expectRefused("needs CrowdOptions::pose",
                [&] { device().run([&](VkCommandBuffer cmd) { renderer.record(cmd, {}); }); });
  scene.events.push_back({.at = 1, .what = HerdAddition{standingScene(1).herds[0]}});
  EXPECT_TRUE(Renderer::needsPoses(scene));
}

TEST_F(PublicRenderer, RefusesWhatCannotBe) {
  const Crowd crowd(device(), flatGround(), standingScene(1));
  expectRefused("0 x 48 pixels", [&] { Renderer(device(), crowd, 0, 48); });
  expectError(Error::Kind::device, "draws at most", [&] { Renderer(device(), crowd, 1 << 20, 48); });
  const Crowd poseless(device(), flatGround(), standingScene(1), {.pose = false});
  expectRefused("pose", [&] { Renderer(device(), poseless, 64, 48); });
  for (const float detail : {0.0f, 0.2f, -1.0f, 2e5f, NAN, INFINITY})
    expectRefused("detail is ", [&] { Renderer(device(), crowd, 64, 48, {.detail = detail}); });
  for (const float scale : {0.0f, 0.2f, -1.0f, 1.01f, NAN, INFINITY})
    expectRefused("scale is ", [&] { Renderer(device(), crowd, 64, 48, {.scale = scale}); });
}

}  // namespace
}  // namespace skitter::test
