#include <gtest/gtest.h>

#include <limits>

#include "files.h"
#include "height_bytes.h"
#include "skitter/heightfield.h"

namespace skitter {
namespace {

using test::inputFault;
using test::TemporaryFolder;

TEST(HeightUnits, ExaggerationMultipliesHeightsAlone) {
  TemporaryFolder folder;
  test::writeBytes(folder / "a.r32f", test::r32f({0, 1, 2, 3}));
  HeightfieldUnits units;
  units.exaggeration = 3;
  units.scale = 2;
  const Heightfield field = loadHeightfield(folder / "a.r32f", units);
  EXPECT_EQ(field.spacingX, 1);
  EXPECT_EQ(field.heights, (std::vector<float>{-9, -3, 3, 9}));
  units.exaggeration = 0;
  EXPECT_EQ(loadHeightfield(folder / "a.r32f", units).heights, std::vector<float>(4, 0));
}

TEST(HeightUnits, ARangeRescalesMetres) {
  TemporaryFolder folder;
  test::writeBytes(folder / "a.r32f", test::r32f({100, 101, 102, 104}));
  // Facts of the sidecar are about codes: metres need none.
  test::writeText(folder / "a.json", R"({"min_m": 0, "max_m": 1000})");
  EXPECT_EQ(loadHeightfield(folder / "a.r32f").heights, (std::vector<float>{-2, -1, 0, 2}));
  HeightfieldUnits units;
  units.minHeight = 0;
  units.maxHeight = 40;
  EXPECT_EQ(loadHeightfield(folder / "a.r32f", units).heights, (std::vector<float>{-20, -10, 0, 20}));
  units.minHeight.reset();
  units.maxHeight = 108;
  EXPECT_EQ(loadHeightfield(folder / "a.r32f", units).heights, (std::vector<float>{-4, -2, 0, 4}));
  units.maxHeight = 99;
  EXPECT_NE(inputFault([&] { loadHeightfield(folder / "a.r32f", units); }).find("is above maximum height 99"),
            std::string::npos);
  test::writeBytes(folder / "flat.r32f", test::r32f({7, 7, 7, 7}));
  units.minHeight = 0;
  EXPECT_EQ(loadHeightfield(folder / "flat.r32f", units).heights, std::vector<float>(4, 0));
}

TEST(HeightUnits, RefusesWhatIsNotSane) {
  TemporaryFolder folder;
  test::writeBytes(folder / "a.r32f", test::r32f({0, 1, 2, 900000}));
  HeightfieldUnits units;
  units.exaggeration = -1;
  EXPECT_NE(inputFault([&] { loadHeightfield(folder / "a.r32f", units); }).find("exaggeration is -1"),
            std::string::npos);
  units.exaggeration = std::numeric_limits<float>::quiet_NaN();
  EXPECT_NE(inputFault([&] { loadHeightfield(folder / "a.r32f", units); }).find("exaggeration is nan"),
            std::string::npos);
  units.exaggeration = 2;
  EXPECT_NE(inputFault([&] { loadHeightfield(folder / "a.r32f", units); }).find("scaled height range"),
            std::string::npos);
}

}  // namespace
}  // namespace skitter
