// Terrain that nobody on the project made. What each file holds is told by the JSON beside it.
#include <gtest/gtest.h>

#include <algorithm>

#include "files.h"
#include "skitter/heightfield.h"

namespace skitter {
namespace {

struct RealTerrain : ::testing::Test {
  void SetUp() override {
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is absent";
  }
  const std::filesystem::path folder = std::filesystem::path(SKITTER_SHARED_DATA) / "terrain";
};

float rangeOf(const Heightfield& field) {
  const auto [low, high] = std::minmax_element(field.heights.begin(), field.heights.end());
  return *high - *low;
}

TEST_F(RealTerrain, Jacksboro) {
  const Heightfield codes = loadHeightfield(folder / "jacksboro_403x344.png");
  EXPECT_EQ(codes.columns, 403u);
  EXPECT_EQ(codes.rows, 344u);
  EXPECT_NEAR(codes.extentX(), 29938.8, 0.5);
  EXPECT_NEAR(codes.extentZ(), 31605.7, 0.5);
  EXPECT_NEAR(rangeOf(codes), 840, 0.02);
  const Heightfield metres = loadHeightfield(folder / "jacksboro_403x344.r32f");
  EXPECT_EQ(metres.columns, 403u);
  EXPECT_EQ(metres.rows, 344u);
  EXPECT_EQ(metres.spacingZ, codes.spacingZ);
  EXPECT_EQ(metres.filledVoids, 0u);
  for (size_t k = 0; k < codes.heights.size(); ++k)
    ASSERT_NEAR(codes.heights[k], metres.heights[k], 0.02) << k;
}

TEST_F(RealTerrain, EverestIsACropOfItsTile) {
  const Heightfield png = loadHeightfield(folder / "everest_513x513.png");
  EXPECT_NEAR(png.extentX(), 42018.4, 0.5);
  EXPECT_NEAR(png.extentZ(), 47178.2, 0.5);
  EXPECT_NEAR(rangeOf(png), 7436, 0.02);
  const Heightfield raw = loadHeightfield(folder / "everest_513x513.r16");
  EXPECT_EQ(raw.heights, png.heights);

  const Heightfield tile = loadHeightfield(folder / "N27E086.hgt");
  EXPECT_EQ(tile.columns, 1201u);
  // Its neighbour's spacing is told for the crop's own latitude, a third of a degree north of the tile's
  // middle.
  EXPECT_NEAR(tile.spacingX, png.spacingX, 0.5);
  EXPECT_NEAR(tile.spacingZ, png.spacingZ, 0.5);
  const float offset = tile.heights[688] - png.heights[0];
  for (uint32_t row = 0; row < png.rows; ++row) {
    for (uint32_t column = 0; column < png.columns; ++column) {
      ASSERT_NEAR(tile.heights[row * tile.columns + 688 + column] - offset,
                  png.heights[row * png.columns + column], 0.15)
          << column << ", " << row;
    }
  }
  EXPECT_EQ(png.filledVoids, 0u);
}

TEST_F(RealTerrain, Volcano) {
  const Heightfield field = loadHeightfield(folder / "volcano_87x61.png");
  EXPECT_EQ(field.columns, 87u);
  EXPECT_EQ(field.rows, 61u);
  EXPECT_EQ(field.extentX(), 860);
  EXPECT_EQ(field.extentZ(), 600);
  EXPECT_NEAR(rangeOf(field), 101, 0.01);
}

TEST_F(RealTerrain, ScaledToAWorldThatCanBeWalked) {
  HeightfieldUnits units;
  units.scale = 0.01f;
  units.exaggeration = 0.5f;
  const Heightfield everest = loadHeightfield(folder / "everest_513x513.png", units);
  EXPECT_NEAR(everest.extentX(), 420.184, 0.01);
  EXPECT_NEAR(rangeOf(everest), 37.18, 0.01);
}

}  // namespace
}  // namespace skitter
