#include "render/pictures.h"

namespace skitter::test {
namespace {

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

// The same slopes with samples eight times as dense, which vertices are not. They bend little: how open
// ground is to the sky depends on its samples.
TEST_P(RendererTest, groundLooksTheSameWhoeverLooksItUp) {
  const auto hills = [](float x, float z) { return 0.2f * (x - 64) + std::sin(0.05f * z); };
  const Heightfield coarse = groundOf(129, 129, hills);
  Heightfield dense = groundOf(1025, 1025, [&](float x, float z) { return hills(x / 8, z / 8); });
  dense.spacingX = dense.spacingZ = coarse.spacingX / 8;
  Stage byVertex(device(), smallScene(0), coarse, 320, 180),
      byPixel(device(), smallScene(0), dense, 320, 180);
  const View view{.eye = {0, 9, -14}, .target = {0, 1, 0}};
  const Picture a = byVertex.draw(view), b = byPixel.draw(view);
  double apart = 0;
  for (size_t i = 0; i < a.rgba.size(); ++i) apart += std::abs(a.rgba[i] - b.rgba[i]);
  EXPECT_LT(apart / double(a.rgba.size()), 0.25);
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

}  // namespace
}  // namespace skitter::test
