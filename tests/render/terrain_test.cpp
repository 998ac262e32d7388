#include "render/terrain.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace skitter::render {
namespace {

struct Ground {
  Heightfield field;
  float lowest, highest;
};
Ground ground() {
  Ground g{generateHeightfield({.columns = 100, .rows = 73, .spacing = 0.5f}), 0, 0};
  const auto [low, high] = std::minmax_element(g.field.heights.begin(), g.field.heights.end());
  g.lowest = *low;
  g.highest = *high;
  return g;
}
Composition composed(const Ground& g, const View& view) {
  return compose(view, g.field, g.lowest, g.highest, 640, 360, 1024);
}

TEST(Patches, doNotOverlapAndAreFineNearby) {
  const Ground g = ground();
  const Composition c = composed(g, {.eye = {3, 4, -8}, .target = {0, 0, 0}});
  const std::vector<Patch> patches = choosePatches(c, g.field, g.lowest, g.highest);
  ASSERT_GT(patches.size(), 4u);
  EXPECT_LT(patches.size(), 400u);
  float finest = 1e9f;
  for (const Patch& a : patches) {
    finest = std::min(finest, a.z);
    for (const Patch& b : patches) {
      if (&a == &b) continue;
      const bool apart =
          a.x + 32 * a.z <= b.x || b.x + 32 * b.z <= a.x || a.y + 32 * a.z <= b.y || b.y + 32 * b.z <= a.y;
      ASSERT_TRUE(apart) << a.x << " " << a.y << " " << a.z << " and " << b.x << " " << b.y << " " << b.z;
    }
  }
  EXPECT_LE(finest * g.field.spacingX, 0.17f);
}

TEST(Patches, coverWhatTheCameraSees) {
  const Ground g = ground();
  const View view{.eye = {3, 4, -8}, .target = {0, 0, 0}};
  const Composition c = composed(g, view);
  const std::vector<Patch> patches = choosePatches(c, g.field, g.lowest, g.highest);
  for (const glm::vec2 world : {glm::vec2(0, 0), {1, 2}, {-3, 6}, {0, 40}, {-20, 60}}) {
    const glm::vec2 at{(world.x - g.field.originX()) / g.field.spacingX,
                       (world.y - g.field.originZ()) / g.field.spacingZ};
    const auto holds = [&](const Patch& p) {
      return at.x >= p.x && at.x <= p.x + 32 * p.z && at.y >= p.y && at.y <= p.y + 32 * p.z;
    };
    EXPECT_TRUE(std::any_of(patches.begin(), patches.end(), holds)) << world.x << " " << world.y;
  }
}

// Ground that hides other ground is drawn before it.
TEST(Patches, comeNearestFirst) {
  const Ground g = ground();
  const Composition c = composed(g, {.eye = {3, 4, -8}, .target = {0, 0, 0}});
  const auto nearest = [&](const Patch& patch) {
    const glm::vec2 spacing(c.block.ground.z, c.block.ground.w), eye(c.block.eye.x, c.block.eye.z);
    const glm::vec2 low = glm::vec2(c.block.ground) + glm::vec2(patch) * spacing;
    return glm::distance(eye, glm::clamp(eye, low, low + 32 * patch.z * spacing));
  };
  float last = 0;
  for (const Patch& patch : choosePatches(c, g.field, g.lowest, g.highest)) {
    EXPECT_GE(nearest(patch), last - 1e-3f);
    last = nearest(patch);
  }
  EXPECT_GT(last, 50);
}

// Where two levels meet, the finer one has morphed into the coarser, and the coarser one not yet into the
// next.
TEST(Patches, neighboursMeetWhereTheFinerOneHasMorphed) {
  const Ground g = ground();
  for (const float height : {1.0f, 6.0f, 40.0f}) {
    const Composition c = composed(g, {.eye = {3, height, -8}, .target = {0, 0, 4}});
    const std::vector<Patch> patches = choosePatches(c, g.field, g.lowest, g.highest);
    for (const Patch& fine : patches)
      for (const Patch& coarse : patches) {
        if (coarse.z <= fine.z) continue;
        const glm::vec2 low = glm::max(glm::vec2(fine), glm::vec2(coarse));
        const glm::vec2 high = glm::min(glm::vec2(fine) + 32 * fine.z, glm::vec2(coarse) + 32 * coarse.z);
        if (low.x > high.x || low.y > high.y) continue;
        ASSERT_EQ(coarse.z, 2 * fine.z);
        for (const glm::vec2 corner : {low, high}) {
          const glm::vec2 p =
              glm::vec2(c.block.ground) + corner * glm::vec2(c.block.ground.z, c.block.ground.w);
          const float away =
              glm::length(glm::vec3(p.x - c.block.eye.x, p.y - c.block.eye.z, c.block.shadow.z));
          ASSERT_GE(away / fine.w, 0.989f);
          ASSERT_LE(away / coarse.w, 0.871f);
        }
      }
  }
}

}  // namespace
}  // namespace skitter::render
