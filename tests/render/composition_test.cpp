// How far a picture reaches, held against docs/stages/pictures.md and the geometry of its view.
#include "render/composition.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "render/sight.h"

namespace skitter::render {
namespace {

using test::Sight;

constexpr uint32_t kTexels = 2048;
constexpr float kLowest = -3, kHighest = 40;

const glm::dvec3 kTowardsSun = glm::normalize(glm::dvec3(0.62, 0.62, 0.40));

struct Case {
  View view;
  uint32_t width = 640, height = 360;
};
// From near to far from the target, narrow and wide, on both sides of the origin.
const std::array kCases{
    Case{{.eye = {3, 4, -8}, .target = {3.5f, 3.8f, -7}, .fieldOfView = 0.8f}},
    Case{{.eye = {-203, 12, 517}, .target = {-190, 3, 530}, .fieldOfView = 0.9f}},
    Case{{.eye = {3900, 60, -3800}, .target = {3820, 20, -3700}, .fieldOfView = 0.4f}, 300, 500},
    Case{{.eye = {40, 90, 10}, .target = {0, -2, 1}, .fieldOfView = 1.9f}},
    Case{{.eye = {-700, 300, 80}, .target = {-200, 0, 90}, .fieldOfView = 0.8f}},
};

Composition composed(const Case& c) {
  const Heightfield field{
      .name = "flat", .columns = 2, .rows = 2, .spacingX = 9, .spacingZ = 9, .heights = {0, 0, 0, 0}};
  return compose(c.view, lightModel({}), field, kLowest, kHighest, c.width, c.height, kTexels);
}

double reachOf(const Case& c, int cascade) {
  const double toTarget = glm::distance(glm::dvec3(c.view.eye), glm::dvec3(c.view.target));
  return std::clamp(1.9 * toTarget, 4.0, 400.0) * (cascade == 0 ? 1 : 4.5);
}
// The smallest sphere about the eye and the picture's corners `reach` ahead: its centre's depth, and its
// radius.
struct Sphere {
  double depth, radius;
};
Sphere sphereOf(const Sight& s, double reach) {
  const double spread = std::hypot(s.tanX, s.tanY);
  if (spread >= 1) return {reach, reach * spread};
  const double radius = 0.5 * reach * (1 + spread * spread);
  return {radius, radius};
}

// Where a world point lies in a cascade's square: x and y -1 to 1, z 0 to 1 away from the sun.
glm::dvec3 inCascade(const Composition& c, int cascade, const glm::dvec3& p) {
  return glm::dmat4(c.block.clipFromPicture[shared::VIEW_CAMERA + 1 + cascade]) *
         glm::dvec4(p.x - c.origin.x, p.y, p.z - c.origin.y, 1);
}
double sizeOf(const Composition& c, int cascade) {  // half the square's side, metres
  return 0.5 * kTexels * double(cascade == 0 ? c.block.shadow.x : c.block.shadow.y);
}

TEST(Composition, cascadesHoldWhatIsSeenAndNotMuchMore) {
  for (const Case& each : kCases) {
    const Composition c = composed(each);
    const Sight sight(each.view, each.width, each.height);
    EXPECT_EQ(c.block.shadow.w, float(kTexels));
    for (int cascade = 0; cascade < 2; ++cascade) {
      const double reach = reachOf(each, cascade), size = sizeOf(c, cascade);
      EXPECT_NEAR(size, 1.02 * std::ceil(8 * sphereOf(sight, reach).radius) / 8, 1e-5 * size);
      std::vector<glm::dvec3> seen{sight.eye};
      for (const double x : {-1.0, 1.0})
        for (const double y : {-1.0, 1.0}) seen.push_back(sight.at(reach, x, y));
      for (const glm::dvec3& p : seen) {
        const glm::dvec3 at = inCascade(c, cascade, p);
        EXPECT_LT(std::max(std::abs(at.x), std::abs(at.y)), 1);
        // One texel is a metre's share of the square: the matrix and the texel's size agree.
        const glm::dvec3 beside =
            inCascade(c, cascade, p + glm::normalize(glm::cross(kTowardsSun, {0, 1, 0})));
        EXPECT_NEAR(glm::length(glm::dvec2(beside - at)), 1 / size, 1e-4 / size);
      }
    }
  }
}

// Whatever is up to 30 m above the sphere of what is seen casts into it, along the sunlight.
TEST(Composition, cascadesReachThirtyMetresTowardsTheSun) {
  EXPECT_LT(glm::distance(lightModel({}).towards, kTowardsSun), 1e-6);
  for (const Case& each : kCases) {
    const Composition c = composed(each);
    EXPECT_LT(glm::distance(glm::dvec3(c.block.sun), kTowardsSun), 1e-6);
    const Sight sight(each.view, each.width, each.height);
    for (int cascade = 0; cascade < 2; ++cascade) {
      const double size = sizeOf(c, cascade), range = 2 * size + 60;
      const glm::dvec3 centre = sight.eye + sight.forward * sphereOf(sight, reachOf(each, cascade)).depth;
      const glm::dvec3 middle = inCascade(c, cascade, centre);
      for (const double up : {-size, size, size + 29, size + 30}) {
        const glm::dvec3 at = inCascade(c, cascade, centre + up * kTowardsSun);
        EXPECT_NEAR(at.z, (size + 30 - up) / range, 1e-5);
        EXPECT_LT(glm::length(glm::dvec2(at - middle)), 1e-4);
      }
    }
  }
}

// A cascade's texels stay where they are on the ground when the camera turns or moves.
TEST(Composition, shadowsDoNotShimmer) {
  const Case still{{.eye = {5, 6, -8}, .target = {5, 2, 0}}};
  const Composition before = composed(still);
  for (const glm::vec3 step : {glm::vec3(0.013f, 0.02f, 0.007f), {14.3f, 0.4f, -30.1f}})
    for (const bool turned : {false, true}) {
      Case moved = still;
      moved.view.eye += step;
      moved.view.target = moved.view.eye + (turned ? glm::vec3(8, -4, 0) : glm::vec3(0, -4, 8));
      const Composition after = composed(moved);
      for (int cascade = 0; cascade < 2; ++cascade) {
        ASSERT_EQ(sizeOf(after, cascade), sizeOf(before, cascade));
        for (const glm::dvec3 p : {glm::dvec3(7, 1, -5), {9.3, 0, -9}}) {
          const glm::dvec2 texels =
              0.5 * kTexels * glm::dvec2(inCascade(after, cascade, p) - inCascade(before, cascade, p));
          // Each coordinate is a sum of four floats below 4: within 1e-6 of 1024 texels.
          EXPECT_LT(glm::length(texels - glm::round(texels)), 4e-3) << cascade;
        }
      }
    }
}

TEST(Composition, drawingEndsWhereFogHides) {
  const auto distanceOf = [](const View& view) {
    const Composition c = composed({view});
    EXPECT_EQ(c.block.tile.z, c.viewDistance);
    EXPECT_NEAR(c.block.tile.w * c.viewDistance, 2.1f, 1e-5f);
    return c.viewDistance;
  };
  EXPECT_NEAR(distanceOf({.eye = {0, 5, 0}, .target = {0, 5, 10}}), 2.1f * 95, 1e-3f);
  EXPECT_NEAR(distanceOf({.eye = {0, 5, 0}, .target = {0, 5, 40}}), 2.1f * 200, 1e-3f);
  EXPECT_NEAR(distanceOf({.eye = {0, 190, 0}, .target = {0, 190, 1}}), 2.1f * 300, 1e-3f);
  EXPECT_NEAR(distanceOf({.eye = {0, -103, 0}, .target = {0, -103, 1}}), 2.1f * 200, 1e-3f);
}

}  // namespace
}  // namespace skitter::render
