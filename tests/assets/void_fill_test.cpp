#include "assets/heights/void_fill.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

namespace skitter {
namespace {

constexpr float hole = std::numeric_limits<float>::quiet_NaN();

TEST(VoidFill, CountsAndLeavesTheRestAlone) {
  std::vector<float> values = {1, 2, 3, 4, 5, 6};
  EXPECT_EQ(fillVoids(values, 3, 2), 0u);
  EXPECT_EQ(values, (std::vector<float>{1, 2, 3, 4, 5, 6}));
  std::vector<float> nothing(6, hole);
  EXPECT_EQ(fillVoids(nothing, 3, 2), 6u);
  std::vector<float> tiny = {hole, hole, hole, 5};
  EXPECT_EQ(fillVoids(tiny, 2, 2), 3u);
  EXPECT_EQ(tiny, std::vector<float>(4, 5));
}

// A slope satisfies Laplace's equation: a hole in it must be filled by the slope itself.
TEST(VoidFill, HolesInASlopeAreTheSlope) {
  for (const auto& [columns, rows] : {std::pair{100u, 73u}, {64u, 64u}, {2u, 50u}, {333u, 3u}}) {
    std::vector<float> slope(size_t{columns} * rows), values;
    for (uint32_t k = 0; k < slope.size(); ++k) {
      slope[k] = 0.5f * static_cast<float>(k % columns) - 0.25f * static_cast<float>(k / columns);
    }
    values = slope;
    uint64_t holes = 0;
    for (uint32_t j = 1; j + 1 < rows; ++j) {
      for (uint32_t i = 1; i + 1 < columns; ++i) {
        if ((i / 9 + j / 7) % 2 == 0 || i % 5 == 3) {
          values[size_t{j} * columns + i] = hole;
          ++holes;
        }
      }
    }
    EXPECT_EQ(fillVoids(values, columns, rows), holes);
    for (size_t k = 0; k < slope.size(); ++k) ASSERT_NEAR(values[k], slope[k], 0.1) << columns << " " << k;
  }
}

TEST(VoidFill, OneLargeHoleInASlope) {
  constexpr uint32_t side = 257;
  std::vector<float> values(side * side);
  for (uint32_t k = 0; k < values.size(); ++k) {
    const uint32_t i = k % side, j = k / side;
    const bool edge = i == 0 || j == 0 || i + 1 == side || j + 1 == side;
    values[k] = edge ? static_cast<float>(i) : hole;
  }
  EXPECT_EQ(fillVoids(values, side, side), uint64_t{side - 2} * (side - 2));
  float worst = 0;
  for (uint32_t k = 0; k < values.size(); ++k) {
    worst = std::max(worst, std::fabs(values[k] - static_cast<float>(k % side)));
  }
  // Few sweeps leave a little of what the coarse grids got wrong about the hole's outline.
  EXPECT_LT(worst, 0.02f * side);
}

TEST(VoidFill, StaysWithinTheRangeAndRepeats) {
  constexpr uint32_t columns = 201, rows = 155;
  std::vector<float> values(columns * rows, hole);
  for (uint32_t k = 0; k < values.size(); k += 37) values[k] = static_cast<float>((k * 7919u) % 1000);
  std::vector<float> again = values;
  fillVoids(values, columns, rows);
  fillVoids(again, columns, rows);
  EXPECT_EQ(values, again);
  for (const float value : values) {
    EXPECT_GE(value, 0);
    EXPECT_LE(value, 999);
  }
}

TEST(VoidFill, AnSrtmTileThatIsMostlyVoidTakesSeconds) {
  constexpr uint32_t side = 3601;
  std::vector<float> values(size_t{side} * side, hole);
  for (uint32_t k = 0; k < values.size(); ++k) {
    const uint32_t i = k % side, j = k / side;
    if (i < side / 4 || (i % 601 < 40 && j % 499 < 40)) values[k] = static_cast<float>(i + j);
  }
  const auto start = std::chrono::steady_clock::now();
  EXPECT_GT(fillVoids(values, side, side), uint64_t{side} * side / 2);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(60));
  EXPECT_FALSE(std::any_of(values.begin(), values.end(), [](float value) { return std::isnan(value); }));
}

}  // namespace
}  // namespace skitter
