// Ground that nobody on the project made: each picture of assets/terrain is read as its sidecar says, and the
// same heights come from the other kinds of file.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "files.h"
#include "height_bytes.h"
#include "skitter/heightfield.h"

namespace skitter {
namespace {

const std::filesystem::path terrainFolder = SKITTER_ROOT "/assets/terrain";

float lowestOf(const Heightfield& field) {
  return *std::min_element(field.heights.begin(), field.heights.end());
}

float rangeOf(const Heightfield& field) {
  return *std::max_element(field.heights.begin(), field.heights.end()) - lowestOf(field);
}

// Heights above the lowest sample in steps of `unit`, rounded.
template <typename Code>
std::vector<Code> codesOf(const Heightfield& field, double unit, double lowest = 0) {
  std::vector<Code> codes;
  const float first = lowestOf(field);
  for (const float height : field.heights)
    codes.push_back(static_cast<Code>(std::round(lowest + double{height - first} / unit)));
  return codes;
}

TEST(RealTerrain, JacksboroIsOfWholeMetres) {
  const Heightfield png = loadHeightfield(terrainFolder / "jacksboro_403x344.png");
  EXPECT_EQ(png.columns, 403u);
  EXPECT_EQ(png.rows, 344u);
  EXPECT_NEAR(png.extentX(), 29938.8, 0.5);
  EXPECT_NEAR(png.extentZ(), 31605.7, 0.5);
  EXPECT_NEAR(rangeOf(png), 840, 0.02);

  test::TemporaryFolder folder;
  std::filesystem::copy_file(terrainFolder / "jacksboro.json", folder / "jacksboro.json");
  test::writeBytes(folder / "jacksboro_403x344.r32f", test::r32f(codesOf<float>(png, 1, 236)));
  const Heightfield metres = loadHeightfield(folder / "jacksboro_403x344.r32f");
  EXPECT_EQ(metres.columns, 403u);
  EXPECT_EQ(metres.rows, 344u);
  EXPECT_EQ(metres.spacingZ, png.spacingZ);
  EXPECT_EQ(metres.filledVoids, 0u);
  // Half a code of 840 m / 65535, and rounding in single precision.
  for (size_t k = 0; k < png.heights.size(); ++k) ASSERT_NEAR(png.heights[k], metres.heights[k], 0.0066) << k;
}

TEST(RealTerrain, EverestIsACropOfItsTile) {
  const Heightfield png = loadHeightfield(terrainFolder / "everest_513x513.png");
  EXPECT_NEAR(png.extentX(), 42018.4, 0.5);
  EXPECT_NEAR(png.extentZ(), 47178.2, 0.5);
  EXPECT_NEAR(rangeOf(png), 7436, 0.02);
  EXPECT_EQ(png.filledVoids, 0u);

  test::TemporaryFolder folder;
  std::filesystem::copy_file(terrainFolder / "everest.json", folder / "everest.json");
  test::writeBytes(folder / "everest_513x513.r16", test::r16(codesOf<uint16_t>(png, 7436.0 / 65535)));
  EXPECT_EQ(loadHeightfield(folder / "everest_513x513.r16").heights, png.heights);

  std::vector<test::HgtSample> samples;
  const std::vector<int16_t> metres = codesOf<int16_t>(png, 1, 1404);
  for (uint32_t row = 0; row < png.rows; ++row) {
    for (uint32_t column = 0; column < png.columns; ++column)
      samples.push_back({688 + column, row, metres[row * png.columns + column]});
  }
  test::writeBytes(folder / "N27E086.hgt", test::hgt(1201, 1404, samples));
  const Heightfield tile = loadHeightfield(folder / "N27E086.hgt");
  EXPECT_EQ(tile.columns, 1201u);
  // The sidecar's spacing is that of the crop's own latitude, a third of a degree north of the tile's middle.
  EXPECT_NEAR(tile.spacingX, png.spacingX, 0.5);
  EXPECT_NEAR(tile.spacingZ, png.spacingZ, 0.5);
  // Half a code of 7436 m / 65535, and rounding in single precision.
  for (uint32_t row = 0; row < png.rows; ++row) {
    for (uint32_t column = 0; column < png.columns; ++column) {
      ASSERT_NEAR(tile.heights[row * tile.columns + 688 + column], png.heights[row * png.columns + column],
                  0.058)
          << column << ", " << row;
    }
  }
}

TEST(RealTerrain, ScaledToAWorldThatCanBeWalked) {
  HeightfieldUnits units;
  units.scale = 0.01f;
  units.exaggeration = 0.5f;
  const Heightfield everest = loadHeightfield(terrainFolder / "everest_513x513.png", units);
  EXPECT_NEAR(everest.extentX(), 420.184, 0.01);
  EXPECT_NEAR(rangeOf(everest), 37.18, 0.01);
}

}  // namespace
}  // namespace skitter
