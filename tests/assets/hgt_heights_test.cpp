#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "files.h"
#include "height_bytes.h"
#include "skitter/heightfield.h"

namespace skitter {
namespace {

using test::inputFault;
using test::TemporaryFolder;

TEST(HgtHeights, SpacingComesFromTheLatitudeInTheName) {
  TemporaryFolder folder;
  const std::vector<uint8_t> tile = test::hgt(1201, 100, {{0, 0, -300}, {1200, 1200, 500}});
  const auto load = [&](const std::string& name) {
    test::writeBytes(folder / name, tile);
    return loadHeightfield(folder / name);
  };
  const Heightfield north = load("N27E086.hgt");
  EXPECT_EQ(north.columns, 1201u);
  EXPECT_FLOAT_EQ(north.heights.front(), -400);
  EXPECT_FLOAT_EQ(north.heights.back(), 400);
  EXPECT_FLOAT_EQ(north.heights[1], 0);
  // A degree at 27.5 N by the ellipsoid's radii of curvature.
  const double phi = 27.5 * std::numbers::pi / 180, a = 6378137, e2 = 0.00669437999014;
  const double w = 1 - e2 * std::sin(phi) * std::sin(phi), degree = std::numbers::pi / 180;
  EXPECT_NEAR(north.extentZ(), degree * a * (1 - e2) / std::pow(w, 1.5), 5);
  EXPECT_NEAR(north.extentX(), degree * a * std::cos(phi) / std::sqrt(w), 5);

  // The same latitude south of the equator, where the corner is the southern one, too.
  EXPECT_FLOAT_EQ(load("S28W071.hgt").spacingX, north.spacingX);
  EXPECT_FLOAT_EQ(load("n27_e086_3arc_v2.HGT").spacingX, north.spacingX);
  EXPECT_LT(load("N60E010.hgt").spacingX, 0.6f * north.spacingX);
  EXPECT_GT(load("N60E010.hgt").spacingZ, north.spacingZ);
  for (const char* name :
       {"N90E000.hgt", "S91E000.hgt", "N27E181.hgt", "N2E086.hgt", "tile.hgt", "N27.hgt"}) {
    EXPECT_EQ(load(name).spacingX, 0.5f) << name;
  }
  test::writeText(folder / "N27E086.json", R"({"spacing_x_m": 7})");
  EXPECT_EQ(load("N27E086.hgt").spacingX, 7);
  EXPECT_EQ(load("N27E086.hgt").spacingZ, north.spacingZ);
}

TEST(HgtHeights, VoidsAreFilledAndCounted) {
  TemporaryFolder folder;
  test::writeBytes(folder / "N00E000.hgt",
                   test::hgt(1201, 40, {{3, 3, -32768}, {4, 3, -32768}, {1200, 0, -32768}, {9, 9, 44}}));
  const Heightfield field = loadHeightfield(folder / "N00E000.hgt");
  EXPECT_EQ(field.filledVoids, 3u);
  EXPECT_FLOAT_EQ(field.heights[3 * 1201 + 3], -2);
  EXPECT_FLOAT_EQ(field.heights[1200], -2);
  test::writeBytes(folder / "void.hgt", test::hgt(1201, -32768));
  EXPECT_NE(inputFault([&] { loadHeightfield(folder / "void.hgt"); }).find("void.hgt: has no heights"),
            std::string::npos);
}

TEST(HgtHeights, RefusesOtherSizes) {
  TemporaryFolder folder;
  std::vector<uint8_t> tile = test::hgt(1201, 0);
  tile.push_back(0);
  test::writeBytes(folder / "N27E086.hgt", tile);
  EXPECT_NE(inputFault([&] { loadHeightfield(folder / "N27E086.hgt"); }).find("2884803 bytes"),
            std::string::npos);
  tile.pop_back();
  tile.pop_back();
  test::writeBytes(folder / "N27E086.hgt", tile);
  EXPECT_NE(inputFault([&] { loadHeightfield(folder / "N27E086.hgt"); }).find("2884801 bytes"),
            std::string::npos);
  test::writeBytes(folder / "N27E086.hgt", test::hgt(4, 0));
  EXPECT_NE(inputFault([&] { loadHeightfield(folder / "N27E086.hgt"); }).find("SRTM3"), std::string::npos);
  EXPECT_NE(inputFault([&] { loadHeightfield(folder / "N28E086.hgt"); }).find("no such file"),
            std::string::npos);
  HeightfieldUnits units;
  units.columns = 600;
  test::writeBytes(folder / "N27E086.hgt", test::hgt(1201, 0));
  EXPECT_NE(inputFault([&] { loadHeightfield(folder / "N27E086.hgt", units); }).find("600"),
            std::string::npos);
}

}  // namespace
}  // namespace skitter
