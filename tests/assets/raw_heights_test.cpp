#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "files.h"
#include "height_bytes.h"
#include "skitter/heightfield.h"

namespace skitter {
namespace {

using test::inputFault;
using test::TemporaryFolder;
using ::testing::Test;

struct RawHeights : Test {
  TemporaryFolder folder;

  std::string fault(const std::string& name, const HeightfieldUnits& units = {}) {
    const std::string what = inputFault([&] { loadHeightfield(folder / name, units); });
    EXPECT_NE(what.find(name.substr(0, name.find('.'))), std::string::npos) << what;
    return what;
  }
};

TEST_F(RawHeights, SquaresNeedNoSize) {
  test::writeBytes(folder / "a.r16", test::r16({0, 65535, 13107, 0}));
  const Heightfield codes = loadHeightfield(folder / "a.r16");
  EXPECT_EQ(codes.columns, 2u);
  EXPECT_EQ(codes.rows, 2u);
  EXPECT_FLOAT_EQ(codes.heights[0], -5);
  EXPECT_FLOAT_EQ(codes.heights[1], 5);
  EXPECT_FLOAT_EQ(codes.heights[2], -3);
  EXPECT_EQ(codes.filledVoids, 0u);

  test::writeBytes(folder / "a.r32f", test::r32f({-1, 7, 3, 1.5f}));
  EXPECT_EQ(loadHeightfield(folder / "a.r32f").heights, (std::vector<float>{-4, 4, 0, -1.5f}));
}

TEST_F(RawHeights, TheSizeComesFromFlagsThenSidecarThenName) {
  const std::vector<uint8_t> twelve = test::r16({0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 65535});
  test::writeBytes(folder / "hill_6x2.r16", twelve);
  EXPECT_EQ(loadHeightfield(folder / "hill_6x2.r16").columns, 6u);
  test::writeText(folder / "hill.json", R"({"width": 3, "height": 4})");
  EXPECT_EQ(loadHeightfield(folder / "hill_6x2.r16").columns, 3u);
  HeightfieldUnits units;
  units.columns = 2;
  units.rows = 6;
  EXPECT_EQ(loadHeightfield(folder / "hill_6x2.r16", units).rows, 6u);
  units.columns.reset();
  test::writeBytes(folder / "one.r16", twelve);
  EXPECT_EQ(loadHeightfield(folder / "one.r16", units).columns, 2u);
}

TEST_F(RawHeights, RefusesSizesThatAreNotTheFiles) {
  test::writeBytes(folder / "odd.r16", test::r16({0, 1, 2, 3, 4, 5}));
  EXPECT_NE(fault("odd.r16").find("--terrain-size"), std::string::npos);
  HeightfieldUnits units;
  units.columns = 2;
  units.rows = 2;
  EXPECT_NE(fault("odd.r16", units).find("2 x 2 samples of 2 bytes are 8"), std::string::npos);
  units.columns = 6;
  units.rows = 1;
  EXPECT_NE(fault("odd.r16", units).find("6 x 1"), std::string::npos);
  units.columns = 4000000000u;
  units.rows = 4000000000u;
  EXPECT_NE(fault("odd.r16", units).find("4000000000"), std::string::npos);
  units.columns = 0;
  units.rows.reset();
  EXPECT_FALSE(fault("odd.r16", units).empty());
  units.columns = 4;
  EXPECT_NE(fault("odd.r16", units).find("4 x 1"), std::string::npos);

  std::vector<uint8_t> whole = test::r32f({0, 1, 2, 3});
  whole.push_back(0);
  test::writeBytes(folder / "long.r32f", whole);
  EXPECT_NE(fault("long.r32f").find("17 bytes"), std::string::npos);
  test::writeBytes(folder / "cut.r32f", {whole.begin(), whole.begin() + 15});
  EXPECT_NE(fault("cut.r32f").find("15 bytes"), std::string::npos);
  test::writeBytes(folder / "point.r32f", test::r32f({1}));
  EXPECT_NE(fault("point.r32f").find("1 x 1"), std::string::npos);
  test::writeText(folder / "empty.r16", "");
  EXPECT_NE(fault("empty.r16").find("is empty"), std::string::npos);
  EXPECT_NE(fault("missing.r16").find("no such file"), std::string::npos);

  for (const char* size : {R"({"width": 2.5, "height": 3})", R"({"width": -3, "height": 2})",
                           R"({"width": 1e300, "height": 2})", R"({"width": 0, "height": 2})"}) {
    test::writeText(folder / "odd.json", size);
    EXPECT_NE(fault("odd.r16").find("odd.json: width is"), std::string::npos) << size;
  }
}

TEST_F(RawHeights, UnknownKindsAreNamed) {
  test::writeText(folder / "a.tiff", "II*");
  EXPECT_NE(fault("a.tiff").find(".npy"), std::string::npos);
  EXPECT_NE(fault("b.tiff").find("no such file"), std::string::npos);
  test::writeBytes(folder / "UPPER.R16", test::r16({0, 1, 2, 3}));
  EXPECT_EQ(loadHeightfield(folder / "UPPER.R16").rows, 2u);
}

TEST_F(RawHeights, NanIsAVoidAndInfinityAFault) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  test::writeBytes(folder / "a.r32f", test::r32f({1, 1, 1, 1, nan, 1, 1, 1, 3}));
  const Heightfield field = loadHeightfield(folder / "a.r32f");
  EXPECT_EQ(field.filledVoids, 1u);
  EXPECT_NEAR(field.heights[4], 1 - 2, 1e-6);
  test::writeBytes(folder / "all.r32f", test::r32f({nan, nan, nan, nan}));
  EXPECT_NE(fault("all.r32f").find("all of its samples are voids"), std::string::npos);
  test::writeBytes(folder / "inf.r32f", test::r32f({1, std::numeric_limits<float>::infinity(), 1, 1}));
  EXPECT_NE(fault("inf.r32f").find("column 1, row 0 is inf"), std::string::npos);
  test::writeBytes(folder / "far.r32f", test::r32f({1, 1, 1, -3.4e38f}));
  EXPECT_NE(fault("far.r32f").find("column 1, row 1"), std::string::npos);
}

TEST_F(RawHeights, AVoidValueIsHonouredWhereItIsSaid) {
  test::writeBytes(folder / "a.r16", test::r16({0, 10, 20, 30}));
  test::writeText(folder / "a.json", R"({"nodata": 0})");
  EXPECT_EQ(loadHeightfield(folder / "a.r16").filledVoids, 0u);
  test::writeText(folder / "a.json", R"({"void_value": 0})");
  EXPECT_EQ(loadHeightfield(folder / "a.r16").filledVoids, 1u);
  HeightfieldUnits units;
  units.voidValue = 31;
  EXPECT_EQ(loadHeightfield(folder / "a.r16", units).filledVoids, 0u);
  units.voidValue = 0.5;
  EXPECT_NE(fault("a.r16", units).find("void value 0.5"), std::string::npos);
  units.voidValue = -32768;
  EXPECT_NE(fault("a.r16", units).find("void value -32768"), std::string::npos);
  units.voidValue = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(fault("a.r16", units).find("void value nan"), std::string::npos);

  const float lowest = std::numeric_limits<float>::lowest();
  test::writeBytes(folder / "b.r32f", test::r32f({1, 1, 1, lowest}));
  units.voidValue = -3.4028235e38;
  EXPECT_EQ(loadHeightfield(folder / "b.r32f", units).filledVoids, 1u);
}

}  // namespace
}  // namespace skitter
