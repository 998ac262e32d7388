#include "render/mesh.h"
#include "render/pictures.h"
#include "support/image_bytes.h"
#include "support/rounding.h"

namespace skitter::test {
namespace {

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

// An agent that can lose legs is drawn as one that cannot, until it loses one.
TEST_P(RendererTest, legsThatMayBeLostAreDrawn) {
  Scene scene = smallScene(4), hurt = scene;
  for (Scene* each : {&scene, &hurt})
    each->herds[0].spawn = {.kind = Spawn::Kind::grid, .spacing = 2, .centre = {0, 0}};
  hurt.herds[0].hurt = true;
  Stage never(device(), scene, 320, 180), can(device(), hurt, 320, 180);
  const View view{.eye = {0, 4, -6}, .target = {0, 0.5f, 0}};
  never.tick(5);
  can.tick(5);
  const Picture whole = never.draw(view);
  // Other kernels move and draw it. Where they round differently, an edge may take another pixel.
  const size_t mostPixels = kernelsRoundAlike(device()) ? 0 : 320 * 180 / 200;
  EXPECT_LE(differing(whole, can.draw(view)), mostPixels);
  for (uint32_t agent = 0; agent < 4; ++agent) can.crowd.hurt(can.crowd.agentId(0, agent), 1);
  never.tick(1);
  can.tick(1);
  const size_t lost = differing(never.draw(view), can.draw(view));
  EXPECT_GT(lost, 60u);
  EXPECT_LT(lost, 320u * 180 / 8);
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
    // Four samples a pixel mix more of an agent with the ground, and shadows are among the pixels.
    EXPECT_GT(varied, device().context().isCpu() ? pixels / 4 : otherwise / 4);
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
  for (const Controller controller : {Controller::adaptive, Controller::clip, Controller::planted}) {
    one.herds[0].controller = controller;
    for (const uint32_t size : {900u, 600u, 450u, 330u, 160u}) {  // 22 to 125 mm a pixel
      Stage stage(device(), one, size, size), empty(device(), none, size, size);
      stage.tick(30);
      const glm::vec3 body = bodyOf(stage.crowd.download(0));
      const View view{
          .eye = body + 2000.0f * glm::vec3(0.1f, 0.7f, 0.7f), .target = body, .fieldOfView = 0.01f};
      EXPECT_EQ(partsThatDiffer(stage.draw(view), empty.draw(view)), 1) << nameOf(controller) << ", " << size;
    }
  }
}

// Pixels that an agent covers at levels of detail that follow each other, either side of where they change,
// and their colour.
TEST_P(RendererTest, levelsOfDetailLookAlike) {
  for (const Controller controller : {Controller::adaptive, Controller::clip}) {
    SCOPED_TRACE(nameOf(controller));
    constexpr uint32_t size = 320;
    Scene scene = smallScene(1);
    scene.herds[0].controller = controller;
    Stage stage(device(), scene, size, size), empty(device(), smallScene(0), size, size);
    stage.tick(30);
    const glm::vec3 body = bodyOf(stage.crowd.download(0));
    const double radius =
        (controller == Controller::clip ? render::makeMesh(spiderClips(), render::limbsOf(spiderClips()))
                                        : render::makeMesh(spiderRig(), render::limbsOf(spiderRig())))
            .radius;
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
      // The hash of their numbers makes neighbours differ about six times as much.
      EXPECT_LT(glm::distance(coarser.colour, finer.colour), 9)
          << "level " << level << ": " << finer.colour.x << " " << finer.colour.y << " " << finer.colour.z
          << ", then " << coarser.colour.x << " " << coarser.colour.y << " " << coarser.colour.z;
    }
  }
}

}  // namespace
}  // namespace skitter::test
