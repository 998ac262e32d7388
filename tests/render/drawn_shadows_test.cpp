#include "render/pictures.h"
#include "render/shadow.h"

namespace skitter::test {
namespace {

// Beside a foot, on the side of the sun, where its shadow does not fall and away from the leg. On level
// ground, where clips have their feet, too.
TEST_P(RendererTest, feetDarkenTheGroundThatTheyTouchAndNoOther) {
  const uint32_t width = 480, height = 480;
  const Heightfield level = groundOf(129, 129, [](float, float) { return 0.0f; });
  for (const Controller controller : {Controller::adaptive, Controller::clip}) {
    SCOPED_TRACE(nameOf(controller));
    Scene scene = smallScene(1);
    scene.herds[0].controller = controller;
    scene.herds[0].spawn = {.kind = Spawn::Kind::grid, .spacing = 2, .centre = {3, 5}, .heading = 2.1f};
    scene.herds[0].goal = {.kind = Goal::Kind::none, .target = {0, 0}, .speed = 0};
    const Heightfield ground = controller == Controller::adaptive ? scene.loadTerrain() : level;
    Stage stage(device(), scene, ground, width, height),
        empty(device(), smallScene(0), ground, width, height);
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

// Places are stored by tiles of 16 m. Below clouds, agents across the edge of the eye's tile darken as much
// ground as agents within it.
TEST_P(RendererTest, tilesDoNotShowInContacts) {
  const Heightfield ground = groundOf(257, 257, [](float, float) { return 0.0f; });
  Scene scene = smallScene(4), none = smallScene(0);
  scene.light.sky = none.light.sky = Sky::overcast;
  scene.herds[0].goal.kind = Goal::Kind::none;
  const auto darkenedAt = [&](const glm::vec2& place) {
    scene.herds[0].spawn = {.kind = Spawn::Kind::grid, .spacing = 1.5f, .centre = place, .heading = 0.5f};
    Stage stage(device(), scene, ground, 400, 400), empty(device(), none, ground, 400, 400);
    stage.tick(2);
    const View view{.eye = {place.x, 4, place.y - 3}, .target = {place.x, 0, place.y}};
    return darkness(stage.draw(view), empty.draw(view)).pixels;
  };
  const int within = darkenedAt({8, 8}), across = darkenedAt({8, 16});
  EXPECT_GT(within, 8000);
  EXPECT_NEAR(across, within, within / 30);
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

// Texels along a cascade follow the pixels that are shaded, in whole squares of 64.
TEST_P(RendererTest, theShadowMapIsAsFineAsThePicture) {
  EXPECT_EQ(render::ShadowMap(context(), 720, 1).texels(), 2048u);
  EXPECT_EQ(render::ShadowMap(context(), 720, 0.5f).texels(), 1024u);
  EXPECT_EQ(render::ShadowMap(context(), 720, 0.667f).texels(), 1408u);
  EXPECT_EQ(render::ShadowMap(context(), 1441, 0.25f).texels(), 1024u);
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

}  // namespace
}  // namespace skitter::test
