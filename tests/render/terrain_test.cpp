#include "render/terrain.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "render/ground_map.h"

namespace skitter::render {
namespace {

constexpr float kCells = shared::PATCH_CELLS;

struct Ground {
  Heightfield field;
  Relief relief;
};
Ground ground(const TerrainNoise& noise = {.columns = 100, .rows = 73, .spacing = 0.5f}) {
  Ground g{generateHeightfield(noise), {}};
  g.relief = reliefOf(g.field);
  return g;
}
Composition composed(const Ground& g, const View& view, uint32_t width = 640, uint32_t height = 360) {
  return compose(view, lightModel({}), g.field, g.relief.lowest, g.relief.highest, width, height, 1024);
}
std::vector<Patch> chosen(const Ground& g, const Composition& c) {
  return choosePatches(c, g.field, g.relief);
}
glm::vec2 spacingOf(const Composition& c) { return {c.block.ground.z, c.block.ground.w}; }
// From the eye to a patch's nearest point, seen from above.
float nearest(const Composition& c, const Patch& patch) {
  const glm::vec2 eye(c.block.eye.x, c.block.eye.z);
  const glm::vec2 low = glm::vec2(c.block.ground) + glm::vec2(patch) * spacingOf(c);
  return glm::distance(eye, glm::clamp(eye, low, low + kCells * patch.z * spacingOf(c)));
}

TEST(Patches, doNotOverlapAndAreFineNearby) {
  const Ground g = ground();
  const Composition c = composed(g, {.eye = {3, 2, -8}, .target = {0, 0, 0}});
  const std::vector<Patch> patches = chosen(g, c);
  ASSERT_GT(patches.size(), 4u);
  EXPECT_LT(patches.size(), 400u);
  float finest = 1e9f;
  for (const Patch& a : patches) {
    finest = std::min(finest, a.z);
    for (const Patch& b : patches) {
      if (&a == &b) continue;
      const bool apart = a.x + kCells * a.z <= b.x || b.x + kCells * b.z <= a.x ||
                         a.y + kCells * a.z <= b.y || b.y + kCells * b.z <= a.y;
      ASSERT_TRUE(apart) << a.x << " " << a.y << " " << a.z << " and " << b.x << " " << b.y << " " << b.z;
    }
  }
  EXPECT_LE(finest * g.field.spacingX, 0.17f);
}

TEST(Patches, coverWhatTheCameraSees) {
  const Ground g = ground();
  const View view{.eye = {3, 4, -8}, .target = {0, 0, 0}};
  const Composition c = composed(g, view);
  const std::vector<Patch> patches = chosen(g, c);
  for (const glm::vec2 world : {glm::vec2(0, 0), {1, 2}, {-3, 6}, {0, 40}, {-20, 60}}) {
    const glm::vec2 at{(world.x - g.field.originX()) / g.field.spacingX,
                       (world.y - g.field.originZ()) / g.field.spacingZ};
    const auto holds = [&](const Patch& p) {
      return at.x >= p.x && at.x <= p.x + kCells * p.z && at.y >= p.y && at.y <= p.y + kCells * p.z;
    };
    EXPECT_TRUE(std::any_of(patches.begin(), patches.end(), holds)) << world.x << " " << world.y;
  }
}

// Ground that hides other ground is drawn before it.
TEST(Patches, comeNearestFirst) {
  const Ground g = ground();
  const Composition c = composed(g, {.eye = {3, 4, -8}, .target = {0, 0, 0}});
  float last = 0;
  for (const Patch& patch : chosen(g, c)) {
    EXPECT_GE(nearest(c, patch), last - 1e-3f);
    last = nearest(c, patch);
  }
  EXPECT_GT(last, 50);
}

// Between the ground and triangles over `stride` samples, root mean square over random places. By the height
// of the ground at corners that it finds itself.
double deviationOf(const Heightfield& field, float stride) {
  std::mt19937 random(7);
  const float lastX = std::floor(float(field.columns - 1) / stride),
              lastZ = std::floor(float(field.rows - 1) / stride);
  double sum = 0;
  constexpr int places = 40000;
  for (int i = 0; i < places; ++i) {
    const float x = std::uniform_real_distribution<float>(0, lastX)(random),
                z = std::uniform_real_distribution<float>(0, lastZ)(random);
    const float u = x - std::floor(x), v = z - std::floor(z);
    const auto height = [&](float cellX, float cellZ) {
      return double(field.at(field.originX() + cellX * stride * field.spacingX,
                             field.originZ() + cellZ * stride * field.spacingZ));
    };
    // The corner at the right angle of the triangle, and the two at its other angles.
    const bool first = u + v < 1;
    const float cornerX = std::floor(x) + (first ? 0.0f : 1.0f),
                cornerZ = std::floor(z) + (first ? 0.0f : 1.0f);
    const double alongX = first ? u : 1 - u, alongZ = first ? v : 1 - v;
    const float otherX = std::floor(x) + (first ? 1.0f : 0.0f),
                otherZ = std::floor(z) + (first ? 1.0f : 0.0f);
    const double drawn = (1 - alongX - alongZ) * height(cornerX, cornerZ) + alongX * height(otherX, cornerZ) +
                         alongZ * height(cornerX, otherZ);
    sum += (drawn - height(x, z)) * (drawn - height(x, z));
  }
  return std::sqrt(sum / places);
}

TEST(Relief, isHowFarMeshesAreFromTheGround) {
  const Ground g = ground({.columns = 257, .rows = 257, .spacing = 0.5f});
  for (const int level : {-2, -1, 0, 1, 2, 4}) {
    const double expected = deviationOf(g.field, std::exp2(float(level)));
    // Both are means over draws, of ground that is rougher in some places than in others.
    EXPECT_NEAR(g.relief.deviationOf(level), expected, 0.15 * expected) << level;
  }
  const Heightfield plane{.name = "plane", .columns = 2, .rows = 2, .heights = {0, 1, 2, 3}};
  EXPECT_NEAR(reliefOf(plane).deviationOf(0), 0, 1e-6);
}

// A mesh is seen to differ from the ground by half a pixel, less what fog hides, unless its
// triangles are small already. Next to the camera, where levels cannot follow each other as fast as that
// would take, it is a little more.
TEST(Patches, areAsFineAsIsSeen) {
  const Ground g = ground({});
  for (const uint32_t height : {360u, 720u, 2160u}) {
    const Composition c = composed(g, {.eye = {3, 6, -8}, .target = {0, 3, 0}}, height / 9 * 16, height);
    const std::vector<Patch> patches = chosen(g, c);
    std::map<float, double> deviations;
    int coarser = 0;
    for (const Patch& patch : patches) {
      if (patch.z < 0.2f) continue;  // the finest
      if (!deviations.contains(patch.z)) deviations[patch.z] = deviationOf(g.field, patch.z);
      const float away = nearest(c, patch), depth = away * c.block.tile.w;
      const double pixels = deviations[patch.z] * std::exp(-depth * depth) / (away * c.block.eye.w);
      if (away < 0.95f * 0.5f * patch.z * g.field.spacingX / (8 * c.block.eye.w)) {  // the finer one's cells
        EXPECT_LT(pixels, away < 2 ? 0.84 : 1.25 / 2) << patch.z << " at " << away << " m";
      }
      ++coarser;
    }
    EXPECT_GT(coarser, 20);
    // The triangles of a patch are two of each cell.
    if (height == 720) {
      EXPECT_LT(2 * kCells * kCells * float(patches.size()), 30000);
    }
  }
}

// A patch is drawn without detail where no pixel of it shows any, and without shadows where they have faded.
TEST(Patches, haveTheFormsThatTheyNeed) {
  const Ground g = ground({});
  const auto texel = [&](int x, int z) {
    return gradientAt(g.field, std::clamp(x, 0, int(g.field.columns) - 1),
                      std::clamp(z, 0, int(g.field.rows) - 1));
  };
  for (const float up : {3.0f, 60.0f}) {
    const View view{.eye = {3, up, -8}, .target = {0, 0.5f * up, 0}};
    const Composition c = composed(g, view, 1280, 720);
    const glm::vec3 eye(c.block.eye), forward(c.block.forward);
    int counts[kGroundForms] = {}, wasted = 0, wastedByDistance = 0;
    for (const Patch& patch : chosen(g, c)) {
      const GroundForm form = formOf(c, g.field, g.relief, patch, true);
      ++counts[form.index()];
      EXPECT_FALSE(formOf(c, g.field, g.relief, patch, false).shaded);
      EXPECT_EQ(formOf(c, g.field, g.relief, patch, false).detail, form.detail);
      float footprint = 1e9f, across = 1e9f;
      bool fallsWithin = false;
      for (int i = 0; i <= 8; ++i)
        for (int j = 0; j <= 8; ++j) {
          const glm::vec2 at = glm::vec2(patch) + patch.z * glm::vec2(i, j);
          const glm::vec2 world = at * spacingOf(c) + glm::vec2(g.field.originX(), g.field.originZ());
          const glm::vec3 p(glm::vec2(c.block.ground).x + at.x * c.block.ground.z,
                            g.field.seenAt(world.x, world.y), c.block.ground.y + at.y * c.block.ground.w);
          // As shaders/render/terrain.frag measures a pixel. Mirrored ground is as steep.
          const glm::vec2 last(float(g.field.columns - 1), float(g.field.rows - 1));
          const glm::vec2 turned = glm::mod(at, 2.0f * last), folded = last - glm::abs(turned - last);
          const glm::ivec2 low(glm::floor(folded));
          const glm::vec2 part = folded - glm::vec2(low);
          const glm::vec2 slope =
              glm::mix(glm::mix(texel(low.x, low.y), texel(low.x + 1, low.y), part.x),
                       glm::mix(texel(low.x, low.y + 1), texel(low.x + 1, low.y + 1), part.x), part.y) *
              (1.0f - 2.0f * glm::step(last, turned));
          const float facing =
              glm::dot(glm::normalize(eye - p), glm::normalize(glm::vec3(-slope.x, 1, -slope.y)));
          const float pixel = glm::distance(p, eye) * c.block.eye.w;
          across = std::min(across, pixel);
          footprint = std::min(footprint, pixel / std::sqrt(std::max(facing, 0.02f)));
          fallsWithin = fallsWithin || glm::dot(p - eye, forward) < 0.98f * c.block.forward.w;
        }
      // As shaders/render/noise.glsl fades clods and grains.
      const auto shown = [](float metres) {
        return metres < 0.4f * 0.062f ? 2 : metres < 0.4f * 0.31f ? 1 : 0;
      };
      EXPECT_GE(form.detail, shown(footprint)) << patch.x << ", " << patch.y;
      wasted += form.detail > shown(footprint) ? 1 : 0;
      wastedByDistance += shown(across) > shown(footprint) ? 1 : 0;
      EXPECT_TRUE(form.shaded || !fallsWithin) << patch.x << ", " << patch.y;
      // A vertex for each sample and each metre.
      EXPECT_EQ(form.dense, patch.z <= 1 && patch.z * g.field.spacingX <= 1) << patch.x << ", " << patch.y;
    }
    if (up < 10) {
      EXPECT_GT(counts[(GroundForm{2, true, true}).index()], 20);
      EXPECT_GT(counts[(GroundForm{1, true, true}).index()], 20);
      EXPECT_GT(counts[(GroundForm{0, false, false}).index()], 5);
    } else {
      EXPECT_EQ(counts[(GroundForm{2, true, true}).index()], 0);
      EXPECT_EQ(counts[(GroundForm{2, true, false}).index()], 0);
    }
    EXPECT_LE(wasted, wastedByDistance);
    if (up < 10) {
      EXPECT_LT(wasted, 0.8 * wastedByDistance) << "patches are drawn with detail that they do not show";
    }
  }
}

// However rough the ground is and however much of it one sees.
TEST(Patches, areNeverTooMany) {
  const Ground g = ground({.columns = 257, .rows = 257, .spacing = 0.5f, .amplitude = 400, .gain = 0.9f});
  const View above{.eye = {0, g.relief.highest + 1, 0}, .target = {0, 0, 0.1f}, .fieldOfView = 2.0f};
  const Composition c = composed(g, above, 7680, 4320);
  const std::vector<Patch> patches = chosen(g, c);
  EXPECT_LE(patches.size(), 4096u);
  EXPECT_GT(nearest(c, patches.back()), 1000) << "what is far away is not left out";
}

// Where two levels meet, the finer one has morphed into the coarser, and the coarser one not yet into the
// next.
TEST(Patches, neighboursMeetWhereTheFinerOneHasMorphed) {
  const Ground g = ground();
  for (const float height : {1.0f, 6.0f, 40.0f}) {
    const Composition c = composed(g, {.eye = {3, height, -8}, .target = {0, 0, 4}});
    const std::vector<Patch> patches = chosen(g, c);
    for (const Patch& fine : patches)
      for (const Patch& coarse : patches) {
        if (coarse.z <= fine.z) continue;
        const glm::vec2 low = glm::max(glm::vec2(fine), glm::vec2(coarse));
        const glm::vec2 high =
            glm::min(glm::vec2(fine) + kCells * fine.z, glm::vec2(coarse) + kCells * coarse.z);
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
