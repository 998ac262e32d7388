#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "files.h"
#include "skitter/heightfield.h"

namespace skitter {
namespace {

TEST(TerrainNoise, SameBitsForTheSameArguments) {
  TerrainNoise noise;
  noise.columns = 65;
  noise.rows = 33;
  const Heightfield a = generateHeightfield(noise), b = generateHeightfield(noise);
  EXPECT_EQ(a.heights, b.heights);
  EXPECT_EQ(a.columns, 65u);
  EXPECT_EQ(a.rows, 33u);
  noise.seed = 2;
  EXPECT_NE(generateHeightfield(noise).heights, a.heights);
}

TEST(TerrainNoise, BitsAreTheOnesOnRecord) {
  TerrainNoise noise;
  noise.columns = noise.rows = 65;
  uint64_t hash = 14695981039346656037u;  // FNV-1a of the heights' bits
  for (float height : generateHeightfield(noise).heights) {
    uint32_t bits = 0;
    std::memcpy(&bits, &height, sizeof(bits));
    for (int shift = 0; shift < 32; shift += 8) hash = (hash ^ (bits >> shift & 255)) * 1099511628211u;
  }
  EXPECT_EQ(hash, 3316976902313242472u);
}

TEST(TerrainNoise, DefaultIsHillyAndWalkable) {
  const Heightfield field = generateHeightfield({});
  const auto [low, high] = std::minmax_element(field.heights.begin(), field.heights.end());
  EXPECT_NEAR(*low + *high, 0, 1e-4);
  EXPECT_GT(*high - *low, 4);
  EXPECT_LT(*high - *low, 20);
  size_t steep = 0;
  double roughness = 0;
  size_t count = 0;
  for (uint32_t j = 1; j + 1 < field.rows; ++j) {
    for (uint32_t i = 1; i + 1 < field.columns; ++i, ++count) {
      const float* h = field.heights.data() + size_t{j} * field.columns + i;
      const float dx = (h[1] - h[0]) / field.spacingX, dz = (h[field.columns] - h[0]) / field.spacingZ;
      steep += std::atan(std::hypot(dx, dz)) > 35 * 3.14159265 / 180;
      // How far a sample stands off the mean of its neighbours: the small bumps.
      roughness += std::fabs(h[0] - 0.5f * (h[-1] + h[1]));
    }
  }
  EXPECT_LT(static_cast<double>(steep), 0.01 * static_cast<double>(count));
  EXPECT_GT(roughness / static_cast<double>(count), 0.01);
  EXPECT_LT(roughness / static_cast<double>(count), 0.10);
}

TEST(TerrainNoise, RefusesWhatIsNotSane) {
  const auto fault = [](auto change) {
    TerrainNoise noise;
    change(noise);
    return test::inputFault([&] { generateHeightfield(noise); });
  };
  EXPECT_NE(fault([](TerrainNoise& n) { n.columns = 1; }).find("columns"), std::string::npos);
  EXPECT_NE(fault([](TerrainNoise& n) { n.rows = 16385; }).find("rows"), std::string::npos);
  EXPECT_NE(fault([](TerrainNoise& n) { n.spacing = 0; }).find("spacing"), std::string::npos);
  EXPECT_NE(fault([](TerrainNoise& n) { n.octaves = 0; }).find("octaves"), std::string::npos);
  EXPECT_NE(
      fault([](TerrainNoise& n) { n.gain = std::numeric_limits<float>::quiet_NaN(); }).find("gain is nan"),
      std::string::npos);
  EXPECT_NE(
      fault([](TerrainNoise& n) { n.amplitude = std::numeric_limits<float>::infinity(); }).find("amplitude"),
      std::string::npos);
}

}  // namespace
}  // namespace skitter
