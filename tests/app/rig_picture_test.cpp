// What `skitter inspect` draws, held against app/rig/canvas.h and rig_picture.h.
#include "app/rig/rig_picture.h"

#include <gtest/gtest.h>
#include <png.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "../assets/files.h"
#include "app/rig/canvas.h"

namespace skitter::app {
namespace {

constexpr glm::vec3 black{0}, white{1};

// The share of light in a channel of a pixel.
float lightOf(uint8_t byte) {
  const float s = static_cast<float>(byte) / 255;
  return s <= 0.04045f ? s / 12.92f : std::pow((s + 0.055f) / 1.055f, 2.4f);
}

glm::vec3 lightAt(const Canvas& canvas, uint32_t width, uint32_t x, uint32_t y) {
  const std::vector<uint8_t> bytes = canvas.rgba();
  const uint8_t* at = &bytes.at(size_t{y * width + x} * 4);
  return {lightOf(at[0]), lightOf(at[1]), lightOf(at[2])};
}

void expectLight(const Canvas& canvas, uint32_t width, uint32_t x, uint32_t y, const glm::vec3& expected) {
  const glm::vec3 got = lightAt(canvas, width, x, y);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(got[k], expected[k], 0.006f) << x << ' ' << y << " channel " << k;
}

void fill(Canvas& canvas, const std::array<glm::vec3, 3>& corners, const glm::vec3& colour) {
  const std::array colours = {colour, colour, colour};
  canvas.triangle(corners.data(), colours.data());
}

TEST(Canvas, BytesAreSrgbAndOpaque) {
  const Canvas canvas(2, 1, {0.002f, 0.2158605f, 7});
  EXPECT_EQ(canvas.rgba(), (std::vector<uint8_t>{7, 128, 255, 255, 7, 128, 255, 255}));
}

// Two by two samples a pixel: the slanted side leaves three of the four in.
TEST(Canvas, TrianglesCoverWhatTheyContainEitherWayRound) {
  for (const bool turned : {false, true}) {
    Canvas canvas(8, 8, black);
    std::array<glm::vec3, 3> corners = {glm::vec3(0, 0, 0), {8, 0, 0}, {0, 8, 0}};
    if (turned) std::swap(corners[1], corners[2]);
    fill(canvas, corners, white);
    for (uint32_t y = 0; y < 8; ++y)
      for (uint32_t x = 0; x < 8; ++x)
        expectLight(canvas, 8, x, y, glm::vec3(x + y < 7 ? 1.0f : x + y == 7 ? 0.75f : 0.0f));
  }
}

TEST(Canvas, TrianglesThatReachBeyondAreCut) {
  Canvas canvas(4, 4, black);
  fill(canvas, {glm::vec3(-40, -40, 0), {60, -40, 0}, {-40, 60, 0}}, white);
  for (uint32_t y = 0; y < 4; ++y)
    for (uint32_t x = 0; x < 4; ++x) expectLight(canvas, 4, x, y, white);
}

TEST(Canvas, ColoursRunFromCornerToCorner) {
  Canvas canvas(8, 8, black);
  const std::array<glm::vec3, 3> corners = {glm::vec3(0, 0, 0), {8, 0, 0}, {0, 8, 0}};
  const std::array<glm::vec3, 3> colours = {glm::vec3(1, 0, 0), {0, 1, 0}, {0, 0, 1}};
  canvas.triangle(corners.data(), colours.data());
  expectLight(canvas, 8, 2, 1, {1 - (2.5f + 1.5f) / 8, 2.5f / 8, 1.5f / 8});
}

TEST(Canvas, TheNearerTriangleHidesTheOther) {
  for (const bool slantedFirst : {false, true}) {
    Canvas canvas(8, 8, black);
    // Rises toward the viewer from left to right; the other one is level with its middle.
    const auto slanted = [&] { fill(canvas, {glm::vec3(0, 0, 0), {16, 0, 16}, {0, 16, 0}}, {1, 0, 0}); };
    const auto level = [&] { fill(canvas, {glm::vec3(0, 0, 4), {16, 0, 4}, {0, 16, 4}}, {0, 1, 0}); };
    slantedFirst ? slanted() : level();
    slantedFirst ? level() : slanted();
    expectLight(canvas, 8, 2, 4, {0, 1, 0});
    expectLight(canvas, 8, 5, 2, {1, 0, 0});
  }
}

TEST(Canvas, LinesHaveTheirWidthAndRoundEndsAndLieOverAll) {
  Canvas canvas(8, 8, black);
  fill(canvas, {glm::vec3(0, 0, 9), {16, 0, 9}, {0, 16, 9}}, {0, 0, 1});
  canvas.line({2, 4, -5}, {6, 4, -5}, {1, 0, 0}, 2, 1);
  for (uint32_t x = 2; x < 6; ++x)
    for (uint32_t y = 0; y < 8; ++y)
      expectLight(canvas, 8, x, y, y == 3 || y == 4 ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, 1));
  for (const uint32_t x : {1u, 6u}) expectLight(canvas, 8, x, 3, {0.75f, 0, 0.25f});
  for (const uint32_t x : {0u, 7u}) expectLight(canvas, 8, x, 3, {0, 0, 1});
}

TEST(Canvas, OpacityMixes) {
  Canvas canvas(4, 4, {0, 1, 0});
  canvas.line({0, 2, 0}, {4, 2, 0}, {1, 0, 0}, 4, 0.25f);
  expectLight(canvas, 4, 1, 2, {0.25f, 0.75f, 0});
}

TEST(Canvas, DiscsAreRound) {
  Canvas canvas(9, 9, black);
  canvas.disc({4.5f, 4.5f, 0}, 3, white);
  double area = 0;
  for (uint32_t y = 0; y < 9; ++y)
    for (uint32_t x = 0; x < 9; ++x) {
      area += lightAt(canvas, 9, x, y).x;
      expectLight(canvas, 9, x, y, lightAt(canvas, 9, 8 - x, y));
      expectLight(canvas, 9, x, y, lightAt(canvas, 9, y, x));
    }
  EXPECT_NEAR(area, 3.14159 * 9, 1);
}

TEST(Canvas, WhatIsConfinedStaysInItsRectangle) {
  Canvas canvas(9, 7, black);
  canvas.confine(4, 2, 3, 4);
  canvas.line({1, 1, 0}, {1, 1, 0}, {1, 0, 0}, 100, 1);
  canvas.disc({0.5f, 0.5f, 0}, 0.5f, {0, 1, 0});
  for (uint32_t y = 0; y < 7; ++y)
    for (uint32_t x = 0; x < 9; ++x) {
      const bool inside = x >= 4 && x < 7 && y >= 2 && y < 6;
      const bool first = x == 4 && y == 2;
      expectLight(canvas, 9, x, y, first ? glm::vec3(0, 1, 0) : inside ? glm::vec3(1, 0, 0) : black);
    }
}

// A quarter of a picture. Its view fits what `seen` spans, in 88 % of the quarter, centred.
class Quarter {
 public:
  Quarter(std::vector<uint8_t> pixels, glm::uvec2 size, glm::uvec2 corner, const glm::vec3& right,
          const glm::vec3& up)
      : pixels_(std::move(pixels)), size_(size), corner_(corner), right_(right), up_(up) {}

