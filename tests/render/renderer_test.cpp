#include "skitter/renderer.h"

#include <gmock/gmock.h>

#include <cmath>

#include "gpu/submit.h"
#include "shared/records.h"
#include "support/gpu_fixture.h"

namespace skitter::test {
namespace {

using ::testing::HasSubstr;

// One herd on small ground.
Scene smallScene(uint32_t agents) {
  Scene scene = builtinScene();
  TerrainNoise noise;
  noise.columns = noise.rows = 129;
  scene.terrain = noise;
  scene.herds.resize(1);
  scene.herds[0].agents = agents;
  scene.camera = Camera{};
  return scene;
}

struct Picture {
  uint32_t width, height;
  std::vector<uint8_t> rgba;

  glm::ivec3 at(int x, int y) const {
    const uint8_t* p = &rgba[(size_t(y) * width + size_t(x)) * 4];
    return {p[0], p[1], p[2]};
  }
  glm::dvec3 mean(int firstRow, int lastRow) const {
    glm::dvec3 sum(0);
    for (int y = firstRow; y <= lastRow; ++y)
      for (int x = 0; x < int(width); ++x) sum += glm::dvec3(at(x, y));
    return sum / double((lastRow - firstRow + 1) * int(width));
  }
};

// A scene that lives on a device, and pictures of it.
struct Stage {
  Scene scene;
  Heightfield terrain;
  Crowd crowd;
  Renderer renderer;
  gpu::Context& context;

  Stage(Device& device, const Scene& s, uint32_t width, uint32_t height)
      : scene(s),
        terrain(s.loadTerrain()),
        crowd(device, terrain, scene),
        renderer(device, crowd, width, height),
        context(device.context()) {}

