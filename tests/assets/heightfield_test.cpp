#include "skitter/heightfield.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace skitter {
namespace {

// Heights 0 1 2 / 10 11 12, 2 m apart in x and 4 m in z.
Heightfield rampGround() {
  Heightfield field;
  field.columns = 3;
  field.rows = 2;
  field.spacingX = 2;
  field.spacingZ = 4;
  field.heights = {0, 1, 2, 10, 11, 12};
  return field;
}

TEST(Heightfield, IsCentredOnTheOrigin) {
  EXPECT_EQ(rampGround().originX(), -2);
  EXPECT_EQ(rampGround().originZ(), -2);
  EXPECT_EQ(rampGround().extentX(), 4);
  EXPECT_EQ(rampGround().extentZ(), 4);
}

TEST(Heightfield, MeetsItsSamples) {
  const Heightfield field = rampGround();
  EXPECT_EQ(field.at(-2, -2), 0);
  EXPECT_EQ(field.at(0, -2), 1);
  EXPECT_EQ(field.at(2, -2), 2);
  EXPECT_EQ(field.at(-2, 2), 10);
  EXPECT_EQ(field.at(2, 2), 12);
}

TEST(Heightfield, IsBilinearBetween) {
  const Heightfield field = rampGround();
  EXPECT_FLOAT_EQ(field.at(-1, -2), 0.5f);
  EXPECT_FLOAT_EQ(field.at(0, 0), 6);
  EXPECT_FLOAT_EQ(field.at(1.5f, 1), 1.75f + 7.5f);
}

TEST(Heightfield, ClampsOutside) {
  const Heightfield field = rampGround();
  EXPECT_EQ(field.at(-100, -100), 0);
  EXPECT_EQ(field.at(100, 1e30f), 12);
  EXPECT_FLOAT_EQ(field.at(-1e30f, 0), 5);
  EXPECT_TRUE(std::isfinite(field.at(std::numeric_limits<float>::quiet_NaN(), 0)));
}

TEST(Heightfield, HasTheNormalOfItsSlopes) {
  // 0.5 m a metre along x, 2.5 along z.
  for (const glm::vec2 place : {glm::vec2(0, 0), {-2, -2}, {1.9f, 1.5f}, {100, -100}})
    EXPECT_LT(
        glm::distance(rampGround().normalAt(place.x, place.y), glm::normalize(glm::vec3(-0.5f, 1, -2.5f))),
        1e-6f);
  // Of a surface that is bent, by differences.
  Heightfield bent = rampGround();
  bent.heights[4] = -3;
  const float x = 0.7f, z = 0.9f, step = 0.01f;
  const float slopeX = (bent.at(x + step, z) - bent.at(x - step, z)) / (2 * step);
  const float slopeZ = (bent.at(x, z + step) - bent.at(x, z - step)) / (2 * step);
  EXPECT_LT(glm::distance(bent.normalAt(x, z), glm::normalize(glm::vec3(-slopeX, 1, -slopeZ))), 1e-4f);
}

}  // namespace
}  // namespace skitter