  void fit(const std::vector<glm::vec3>& seen) {
    least_ = most_ = across(seen.at(0));
    for (const glm::vec3& p : seen) least_ = glm::min(least_, across(p)), most_ = glm::max(most_, across(p));
  }
  float scale() const {
    const glm::vec2 extent = glm::max(most_ - least_, glm::vec2(1e-3f));
    return 0.88f * std::min(static_cast<float>(size_.x) / extent.x, static_cast<float>(size_.y) / extent.y);
  }
  glm::vec2 project(const glm::vec3& p) const {
    const glm::vec2 offset = scale() * (across(p) - 0.5f * (least_ + most_));
    return 0.5f * glm::vec2(size_) + glm::vec2(offset.x, -offset.y);
  }
  glm::vec3 lightAt(const glm::vec2& p) const {
    const uint8_t* at =
        &pixels_.at((static_cast<size_t>(corner_.y + static_cast<uint32_t>(p.y)) * 2 * size_.x + corner_.x +
                     static_cast<uint32_t>(p.x)) *
                    4);
    return {lightOf(at[0]), lightOf(at[1]), lightOf(at[2])};
  }

 private:
  glm::vec2 across(const glm::vec3& p) const { return {glm::dot(p, right_), glm::dot(p, up_)}; }

  std::vector<uint8_t> pixels_;
  glm::uvec2 size_, corner_;
  glm::vec3 right_, up_;
  glm::vec2 least_{0}, most_{0};
};

// From ahead and aside, from the left, from the front, from above.
std::vector<Quarter> drawn(const Rig& rig, glm::uvec2 quarter, const std::vector<glm::vec3>& seen) {
  const test::TemporaryFolder folder;
  const auto file = folder / "rig.png";
  drawRig(rig, {2 * quarter.x, 2 * quarter.y}, file);
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  EXPECT_TRUE(png_image_begin_read_from_file(&image, file.c_str())) << image.message;
  EXPECT_EQ(glm::uvec2(image.width, image.height), 2u * quarter);
  image.format = PNG_FORMAT_RGBA;
  std::vector<uint8_t> pixels(PNG_IMAGE_SIZE(image));
  EXPECT_TRUE(png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr)) << image.message;

  const float turn = 0.7f, lift = 0.45f;
  const glm::vec3 aside(std::cos(turn), 0, -std::sin(turn));
  const glm::vec3 raised(-std::sin(lift) * std::sin(turn), std::cos(lift), -std::sin(lift) * std::cos(turn));
  std::vector<Quarter> quarters = {{pixels, quarter, {0, 0}, aside, raised},
                                   {pixels, quarter, {quarter.x, 0}, {0, 0, -1}, {0, 1, 0}},
                                   {pixels, quarter, {0, quarter.y}, {1, 0, 0}, {0, 1, 0}},
                                   {pixels, quarter, quarter, {-1, 0, 0}, {0, 0, 1}}};
  for (Quarter& each : quarters) each.fit(seen);
  return quarters;
}

