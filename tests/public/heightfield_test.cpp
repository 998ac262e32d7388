#include "skitter/heightfield.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "public/public.h"

namespace skitter::test {
namespace {

constexpr float noHeight = std::numeric_limits<float>::quiet_NaN();

// It rises by 1 m per metre of x, up to x = 1, and by 2 m per metre of z.
Heightfield slope() {
  Heightfield field;
  field.name = "slope";
  field.columns = 3, field.rows = 2;
  field.heights = {-2, -1, 0, 0, 1, 2};
  return field;
}

TEST(PublicHeightfield, LiesAboutTheOrigin) {
  Heightfield field = slope();
  field.spacingX = 2;
  EXPECT_EQ(field.extentX(), 4);
  EXPECT_EQ(field.extentZ(), 1);
  EXPECT_EQ(field.originX(), -2);
  EXPECT_EQ(field.originZ(), -0.5f);
}

TEST(PublicHeightfield, IsBilinearAndClampsAtItsEdge) {
  const Heightfield field = slope();
  EXPECT_EQ(field.at(-1, -0.5f), -2);
  EXPECT_EQ(field.at(1, 0.5f), 2);
  EXPECT_EQ(field.at(0, 0), 0);
  EXPECT_EQ(field.at(0.5f, 0.25f), 1);
  EXPECT_EQ(field.at(99, 0.5f), 2);
  EXPECT_EQ(field.at(-99, -99), -2);
}

TEST(PublicHeightfield, NormalsStandOnTheSlope) {
  const glm::vec3 expected = glm::normalize(glm::vec3(-1, 1, -2)), found = slope().normalAt(0.25f, 0.25f);
  EXPECT_LT(glm::distance(found, expected), 1e-6f);  // a few roundings of numbers below 2
}

TEST(PublicHeightfield, IsMirroredBeyondItsEdgeInPictures) {
  const Heightfield field = slope();
  for (const float beyond : {0.25f, 0.5f, 0.75f}) {
    EXPECT_NEAR(field.seenAt(1 + beyond, 0), field.at(1 - beyond, 0), 1e-6);
    EXPECT_NEAR(field.seenAt(0, -0.5f - beyond), field.at(0, -0.5f + beyond), 1e-6);
  }
}

TEST(PublicHeightfield, IsEditedInARectangle) {
  Heightfield field = slope();
  field.edit(1, 0, 2, 1, std::vector<float>{7, 8});
  EXPECT_EQ(field.heights, (std::vector<float>{-2, 7, 8, 0, 1, 2}));
}

TEST(PublicHeightfield, RefusesEditsThatCannotBeAndStaysAsItIs) {
  Heightfield field = slope();
  const std::vector<float> two{7, 8}, bad{7, noHeight};
  expectRefused("slope: an edit of 2 x 1 samples at 2, 0 leaves the 3 x 2",
                [&] { field.edit(2, 0, 2, 1, two); });
  expectRefused("leaves the 3 x 2", [&] { field.edit(UINT32_MAX, 0, 2, 1, two); });
  expectRefused("slope: an edit of 2 x 2 has 2 samples", [&] { field.edit(0, 0, 2, 2, two); });
  expectRefused("slope: an edit has a sample that is not finite", [&] { field.edit(0, 0, 2, 1, bad); });
  EXPECT_EQ(field.heights, slope().heights);
}

TEST(PublicHeightfield, RefusesToBeWhatItCannotBe) {
  EXPECT_NO_THROW(slope().check());
  const auto refusedWith = [](const std::string& text, const auto& change) {
    Heightfield field = slope();
    change(field);
    expectRefused("slope: " + text, [&] { field.check(); });
  };
  refusedWith("1 x 2 samples", [](Heightfield& field) { field.columns = 1; });
  refusedWith("3 x 2 samples with 5 heights", [](Heightfield& field) { field.heights.pop_back(); });
  refusedWith("a spacing of 0 m", [](Heightfield& field) { field.spacingZ = 0; });
  refusedWith("a spacing of nan m", [](Heightfield& field) { field.spacingX = noHeight; });
  refusedWith("height 4 is nan", [](Heightfield& field) { field.heights[4] = noHeight; });
  Heightfield none;
  expectRefused("0 x 0 samples", [&] { none.at(0, 0); });
  expectRefused("0 x 0 samples", [&] { none.normalAt(0, 0); });
  expectRefused("0 x 0 samples", [&] { none.seenAt(0, 0); });
  expectRefused("0 x 0 samples", [&] { none.edit(0, 0, 0, 0, {}); });
}

TEST(PublicHeightfield, NoiseIsTheSameForTheSameArguments) {
  const TerrainNoise noise{.columns = 33, .rows = 17, .seed = 5};
  const Heightfield field = generateHeightfield(noise);
  EXPECT_EQ(field.heights, generateHeightfield(noise).heights);
  TerrainNoise other = noise;
  other.seed = 6;
  EXPECT_NE(field.heights, generateHeightfield(other).heights);
  const auto [least, most] = std::ranges::minmax(field.heights);
  EXPECT_GT(most - least, 0.1f);
  EXPECT_NEAR(least + most, 0, 1e-5);
  expectRefused("terrain noise: columns is 1", [] { generateHeightfield({.columns = 1}); });
  expectRefused("terrain noise: gain is 2", [] { generateHeightfield({.gain = 2}); });
  expectRefused("terrain noise: octaves is 17", [] { generateHeightfield({.octaves = 17}); });
}

TEST(PublicHeightfield, IsReadFromAFile) {
  const OwnFolder folder;
  const float heights[] = {-1, 0.5f, 0, 1};
  const std::filesystem::path file =
      folder.with("own.r32f", std::string(reinterpret_cast<const char*>(heights), sizeof heights));
  const Heightfield field = loadHeightfield(file, {.spacingX = 2, .spacingZ = 3, .columns = 2, .rows = 2});
  EXPECT_EQ(field.columns, 2u);
  EXPECT_EQ(field.spacingZ, 3);
  ASSERT_EQ(field.heights.size(), 4u);
  for (size_t i = 0; i < 4; ++i) EXPECT_NEAR(field.heights[i], heights[i], 1e-6) << i;
  expectRefused("own.r32f", [&] { loadHeightfield(file, {.columns = 3, .rows = 3}); });
  expectRefused("nowhere.png", [&] { loadHeightfield(folder / "nowhere.png"); });
  expectRefused("own.txt", [&] { loadHeightfield(folder.with("own.txt", "1 2 3")); });
}

}  // namespace
}  // namespace skitter::test
