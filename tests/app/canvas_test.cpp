// A canvas draws the pictures of `skitter inspect` in software.
#include "app/rig/canvas.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace skitter::test {
namespace {

constexpr uint32_t width = 100, height = 40;

std::vector<uint8_t> drawn(const std::array<glm::vec3, 3>& corners) {
  app::Canvas canvas(width, height, glm::vec3(0));
  canvas.triangle(corners.data(), [](const glm::vec3&) { return glm::vec3(1); });
  return canvas.rgba();
}

// Counts the pixels that are covered at least in part, and those that are covered whole.
std::pair<uint32_t, uint32_t> coveredIn(const std::vector<uint8_t>& rgba) {
  std::pair<uint32_t, uint32_t> counts;
  for (size_t i = 0; i < rgba.size(); i += 4) {
    counts.first += rgba[i] > 0;
    counts.second += rgba[i] == 255;
  }
  return counts;
}

TEST(Canvas, ATriangleCoversItsAreaWhateverItsCornersOrder) {
  std::array<glm::vec3, 3> corners{{{60, 2, 0}, {95, 30, 0}, {50, 38, 0}}};
  const glm::vec3 u = corners[1] - corners[0], v = corners[2] - corners[0];
  const float area = 0.5f * std::abs(u.x * v.y - u.y * v.x);
  const std::vector<uint8_t> first = drawn(corners);
  const auto [some, all] = coveredIn(first);
  EXPECT_GT(static_cast<float>(some), area);
  EXPECT_LT(static_cast<float>(all), area);
  EXPECT_LT(some - all, 2 * (width + height));  // the pixels of its edges
  const auto before = [](const glm::vec3& a, const glm::vec3& b) { return a.x < b.x; };
  std::sort(corners.begin(), corners.end(), before);
  do EXPECT_EQ(coveredIn(drawn(corners)), coveredIn(first));
  while (std::next_permutation(corners.begin(), corners.end(), before));
}

// One lies in the picture's plane, the other one tips out of it to the left and into it to the right.
TEST(Canvas, TheNearerTriangleHidesTheOther) {
  const std::array<glm::vec3, 3> flat{{{-300, -300, 0}, {500, -300, 0}, {0, 700, 0}}},
      tipped{{{0, 20, 10}, {100, -80, -10}, {100, 120, -10}}};
  for (const bool flatFirst : {true, false}) {
    app::Canvas canvas(width, height, glm::vec3(0));
    const auto drawFlat = [&] {
      canvas.triangle(flat.data(), [](const glm::vec3&) { return glm::vec3(1, 0, 0); });
    };
    if (flatFirst) drawFlat();
    canvas.triangle(tipped.data(), [](const glm::vec3&) { return glm::vec3(0, 1, 0); });
    if (!flatFirst) drawFlat();
    const std::vector<uint8_t> rgba = canvas.rgba();
    for (const uint32_t x : {10u, 30u, 48u, 52u, 70u, 99u}) {
      const size_t pixel = 4 * (20 * width + x);
      EXPECT_EQ(rgba[pixel] == 255, x >= 50) << x;
      EXPECT_EQ(rgba[pixel + 1] == 255, x < 50) << x;
    }
  }
}

TEST(Canvas, WhatReachesBeyondItIsCut) {
  const auto [some, all] = coveredIn(drawn({{{-200, -300, 0}, {500, -10, 0}, {-10, 400, 0}}}));
  EXPECT_EQ(all, width * height);
  EXPECT_EQ(coveredIn(drawn({{{-9, -9, 0}, {-1, -9, 0}, {-9, -1, 0}}})).first, 0u);
}

}  // namespace
}  // namespace skitter::test