  void tick(int count) {
    for (int i = 0; i < count; ++i)
      gpu::submitAndWait(context, [&](vk::CommandBuffer cmd) { crowd.record(cmd, 1.0f / 60); });
  }
  Picture draw(const View& view) {
    gpu::submitAndWait(context, [&](vk::CommandBuffer cmd) { renderer.record(cmd, view); });
    return {renderer.width(), renderer.height(), renderer.download()};
  }
};

size_t differing(const Picture& a, const Picture& b) {
  size_t count = 0;
  for (size_t i = 0; i < a.rgba.size(); i += 4)
    count += !std::equal(a.rgba.begin() + long(i), a.rgba.begin() + long(i) + 3, b.rgba.begin() + long(i));
  return count;
}

// Independent of the renderer's own matrices.
glm::vec2 pixelOf(const View& view, glm::vec3 point, uint32_t width, uint32_t height) {
  const glm::vec3 forward = glm::normalize(view.target - view.eye);
  const glm::vec3 right = glm::normalize(glm::cross(forward, glm::vec3(0, 1, 0)));
  const glm::vec3 up = glm::cross(right, forward), to = point - view.eye;
  const float focal = 0.5f * float(height) / std::tan(view.fieldOfView / 2) / glm::dot(to, forward);
  return {0.5f * float(width) + focal * glm::dot(to, right), 0.5f * float(height) - focal * glm::dot(to, up)};
}

glm::vec3 bodyOf(const HerdState& state) {
  const std::vector<float>& b = state.body;
  return {shared::tileX(b[3]) * shared::TILE_SIZE + b[0], b[1],
          shared::tileZ(b[3]) * shared::TILE_SIZE + b[2]};
}

class RendererTest : public GpuLoadTest {};
INSTANTIATE_TEST_SUITE_P(Loads, RendererTest, bothLoadPaths(), loadPathName);

TEST_P(RendererTest, drawsSkyAboveGroundWithoutAgents) {
  Stage stage(device(), smallScene(0), 160, 90);
  const Picture picture = stage.draw({.eye = {0, 6, -20}, .target = {0, 2, 0}});
  const glm::dvec3 sky = picture.mean(0, 8), ground = picture.mean(70, 89);
  EXPECT_GT(sky.b, sky.r);
  EXPECT_GT(ground.r, ground.b + 10);
  for (const double value : {sky.r, sky.b, ground.r}) {
    EXPECT_GT(value, 40);
    EXPECT_LT(value, 250);
  }
  double spread = 0;
  for (int x = 0; x < 160; ++x) spread += std::abs(picture.at(x, 80).r - ground.r);
  EXPECT_GT(spread / 160, 2);
  for (size_t i = 3; i < picture.rgba.size(); i += 4) ASSERT_EQ(picture.rgba[i], 255);
}

TEST_P(RendererTest, aSpiderIsWhereItsBonesAre) {
  const uint32_t width = 321, height = 203;
  // Turned well away from its rest pose, so that every rotation counts.
  Scene scene = smallScene(1);
  scene.herds[0].spawn = {.kind = Spawn::Kind::grid, .spacing = 2, .centre = {3, 5}, .heading = 2.1f};
  scene.herds[0].goal = {.kind = Goal::Kind::none, .target = {0, 0}, .speed = 0};
  Stage stage(device(), scene, width, height), empty(device(), smallScene(0), width, height);
  stage.tick(40);
  const HerdState state = stage.crowd.download(0);
  const glm::vec3 body = bodyOf(state);
  // From the side, so that all of it is in the picture.
  const View view{.eye = body + glm::vec3(3.5f, 1.5f, 1.0f), .target = body + glm::vec3(0, 0.3f, 0)};
  const Picture with = stage.draw(view), without = empty.draw(view);

  const Rig& rig = stage.crowd.rig(0);
  const int bones = rig.maxBones();
  ASSERT_EQ(state.pose.size(), size_t(rig.paletteSize()) * 8);
  const auto joint = [&](int leg, int i) {
    const float* p =
        i < bones ? &state.pose[size_t(1 + leg * bones + i) * 8 + 4] : &state.tip[size_t(leg) * 4];
    return body + glm::vec3(p[0], p[1], p[2]);
  };
  for (int leg = 0; leg < rig.legCount(); ++leg)
    for (int i = 0; i < bones; ++i)
      for (const float share : {0.0f, 0.3f, 0.6f}) {
        const glm::vec3 point = glm::mix(joint(leg, i), joint(leg, i + 1), share);
        const glm::ivec2 at(glm::floor(pixelOf(view, point, width, height)));
        bool drawn = false;
        for (int y = at.y - 1; y <= at.y + 1; ++y)
          for (int x = at.x - 1; x <= at.x + 1; ++x) drawn = drawn || with.at(x, y) != without.at(x, y);
        EXPECT_TRUE(drawn) << "leg " << leg << ", bone " << i << " at pixel " << at.x << ", " << at.y;
      }
  // And nowhere else: the sky beside it is untouched, and most of the picture is ground.
  EXPECT_EQ(with.at(2, 2), without.at(2, 2));
  EXPECT_LT(differing(with, without), size_t(width) * height / 3);
}

TEST_P(RendererTest, theSamePictureTwiceAndAnotherWhenAgentsMove) {
  Stage stage(device(), smallScene(70), 200, 120);
  stage.tick(1);
  const View view = viewOf(stage.scene, stage.crowd, 0);
  const Picture first = stage.draw(view), again = stage.draw(view);
  EXPECT_EQ(differing(first, again), 0u);
  stage.tick(60);
  EXPECT_GT(differing(first, stage.draw(view)), 100u);
}

// Shadows are part of what ties a foot to the ground: there must be some, darker than the ground without.
TEST_P(RendererTest, agentsCastShadows) {
  Stage stage(device(), smallScene(1), 160, 160), empty(device(), smallScene(0), 160, 160);
  stage.tick(1);
  const glm::vec3 body = bodyOf(stage.crowd.download(0));
  const View above{.eye = body + glm::vec3(0, 7, -0.1f), .target = body, .fieldOfView = 0.9f};
  const Picture with = stage.draw(above), without = empty.draw(above);
  int darker = 0;
  for (int y = 0; y < 160; ++y)
    for (int x = 0; x < 160; ++x) {
      const glm::ivec3 a = with.at(x, y), b = without.at(x, y);
      darker += a.r < b.r - 15 && a.r > b.r / 4 && a.g < b.g && a.g > b.g / 4;
    }
  EXPECT_GT(darker, 100);
}

TEST_P(RendererTest, anySizeIsDrawn) {
  const Scene scene = smallScene(3);
  for (const auto& [width, height] : {std::pair{1u, 1u}, {1u, 37u}, {333u, 2u}, {67u, 45u}}) {
    Stage stage(device(), scene, width, height);
    stage.tick(1);
    EXPECT_EQ(stage.draw(viewOf(scene, stage.crowd, 0)).rgba.size(), size_t(width) * height * 4);
  }
}

TEST_P(RendererTest, strangeViewsAreDrawn) {
  Stage stage(device(), smallScene(5), 64, 48);
  stage.tick(1);
  for (const View& view :
       {View{.eye = {1, 2, 3}, .target = {1, 2, 3}}, View{.eye = {0, 30, 0}, .target = {0, 0, 0}},
        View{.eye = {0, -50, 0}, .target = {0, 0, 1}}, View{.eye = {0, 900, 0}, .target = {9, 0, 0}},
        View{.eye = {3900, 20, 3900}, .target = {0, 0, 0}}})
    EXPECT_NO_THROW(stage.draw(view));
}

TEST_P(RendererTest, impossibleSizesAreRefused) {
  const Scene scene = smallScene(0);
  const Heightfield terrain = scene.loadTerrain();
  const Crowd crowd(device(), terrain, scene);
  const auto faultOf = [&](uint32_t width, uint32_t height, Error::Kind kind) -> std::string {
    try {
      Renderer(device(), crowd, width, height);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), kind);
      return error.what();
    }
    return "no error";
  };
  const uint32_t most = device().report().limits.maxImageDimension2D;
  EXPECT_THAT(faultOf(0, 10, Error::Kind::input), HasSubstr("0 x 10"));
  EXPECT_THAT(faultOf(most + 1, 10, Error::Kind::device), HasSubstr(std::to_string(most)));
  EXPECT_THAT(faultOf(10, 4000000000u, Error::Kind::device), HasSubstr("4000000000"));
}

// Many records pages, so that agents of all of them are drawn.
TEST_P(RendererTest, pagingChangesNothing) {
  const Scene scene = smallScene(100);
  const Heightfield terrain = scene.loadTerrain();
  std::vector<Picture> pictures;
  for (const uint32_t pageAgents : {0u, 9u}) {
    CrowdOptions options;
    options.pageAgents = pageAgents;
    Crowd crowd(device(), terrain, scene, options);
    Renderer renderer(device(), crowd, 200, 120);
    gpu::submitAndWait(context(), [&](vk::CommandBuffer cmd) {
      crowd.record(cmd, 1.0f / 60);
      renderer.record(cmd, viewOf(scene, crowd, 0));
    });
    pictures.push_back({200, 120, renderer.download()});
  }
  EXPECT_EQ(differing(pictures[0], pictures[1]), 0u);
}

}  // namespace
}  // namespace skitter::test
