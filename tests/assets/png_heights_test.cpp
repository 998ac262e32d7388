#include <gtest/gtest.h>
#include <zlib.h>

#include <limits>

#include "files.h"
#include "skitter/heightfield.h"

namespace skitter {
namespace {

using test::inputFault;
using test::TemporaryFolder;

TEST(PngHeights, DefaultsWithoutSidecar) {
  TemporaryFolder folder;
  test::writePng(folder / "a.png", 3, 2, 16, {0, 65535, 0, 32768, 0, 6554});
  const Heightfield field = loadHeightfield(folder / "a.png");
  EXPECT_EQ(field.name, "a");
  EXPECT_EQ(field.columns, 3u);
  EXPECT_EQ(field.rows, 2u);
  EXPECT_EQ(field.spacingX, 0.5f);
  EXPECT_EQ(field.spacingZ, 0.5f);
  EXPECT_FLOAT_EQ(field.heights[0], -5);
  EXPECT_FLOAT_EQ(field.heights[1], 5);
  EXPECT_NEAR(field.heights[3], 0, 1e-3);
  EXPECT_NEAR(field.heights[5], -4, 1e-3);
  // The first row lies at -z.
  EXPECT_FLOAT_EQ(field.at(0, -0.25f), 5);
  EXPECT_FLOAT_EQ(field.at(0, 0.25f), -5);
}

TEST(PngHeights, EightBits) {
  TemporaryFolder folder;
  test::writePng(folder / "a.png", 2, 2, 8, {0, 255, 51, 0});
  const Heightfield field = loadHeightfield(folder / "a.png");
  EXPECT_FLOAT_EQ(field.heights[1], 5);
  EXPECT_FLOAT_EQ(field.heights[2], -3);
}

TEST(PngHeights, MidHeightIsOfTheSamplesThere) {
  TemporaryFolder folder;
  test::writePng(folder / "a.png", 2, 2, 8, {102, 153, 102, 102});
  HeightfieldUnits units;
  units.minHeight = 100;
  units.maxHeight = 110;
  units.scale = 2;
  const Heightfield field = loadHeightfield(folder / "a.png", units);
  EXPECT_FLOAT_EQ(field.heights[0], -2);
  EXPECT_FLOAT_EQ(field.heights[1], 2);
  EXPECT_FLOAT_EQ(field.spacingX, 1);
}

TEST(PngHeights, SidecarAndFlagsOverIt) {
  TemporaryFolder folder;
  test::writePng(folder / "hill_2x3.png", 2, 3, 16, {0, 65535, 0, 0, 0, 0});
  test::writeText(folder / "hill.json", R"({"spacing_x_m": 3, "spacing_y_m": 4, "min_m": 10, "max_m": 30})");
  Heightfield field = loadHeightfield(folder / "hill_2x3.png");
  EXPECT_EQ(field.spacingX, 3);
  EXPECT_EQ(field.spacingZ, 4);
  EXPECT_FLOAT_EQ(field.heights[1], 10);
  HeightfieldUnits units;
  units.spacingZ = 7;
  field = loadHeightfield(folder / "hill_2x3.png", units);
  EXPECT_EQ(field.spacingX, 3);
  EXPECT_EQ(field.spacingZ, 7);
  // A sidecar of the whole name comes first.
  test::writeText(folder / "hill_2x3.json", R"({"spacing_x_m": 5})");
  EXPECT_EQ(loadHeightfield(folder / "hill_2x3.png").spacingX, 5);
  test::writeText(folder / "hill_2x3.json", R"({"spacing_x_m": "5"})");
  EXPECT_NE(inputFault([&] { loadHeightfield(folder / "hill_2x3.png"); }).find("spacing_x_m is \"5\""),
            std::string::npos);
  test::writeText(folder / "hill_2x3.json", R"({"spacing_y_m": 1e300})");
  EXPECT_NE(inputFault([&] { loadHeightfield(folder / "hill_2x3.png"); }).find("spacing_y_m is 1e+300"),
            std::string::npos);
  test::writeText(folder / "hill_2x3.json", R"({"width": 4, "height": 3})");
  EXPECT_NE(inputFault([&] { loadHeightfield(folder / "hill_2x3.png"); }).find("4 x 3"), std::string::npos);
  test::writeText(folder / "hill_2x3.json", "{");
  EXPECT_NE(inputFault([&] { loadHeightfield(folder / "hill_2x3.png"); }).find("hill_2x3.json"),
            std::string::npos);
}

TEST(PngHeights, RefusesBadFilesByName) {
  TemporaryFolder folder;
  const auto fault = [&](const std::string& name) {
    const std::string what = inputFault([&] { loadHeightfield(folder / name); });
    EXPECT_NE(what.find(name), std::string::npos) << what;
    return what;
  };
  EXPECT_NE(fault("missing.png").find("no such file"), std::string::npos);
  std::filesystem::create_directory(folder / "directory.png");
  EXPECT_NE(fault("directory.png").find("is a directory"), std::string::npos);
  test::writeText(folder / "empty.png", "");
  EXPECT_NE(fault("empty.png").find("is empty"), std::string::npos);
  test::writeText(folder / "text.png", "not a picture at all");
  EXPECT_NE(fault("text.png").find("not a PNG"), std::string::npos);
  test::writePng(folder / "thin.png", 1, 4, 8, {0, 0, 0, 0});
  EXPECT_NE(fault("thin.png").find("1 x 4"), std::string::npos);
  test::writePng(folder / "wide.png", 16385, 2, 8, std::vector<uint16_t>(2 * 16385));
  EXPECT_NE(fault("wide.png").find("16385 x 2"), std::string::npos);
}

TEST(PngHeights, RefusesEveryTruncationAndHugeClaims) {
  TemporaryFolder folder;
  test::writePng(folder / "whole.png", 8, 8, 16, std::vector<uint16_t>(64, 7));
  const std::vector<uint8_t> whole = test::readBytes(folder / "whole.png");
  EXPECT_NO_THROW(loadHeightfield(folder / "whole.png"));
  for (size_t size = 1; size < whole.size(); ++size) {
    test::writeBytes(folder / "cut.png", {whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)});
    EXPECT_FALSE(inputFault([&] { loadHeightfield(folder / "cut.png"); }).empty()) << size;
  }
  // A few hundred bytes whose header claims 16384 x 16384 samples, with a checksum that agrees.
  test::writePng(folder / "claim.png", 16384, 2, 16, std::vector<uint16_t>(2 * 16384));
  std::vector<uint8_t> claim = test::readBytes(folder / "claim.png");
  constexpr size_t headerAt = 12, heightAt = 20, checksumAt = 29;
  claim[heightAt + 2] = 0x40;
  claim[heightAt + 3] = 0;
  const uLong checksum = crc32(0, claim.data() + headerAt, checksumAt - headerAt);
  for (size_t k = 0; k < 4; ++k) claim[checksumAt + k] = static_cast<uint8_t>(checksum >> (24 - 8 * k));
  test::writeBytes(folder / "claim.png", claim);
  EXPECT_NE(inputFault([&] { loadHeightfield(folder / "claim.png"); }).find("cannot hold 16384 x 16384"),
            std::string::npos);
}

TEST(PngHeights, RefusesUnitsThatAreNotSane) {
  TemporaryFolder folder;
  test::writePng(folder / "a.png", 2, 2, 8, {0, 1, 2, 3});
  const auto fault = [&](auto change) {
    HeightfieldUnits units;
    change(units);
    return inputFault([&] { loadHeightfield(folder / "a.png", units); });
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_NE(fault([&](HeightfieldUnits& u) { u.scale = nan; }).find("scale is nan"), std::string::npos);
  EXPECT_NE(fault([](HeightfieldUnits& u) { u.scale = -1; }).find("scale"), std::string::npos);
  EXPECT_NE(fault([](HeightfieldUnits& u) { u.spacingX = 0; }).find("spacing x"), std::string::npos);
  EXPECT_NE(fault([](HeightfieldUnits& u) {
              u.spacingZ = std::numeric_limits<float>::infinity();
            }).find("spacing z"),
            std::string::npos);
  EXPECT_NE(fault([&](HeightfieldUnits& u) { u.minHeight = nan; }).find("minimum height"), std::string::npos);
  EXPECT_NE(fault([](HeightfieldUnits& u) { u.minHeight = 11; }).find("above maximum height"),
            std::string::npos);
}

}  // namespace
}  // namespace skitter
