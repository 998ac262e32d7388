#include "skitter/renderer.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "gpu/submit.h"
#include "render/mesh.h"
#include "skitter/records.h"
#include "support/gpu_fixture.h"
#include "support/image_bytes.h"

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
      : Stage(device, s, s.loadTerrain(), width, height) {}
  Stage(Device& device, const Scene& s, const Heightfield& ground, uint32_t width, uint32_t height)
      : scene(s),
        terrain(ground),
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

TEST_P(RendererTest, lightIsTheScenes) {
  const View view{.eye = {0, 6, -20}, .target = {0, 2, 0}};
  const auto drawn = [&](const Light& light) {
    Scene scene = smallScene(0);
    scene.light = light;
    return Stage(device(), scene, 160, 90).draw(view);
  };
  const auto lightness = [](const glm::dvec3& c) { return 0.21 * c.r + 0.72 * c.g + 0.07 * c.b; };
  const Picture day = drawn({}), overcast = drawn({.sky = Sky::overcast}),
                evening = drawn({.sky = Sky::evening}), night = drawn({.sky = Sky::night});
  const auto skyOf = [](const Picture& p) { return p.mean(0, 8); };
  const auto groundOf = [](const Picture& p) { return p.mean(70, 89); };
  // Grey clouds, a red evening, and a night that is dark and blue, but not black.
  EXPECT_LT(std::abs(skyOf(overcast).b - skyOf(overcast).r), 12);
  EXPECT_GT(skyOf(day).b, skyOf(day).r + 15);
  EXPECT_GT(skyOf(evening).r, skyOf(evening).b + 8);
  EXPECT_GT(skyOf(night).b, skyOf(night).r + 15);
  EXPECT_GT(groundOf(evening).r / groundOf(evening).b, 1.1 * groundOf(day).r / groundOf(day).b);
  EXPECT_LT(groundOf(overcast).r / groundOf(overcast).b, groundOf(day).r / groundOf(day).b);
  EXPECT_LT(lightness(skyOf(night)), 0.6 * lightness(skyOf(day)));
  EXPECT_LT(lightness(groundOf(night)), 0.6 * lightness(groundOf(day)));
  EXPECT_GT(lightness(groundOf(night)), 15);
  // Exposure and fog count where they are given.
  EXPECT_GT(lightness(groundOf(drawn({.exposure = 2}))), lightness(groundOf(day)) + 15);
  EXPECT_GT(differing(drawn({.fog = 20}), day), size_t{160 * 90 / 3});
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

// Equal herds share pages. They are drawn where herds that differ are, in other shades alone.
TEST_P(RendererTest, equalHerdsAreWhereOthersAre) {
  Scene scene = smallScene(3);
  scene.herds[0].spawn = {.kind = Spawn::Kind::grid, .spacing = 3, .centre = {-6, 0}};
  scene.herds[0].goal.kind = Goal::Kind::none;
  scene.herds.resize(2, scene.herds[0]);
  scene.herds[1].agents = 4;
  scene.herds[1].spawn.centre = {6, 0};
  Scene differ = scene;
  differ.herds[1].keys = 5;  // which its controller does not read
  Stage equal(device(), scene, 320, 180), other(device(), differ, 320, 180);
  Stage none(device(), smallScene(0), 320, 180);
  const View view{.eye = {0, 9, -16}, .target = {0, 1, 0}};
  equal.tick(1);
  other.tick(1);
  const Picture ground = none.draw(view), equals = equal.draw(view), others = other.draw(view);
  // Pixels of the left herd, of the right one, and those that only one picture has of an agent.
  int left = 0, right = 0, odd = 0;
  for (int y = 0; y < 180; ++y)
    for (int x = 0; x < 320; ++x) {
      const bool here = equals.at(x, y) != ground.at(x, y), there = others.at(x, y) != ground.at(x, y);
      (x < 160 ? left : right) += here && there;
      odd += here != there;
    }
  EXPECT_GT(left, 300);
  EXPECT_GT(right, 300);
  EXPECT_LT(odd, (left + right) / 50);
}

// Ground of half a metre a sample, its first sample where noise of as many columns and rows has it.
Heightfield groundOf(uint32_t columns, uint32_t rows, const std::function<float(float, float)>& heightOf) {
  Heightfield field{
      .name = "made", .columns = columns, .rows = rows, .spacingX = 0.5f, .spacingZ = 0.5f, .heights = {}};
  for (uint32_t z = 0; z < rows; ++z)
    for (uint32_t x = 0; x < columns; ++x) field.heights.push_back(heightOf(float(x), float(z)));
  return field;
}

// A herd's colour and tint change its own pixels, and those of no other herd of its kind.
TEST_P(RendererTest, aHerdHasTheColourThatItsSceneSays) {
  for (const Controller controller : {Controller::adaptive, Controller::clip}) {
    Scene scene = smallScene(3);
    scene.herds[0].controller = controller;
    scene.herds[0].spawn = {.kind = Spawn::Kind::grid, .spacing = 3, .centre = {6, 0}};
    scene.herds[0].goal.kind = Goal::Kind::none;
    scene.herds.resize(2, scene.herds[0]);
    scene.herds[1].spawn.centre = {-6, 0};
    const View view{.eye = {0, 9, -16}, .target = {0, 1, 0}};
    const auto drawn = [&](const std::function<void(Herd&)>& change) {
      Scene changed = scene;
      change(changed.herds[0]);
      Stage stage(device(), changed, 320, 180);
      stage.tick(1);
      return stage.draw(view);
    };
    Stage none(device(), smallScene(0), 320, 180);
    const Picture ground = none.draw(view), plain = drawn([](Herd&) {});
    const Picture blue = drawn([](Herd& herd) { herd.colour = glm::vec3(0.02f, 0.05f, 0.8f); });
    const Picture alike = drawn([](Herd& herd) { herd.tint = 0; });
    // +X, where the first herd is, is to the left of who looks along +Z.
    glm::dvec3 sum(0), was(0);
    int pixels = 0, otherwise = 0, varied = 0;
    for (int y = 0; y < 180; ++y)
      for (int x = 0; x < 320; ++x) {
        if (x >= 160) {
          EXPECT_EQ(blue.at(x, y), plain.at(x, y)) << x << ", " << y;
          EXPECT_EQ(alike.at(x, y), plain.at(x, y)) << x << ", " << y;
        } else if (plain.at(x, y) != ground.at(x, y)) {
          ++pixels;
          varied += alike.at(x, y) != plain.at(x, y);
          if (blue.at(x, y) == plain.at(x, y)) continue;  // a shadow
          ++otherwise;
          sum += glm::dvec3(blue.at(x, y));
          was += glm::dvec3(plain.at(x, y));
        }
      }
    ASSERT_GT(pixels, 200);
    EXPECT_GT(otherwise, pixels / 3);
    EXPECT_GT(varied, pixels / 4);
    EXPECT_GT(sum.b / sum.r, 1.3 * was.b / was.r);
  }
}

// The spider in white with a blue texture, its material changed.
Rig blueSpider(const std::function<void(Material&)>& change, float opacity) {
  Rig rig = spiderRig();
  auto materials = std::make_shared<Materials>();
  Material& material = materials->list.emplace_back();
  materials->images = {
      pngFile(texelsOf(4, 4, [](uint32_t, uint32_t) { return glm::ivec4(20, 60, 250, 255); }))};
  material.texture(TextureRole::baseColour).image = 0;
  material.metallic = 0;
  change(material);
  rig.look.materials = materials;
  rig.look.vertices.resize(rig.vertices.size());
  for (size_t v = 0; v < rig.vertices.size(); ++v) {
    rig.vertices[v].colour = glm::vec3(0.8f);
    rig.look.vertices[v].opacity = opacity;
  }
  return rig;
}

// A texture colours the creatures that wear it, and what a mask leaves out is not there at all, nor is its
// shadow.
TEST_P(RendererTest, texturesAndMasksShow) {
  Scene scene = smallScene(3);
  scene.herds[0].spawn = {.kind = Spawn::Kind::grid, .spacing = 3, .centre = {0, 0}};
  scene.herds[0].goal.kind = Goal::Kind::none;
  const Heightfield ground = scene.loadTerrain();
  const View view{.eye = {0, 6, -11}, .target = {0, 1, 0}};
  const auto drawn = [&](const std::function<void(Material&)>& change, float opacity) {
    Crowd crowd(device(), ground, scene, {.rigs = {blueSpider(change, opacity)}});
    Renderer renderer(device(), crowd, 320, 180);
    gpu::submitAndWait(context(), [&](vk::CommandBuffer cmd) { crowd.record(cmd, 1.0f / 60); });
    for (int frame = 0; frame < 2; ++frame)  // the counts of agents are copied anew for each
      gpu::submitAndWait(context(), [&](vk::CommandBuffer cmd) { renderer.record(cmd, view); });
    EXPECT_TRUE(renderer.notes().empty());
    return Picture{320, 180, renderer.download()};
  };
  Stage none(device(), smallScene(0), 320, 180), plain(device(), scene, 320, 180);
  plain.tick(1);
  const Picture bare = none.draw(view), usual = plain.draw(view), blue = drawn([](Material&) {}, 1);
  int pixels = 0, odd = 0;
  for (int y = 0; y < 180; ++y)
    for (int x = 0; x < 320; ++x) {
      const bool here = usual.at(x, y) != bare.at(x, y), there = blue.at(x, y) != bare.at(x, y);
      pixels += here;
      odd += here != there;
    }
  const auto bluerIn = [&](const Picture& picture) {
    int count = 0;
    for (int y = 0; y < 180; ++y)
      for (int x = 0; x < 320; ++x)
        count += picture.at(x, y) != bare.at(x, y) && picture.at(x, y).b > picture.at(x, y).r + 40;
    return count;
  };
  const int bluer = bluerIn(blue);
  EXPECT_GT(pixels, 500);
  EXPECT_LT(odd, pixels / 20) << "the same shape";
  EXPECT_GT(bluer, pixels / 10);
  const auto cut = [](Material& m) { m.alphaCutoff = 0.5f; };
  EXPECT_EQ(differing(drawn(cut, 0.75f), blue), 0u) << "all is more opaque than the cutoff";
  // Bodies are gone. Legs are ribbons from here, which have no texture and no holes.
  const Picture holes = drawn(cut, 0.25f);
  EXPECT_LT(differing(holes, bare), differing(blue, bare));
  EXPECT_LT(bluerIn(holes), 0.95 * bluer);
}

// A creature of size 2 is drawn twice as large.
// Beside a foot, on the side of the sun, where its shadow does not fall and away from the leg.
TEST_P(RendererTest, feetDarkenTheGroundThatTheyTouchAndNoOther) {
  const uint32_t width = 480, height = 480;
  Scene scene = smallScene(1);
  scene.herds[0].spawn = {.kind = Spawn::Kind::grid, .spacing = 2, .centre = {3, 5}, .heading = 2.1f};
  scene.herds[0].goal = {.kind = Goal::Kind::none, .target = {0, 0}, .speed = 0};
  Stage stage(device(), scene, width, height), empty(device(), smallScene(0), width, height);
  stage.tick(60);
  const HerdState state = stage.crowd.download(0);
  const glm::vec3 body = bodyOf(state);
  const View view{.eye = body + glm::vec3(0, 3.5f, -0.5f), .target = body};
  const Picture with = stage.draw(view), without = empty.draw(view);
  const auto lightnessAt = [&](const Picture& picture, glm::vec2 at) {
    const float y = stage.terrain.seenAt(at.x, at.y);
    const glm::vec2 pixel = pixelOf(view, {at.x, y, at.y}, width, height);
    const glm::ivec3 c = picture.at(int(pixel.x), int(pixel.y));
    return double(c.r + c.g + c.b);
  };
  const glm::vec2 sunward = glm::normalize(glm::vec2(0.62f, 0.40f));
  int judged = 0;
  for (int leg = 0; leg < stage.crowd.rig(0).legCount(); ++leg) {
    const float* tip = &state.tip[size_t(leg) * 4];
    const glm::vec2 out = glm::normalize(glm::vec2(tip[0], tip[2]));
    if (glm::dot(out, sunward) < 0.3f) continue;
    const glm::vec2 foot(body.x + tip[0], body.z + tip[2]);
    ++judged;
    EXPECT_LT(lightnessAt(with, foot + 0.04f * out), 0.9 * lightnessAt(without, foot + 0.04f * out))
        << "leg " << leg;
    EXPECT_EQ(lightnessAt(with, foot + 0.25f * out), lightnessAt(without, foot + 0.25f * out))
        << "leg " << leg;
  }
  EXPECT_GE(judged, 2);
}

TEST_P(RendererTest, sizesShow) {
  Scene scene = smallScene(1);
  scene.herds[0].spawn.kind = Spawn::Kind::grid;
  scene.herds[0].goal.kind = Goal::Kind::none;
  const Heightfield flat = groundOf(129, 129, [](float, float) { return 0.0f; });
  const View view{.eye = {0, 12, -16}, .target = {0, 0.5f, 0}};
  const auto pixels = [&](std::vector<float> sizes) {
    scene.herds[0].sizes = std::move(sizes);
    Scene empty = scene;
    empty.herds[0].agents = 0;
    Stage stage(device(), scene, flat, 320, 180), none(device(), empty, flat, 320, 180);
    stage.tick(1);
    return double(differing(stage.draw(view), none.draw(view)));
  };
  const double small = pixels({1}), large = pixels({2});
  EXPECT_GT(small, 100);
  EXPECT_GT(large, 2.5 * small);
  EXPECT_LT(large, 5 * small);
}

// A disc of 2 m is drawn where it stands, its shadow falls away from the sun, and the rest is as without it.
TEST_P(RendererTest, obstaclesStandOnTheGroundAndCastShadows) {
  const Heightfield flat = groundOf(129, 129, [](float, float) { return 3.0f; });
  Scene scene = smallScene(0), without = scene;
  scene.obstacles = {{Disc{.centre = {1, -2}, .radius = 2}}};
  Stage stage(device(), scene, flat, 200, 200), empty(device(), without, flat, 200, 200);
  const View view{.eye = {1, 23, -2.01f}, .target = {1, 3, -2}, .fieldOfView = 0.8f};
  const Picture with = stage.draw(view), none = empty.draw(view);
  const auto at = [&](const Picture& picture, const glm::vec2& from) {  // from the disc's middle
    const glm::vec2 pixel = pixelOf(view, {1 + from.x, 3, -2 + from.y}, 200, 200);
    return picture.at(int(pixel.x), int(pixel.y));
  };
  const glm::vec2 sunward = glm::normalize(glm::vec2(0.62f, 0.40f));
  EXPECT_NE(at(with, {0, 0}), at(none, {0, 0}));
  EXPECT_LT(at(with, -2.3f * sunward).g, 0.8f * float(at(none, -2.3f * sunward).g));
  int beside = 0;
  for (float angle = 0; angle < 6.28f; angle += 0.1f) {
    const glm::vec2 way(std::cos(angle), std::sin(angle));
    // Smoothed edges reach a pixel further, and the wall's top a tenth, for it is nearer to the eye.
    if (glm::dot(way, sunward) > 0) {
      EXPECT_EQ(at(with, 2.6f * way), at(none, 2.6f * way)) << angle;
    }
    EXPECT_EQ(at(with, 3.6f * way), at(none, 3.6f * way)) << angle;
    beside += at(with, 1.5f * way) != at(none, 1.5f * way);
  }
  EXPECT_GT(beside, 55);
}

// A wall is where the ground takes it, and no longer where it was.
TEST_P(RendererTest, obstaclesFollowTheGround) {
  const Heightfield flat = groundOf(129, 129, [](float, float) { return 0.0f; });
  Scene scene = smallScene(0), without = scene;
  scene.obstacles = {{Capsule{.from = {-3, 0}, .to = {3, 0}, .radius = 0.3f}}};
  Stage stage(device(), scene, flat, 200, 120), empty(device(), without, flat, 200, 120);
  const View view{.eye = {0, 5, -9}, .target = {0, 1, 0}};
  const auto showsAt = [&](float height) {  // half way up the wall's side that is toward the eye
    const glm::ivec2 pixel(pixelOf(view, {0, height + 0.37f, -0.3f}, 200, 120));
    return stage.draw(view).at(pixel.x, pixel.y) != empty.draw(view).at(pixel.x, pixel.y);
  };
  EXPECT_TRUE(showsAt(0));
  EXPECT_FALSE(showsAt(2));
  const std::vector<float> hill(33 * 33, 2);
  for (Stage* each : {&stage, &empty}) {
    each->crowd.editHeights(48, 48, 33, 33, hill);
    each->tick(1);
  }
  EXPECT_TRUE(showsAt(2));
  EXPECT_FALSE(showsAt(0));
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

// How much neighbouring pixels differ, to the right and downwards.
glm::dvec2 roughness(const Picture& picture) {
  glm::dvec2 sum(0);
  for (int y = 0; y + 1 < int(picture.height); ++y)
    for (int x = 0; x + 1 < int(picture.width); ++x)
      sum += glm::dvec2(std::abs(picture.at(x + 1, y).g - picture.at(x, y).g),
                        std::abs(picture.at(x, y + 1).g - picture.at(x, y).g));
  return sum / double(picture.width * picture.height);
}

// A wall of 76 degrees, seen at a right angle: detail is as long along the slope as across it.
TEST_P(RendererTest, groundIsAsDetailedOnAWallAsAcrossIt) {
  const Heightfield wall = groundOf(65, 65, [](float x, float) { return -2.0f * x; });
  Stage stage(device(), smallScene(0), wall, 200, 200);
  const glm::vec3 outward = glm::normalize(glm::vec3(4, 1, 0)), middle(0, -64, 0);
  for (const float distance : {1.5f, 4.0f}) {
    const glm::dvec2 rough =
        roughness(stage.draw({.eye = middle + distance * outward, .target = middle, .fieldOfView = 0.8f}));
    EXPECT_GT(rough.x, 0.5) << distance;
    EXPECT_NEAR(rough.y / rough.x, 1, 0.3) << distance;
  }
}

// Beyond its edge the terrain goes on as a terrain would that is its own mirror image.
TEST_P(RendererTest, groundGoesOnMirroredBeyondItsEdge) {
  const auto hills = [](float x, float z) {
    return 2.5f * std::sin(0.31f * x + 0.2f * z) + 1.5f * std::sin(0.17f * z - 0.4f * x);
  };
  const Heightfield half = groundOf(65, 65, hills);
  const Heightfield whole =
      groundOf(65, 129, [&](float x, float z) { return hills(x, z < 64 ? z : 128 - z); });
  Stage edged(device(), smallScene(0), half, 200, 120), going(device(), smallScene(0), whole, 200, 120);
  const glm::vec3 shift(half.originX() - whole.originX(), 0, half.originZ() - whole.originZ());
  const View view{.eye = {2, 9, 4}, .target = {0, 1, 20}};  // the edge is at z = 16
  const Picture mirrored = edged.draw(view),
                expected = going.draw({.eye = view.eye - shift, .target = view.target - shift});
  double apart = 0;
  for (size_t i = 0; i < mirrored.rgba.size(); ++i) apart += std::abs(mirrored.rgba[i] - expected.rgba[i]);
  // The hills' own shadows differ: a mirror image casts none.
  EXPECT_LT(apart / double(mirrored.rgba.size()), 3);
}

// Timed, crowd, ground and sky are drawn one rendering after the other instead of in one.
TEST_P(RendererTest, timingAPictureDoesNotChangeIt) {
  Stage stage(device(), smallScene(40), 200, 120);
  stage.tick(1);
  const View view = viewOf(stage.scene, stage.crowd, 0);
  const Picture plain = stage.draw(view);
  EXPECT_TRUE(stage.renderer.stageTimes().empty());
  stage.renderer.timeStages(true);
  EXPECT_EQ(differing(plain, stage.draw(view)), 0u);
  if (!context().timestamps()) return;
  std::vector<std::string> passes;
  for (const StageTime& time : stage.renderer.stageTimes()) {
    passes.push_back(time.stage);
    EXPECT_GE(time.milliseconds, 0) << time.stage;
  }
  passes.resize(6);  // edges are smoothed by a pass only where there are no samples to resolve
  EXPECT_THAT(passes, ::testing::ElementsAre("cull", "splats", "shadow", "crowd", "ground", "sky"));
}

TEST_P(RendererTest, whatIsDrawnOverKeepsThePictureAroundIt) {
  Stage stage(device(), smallScene(20), 200, 120);
  stage.tick(1);
  const View view = viewOf(stage.scene, stage.crowd, 0);
  const Picture without = stage.draw(view);
  const auto red = [](VkCommandBuffer cmd) {
    const vk::ClearAttachment colour{.aspectMask = vk::ImageAspectFlagBits::eColor,
                                     .clearValue = {vk::ClearColorValue(std::array{1.0f, 0.0f, 0.0f, 1.0f})}};
    vk::CommandBuffer(cmd).clearAttachments(colour, vk::ClearRect{{{10, 20}, {30, 40}}, 0, 1});
  };
  gpu::submitAndWait(stage.context, [&](vk::CommandBuffer cmd) { stage.renderer.record(cmd, view, red); });
  const Picture with{200, 120, stage.renderer.download()};
  EXPECT_EQ(differing(without, with), 30u * 40u);
  EXPECT_EQ(with.at(10, 20), glm::ivec3(255, 0, 0));
  EXPECT_EQ(with.at(39, 59), glm::ivec3(255, 0, 0));
}

// Pixels that are darker than without agents, though no agent is that dark, and how dark their median is.
struct Darkness {
  int pixels = 0;
  double share = 1;
};
Darkness darkness(const Picture& with, const Picture& without) {
  std::vector<double> shares;
  for (uint32_t y = 0; y < with.height; ++y)
    for (uint32_t x = 0; x < with.width; ++x) {
      const glm::ivec3 a = with.at(int(x), int(y)), b = without.at(int(x), int(y));
      if (a.r < b.r - 15 && a.r > b.r / 4 && a.g < b.g && a.g > b.g / 4) shares.push_back(double(a.g) / b.g);
    }
  if (shares.empty()) return {};
  std::nth_element(shares.begin(), shares.begin() + shares.size() / 2, shares.end());
  return {int(shares.size()), shares[shares.size() / 2]};
}

// Shadows are part of what ties a foot to the ground: there must be some, darker than the ground without.
TEST_P(RendererTest, agentsCastShadows) {
  Stage stage(device(), smallScene(1), 160, 160), empty(device(), smallScene(0), 160, 160);
  stage.tick(1);
  const glm::vec3 body = bodyOf(stage.crowd.download(0));
  const View above{.eye = body + glm::vec3(0, 7, -0.1f), .target = body, .fieldOfView = 0.9f};
  EXPECT_GT(darkness(stage.draw(above), empty.draw(above)).pixels, 100);
}

// Where nobody casts a shadow, the map is emptied once. Who comes casts one, and none is left of who goes.
TEST_P(RendererTest, shadowsComeAndGoWithTheirHerd) {
  Scene one = smallScene(1);
  one.herds[0].goal.kind = Goal::Kind::none;
  one.herds[0].keys = 5;  // which its controller does not read: a kind of its own, so that it can go
  Stage always(device(), one, 160, 160), never(device(), smallScene(0), 160, 160);
  Stage stage(device(), smallScene(0), 160, 160);
  always.tick(1);
  const glm::vec3 body = bodyOf(always.crowd.download(0));
  const View above{.eye = body + glm::vec3(0, 7, -0.1f), .target = body, .fieldOfView = 0.9f};
  const Picture empty = never.draw(above);
  EXPECT_EQ(differing(stage.draw(above), empty), 0u);
  const HerdId guest = stage.crowd.addHerd(one.herds[0]);
  stage.tick(1);
  EXPECT_GT(darkness(stage.draw(above), empty).pixels, 100);
  // Whose shadow is out of sight changes nothing, though ground is then drawn in a form that looks for
  // shadows.
  const View aside{.eye = body + glm::vec3(14, 5, 14), .target = body + glm::vec3(20, 0, 20)};
  EXPECT_EQ(differing(stage.draw(aside), never.draw(aside)), 0u);
  stage.crowd.removeHerd(guest);
  for (int frame = 0; frame < 2; ++frame) EXPECT_EQ(differing(stage.draw(above), empty), 0u) << frame;
}

// From afar and from near, and across the light, along which the cascades end where the eye is.
TEST_P(RendererTest, shadowsAreAsDarkFromAnyDistance) {
  Stage stage(device(), smallScene(1), 160, 160), empty(device(), smallScene(0), 160, 160);
  stage.tick(1);
  const glm::vec3 body = bodyOf(stage.crowd.download(0));
  Darkness first;
  for (const float distance : {2.0f, 2.8f, 4.0f, 5.6f, 8.0f}) {
    const View view{
        .eye = body + distance * glm::vec3(-0.7f, 0.7f, 0), .target = body, .fieldOfView = 2.0f / distance};
    const Darkness found = darkness(stage.draw(view), empty.draw(view));
    if (first.pixels == 0) first = found;
    EXPECT_NEAR(found.share, first.share, 0.05) << "from " << distance << " m";
    EXPECT_NEAR(found.pixels, first.pixels, 0.15 * first.pixels) << "from " << distance << " m";
  }
  EXPECT_GT(first.pixels, 1000);
}

// In how many parts, of pixels that touch each other, two pictures differ.
int partsThatDiffer(const Picture& a, const Picture& b) {
  const auto width = int(a.width), height = int(a.height);
  std::vector<char> open(size_t(width * height));
  for (size_t i = 0; i < open.size(); ++i) {
    const auto apart = [&](size_t c) { return std::abs(a.rgba[4 * i + c] - b.rgba[4 * i + c]); };
    open[i] = apart(0) + apart(1) + apart(2) > 8;
  }
  int parts = 0;
  for (int start = 0; start < width * height; ++start) {
    if (!open[size_t(start)]) continue;
    ++parts;
    std::vector<int> reached{start};
    open[size_t(start)] = false;
    while (!reached.empty()) {
      const int x = reached.back() % width, y = reached.back() / width;
      reached.pop_back();
      for (int v = std::max(y - 1, 0); v <= std::min(y + 1, height - 1); ++v)
        for (int u = std::max(x - 1, 0); u <= std::min(x + 1, width - 1); ++u)
          if (open[size_t(v * width + u)]) {
            open[size_t(v * width + u)] = false;
            reached.push_back(v * width + u);
          }
    }
  }
  return parts;
}

// However few pixels an agent has, its legs hang on it. From so far away that shadows have faded.
TEST_P(RendererTest, thinLegsAreDrawnInOnePiece) {
  // Without the sun's highlights no band of a leg has the colour of the ground.
  Scene one = smallScene(1), none = smallScene(0);
  one.light.sky = none.light.sky = Sky::overcast;
  for (const uint32_t size : {900u, 600u, 450u, 330u, 160u}) {  // 22 to 125 mm a pixel
    Stage stage(device(), one, size, size), empty(device(), none, size, size);
    stage.tick(30);
    const glm::vec3 body = bodyOf(stage.crowd.download(0));
    const View view{
        .eye = body + 2000.0f * glm::vec3(0.1f, 0.7f, 0.7f), .target = body, .fieldOfView = 0.01f};
    EXPECT_EQ(partsThatDiffer(stage.draw(view), empty.draw(view)), 1) << size;
  }
}

// Pixels that an agent covers at levels of detail that follow each other, either side of where they change,
// and their colour.
TEST_P(RendererTest, levelsOfDetailLookAlike) {
  constexpr uint32_t size = 320;
  Stage stage(device(), smallScene(1), size, size), empty(device(), smallScene(0), size, size);
  stage.tick(30);
  const glm::vec3 body = bodyOf(stage.crowd.download(0));
  const double radius = render::makeMesh(stage.crowd.rig(0)).radius;
  struct Seen {
    double pixels;
    glm::dvec3 colour;  // the mean, codes of sRGB
  };
  const auto seen = [&](double pixels) {
    // From so far away that shadows have faded.
    const double away = 2000, fieldOfView = 2 * std::atan(0.5 * size * radius / (pixels * away));
    const View view{.eye = body + float(away) * glm::normalize(glm::vec3(0.1f, 0.5f, 0.7f)),
                    .target = body,
                    .fieldOfView = float(fieldOfView)};
    const Picture with = stage.draw(view), without = empty.draw(view);
    Seen sum{double(differing(with, without)), glm::dvec3(0)};
    for (int y = 0; y < int(size); ++y)
      for (int x = 0; x < int(size); ++x)
        if (with.at(x, y) != without.at(x, y)) sum.colour += glm::dvec3(with.at(x, y)) / sum.pixels;
    return sum;
  };
  for (size_t level = 0; level < render::kLodPixels.size(); ++level) {
    const Seen finer = seen(1.01 * render::kLodPixels[level]),
               coarser = seen(0.99 * render::kLodPixels[level]);
    // The coarser one is drawn 2 % smaller, so covers 4 % less.
    EXPECT_NEAR(coarser.pixels / finer.pixels, 0.96, 0.1)
        << "level " << level << " covers " << finer.pixels << " pixels";
    // What the hash of their numbers makes of neighbours is about six times as much.
    EXPECT_LT(glm::distance(coarser.colour, finer.colour), 9)
        << "level " << level << ": " << finer.colour.x << " " << finer.colour.y << " " << finer.colour.z
        << ", then " << coarser.colour.x << " " << coarser.colour.y << " " << coarser.colour.z;
  }
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