constexpr glm::vec3 background{0.80f, 0.82f, 0.85f};

bool near(const glm::vec3& a, const glm::vec3& b) {
  const glm::vec3 d = glm::abs(a - b);
  return std::max({d.x, d.y, d.z}) < 0.01f;
}

Leg legAlong(const glm::vec3& direction, int group, const glm::vec3& home) {
  Leg leg;
  leg.group = group;
  Bone& bone = leg.bones.emplace_back();
  bone.direction = direction;
  bone.length = 2;
  leg.home = home;
  leg.reach = 2;
  return leg;
}

TEST(RigPicture, LegsLieWhereTheyAreSeenFromFourSides) {
  const std::array tips = {glm::vec3(2, 0, 0), glm::vec3(0, 2, 0), glm::vec3(0, 0, 2)};
  const std::array colours = {glm::vec3(0.90f, 0.18f, 0.02f), glm::vec3(0.02f, 0.16f, 0.80f),
                              glm::vec3(0.05f, 0.50f, 0.08f)};
  Rig rig;
  rig.legLength = 2;
  for (size_t i = 0; i < 3; ++i)
    rig.legs.push_back(legAlong(0.5f * tips[i], static_cast<int>(i), i == 1 ? glm::vec3(0) : tips[i]));
  for (const glm::uvec2 size : {glm::uvec2(120, 100), glm::uvec2(100, 130)}) {
    const std::vector<Quarter> quarters = drawn(rig, size, {tips[0], tips[1], tips[2], glm::vec3(0)});
    for (size_t view = 0; view < 4; ++view)
      for (size_t i = 0; i < 3; ++i) {
        SCOPED_TRACE(testing::Message() << "view " << view << ", leg " << i);
        const Quarter& quarter = quarters[view];
        const glm::vec2 root = quarter.project(glm::vec3(0)), tip = quarter.project(tips[i]);
        if (glm::distance(root, tip) < 10) continue;  // the view is along it
        for (const float share : {0.4f, 0.7f, 1.0f})
          EXPECT_TRUE(near(quarter.lightAt(glm::mix(root, tip, share)), colours[i])) << share;
        // A disc, wider than the bone, and nothing beyond it.
        const glm::vec2 along = glm::normalize(tip - root), beside(-along.y, along.x);
        EXPECT_TRUE(near(quarter.lightAt(tip + 2.4f * beside), colours[i]));
        EXPECT_FALSE(near(quarter.lightAt(tip + 5.5f * along), colours[i]));
      }
  }
}

TEST(RigPicture, AConeIsACircleWithFourSpokes) {
  Rig rig;
  rig.legLength = 2;
  for (const float side : {-2.0f, 2.0f}) {
    rig.legs.push_back(legAlong({0, 0, 1}, 0, {side, 0, 0}));
    rig.legs.back().bones[0].coneHalfAngle = 0.5f;
  }
  const Quarter front =
      drawn(rig, {480, 400}, {glm::vec3(-2, 0, 0), glm::vec3(2, 0, 0), glm::vec3(0, 0, 2)})[2];
  const auto marked = [&](float radius, double turns) {
    const auto angle = static_cast<float>(2 * std::numbers::pi * turns);
    const glm::vec3 at(radius * std::cos(angle), radius * std::sin(angle), 0);
    return !near(front.lightAt(front.project(at)), background);
  };
  const float rim = 0.4f * 2 * std::sin(0.5f);
  for (int step = 1; step < 28; ++step) {
    if (step == 14) continue;  // on the line between the homes
    EXPECT_TRUE(marked(rim, step / 28.0)) << step;
    EXPECT_FALSE(marked(1.15f * rim, step / 28.0)) << step;
    EXPECT_EQ(marked(0.6f * rim, step / 28.0), step % 7 == 0) << step;
  }
}

TEST(RigPicture, SkinIsPaleAndLitFromAbove) {
  Rig rig;
  rig.legs = {legAlong({1, 0, 0}, 0, {2, 0, 0})};
  for (const glm::vec3& corner : {glm::vec3(-2, 0, -2), glm::vec3(-2, 0, 2), glm::vec3(2, 0, 2)}) {
    SkinVertex& vertex = rig.vertices.emplace_back();
    vertex.position = corner;
    vertex.colour = {1, 0, 0};
  }
  rig.indices = {0, 1, 2};
  const Quarter above =
      drawn(rig, {120, 100}, {glm::vec3(-2, 0, -2), glm::vec3(-2, 0, 2), glm::vec3(2, 0, 2)})[3];
  const float lit = 0.45f + 0.55f * 1.5f / std::hypot(1.5f, 0.3f);
  EXPECT_TRUE(near(above.lightAt(above.project({-1, 0, 1})), lit * glm::vec3(0.78f, 0.33f, 0.33f)));
  EXPECT_TRUE(near(above.lightAt(above.project({1.5f, 0, -1.5f})), background));
}

}  // namespace
}  // namespace skitter::app
