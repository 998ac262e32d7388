#include "cpu_reference/heightfield.h"

#include <gtest/gtest.h>

#include "spider.h"
#include "validation/convert.h"

namespace skitter::test {
namespace {

TEST(Heightfield, planeIsReproducedExactly) {
  const Heightfield plane = field(33, 0.5f, [](double x, double z) { return 0.25 * x - 0.5 * z + 1; });
  const auto heights = validation::heightsOf(plane, parametersFor(plane));
  const glm::dvec3 normal = glm::normalize(glm::dvec3(-0.25, 1, 0.5));
  for (double x = -7.9; x < 8; x += 0.37) {
    for (double z = -7.9; z < 8; z += 0.41) {
      EXPECT_NEAR(reference::heightAt(heights, x, z), 0.25 * x - 0.5 * z + 1, 1e-12);
      EXPECT_NEAR(glm::length(reference::normalAt(heights, x, z) - normal), 0, 1e-12);
    }
  }
}

TEST(Heightfield, cellIsBilinear) {
  const Heightfield saddle = field(2, 1, [](double x, double z) { return x * z; });
  const auto heights = validation::heightsOf(saddle, parametersFor(saddle));
  EXPECT_NEAR(reference::heightAt(heights, 0.25, -0.375), 0.25 * -0.375, 1e-12);
}

TEST(Heightfield, edgesClamp) {
  const Heightfield plane = field(33, 0.5f, [](double x, double z) { return x + 2 * z; });
  const auto heights = validation::heightsOf(plane, parametersFor(plane));
  EXPECT_DOUBLE_EQ(reference::heightAt(heights, 100, 0), 8);
  EXPECT_DOUBLE_EQ(reference::heightAt(heights, 0, -100), -16);
  EXPECT_DOUBLE_EQ(reference::heightAt(heights, -8, -8), -24);
  EXPECT_DOUBLE_EQ(reference::heightAt(heights, 8, 8), 24);
}

TEST(Heightfield, columnsRunToXAndRowsToZ) {
  Heightfield terrain;
  terrain.columns = 3;
  terrain.rows = 2;
  terrain.heights = {0, 1, 2, 10, 11, 12};
  const auto heights = validation::heightsOf(terrain, parametersFor(terrain));
  EXPECT_DOUBLE_EQ(reference::heightAt(heights, 1, -0.5), 2);
  EXPECT_DOUBLE_EQ(reference::heightAt(heights, -1, 0.5), 10);
}

TEST(Heightfield, reliefBoundsSlopes) {
  const Heightfield plane = field(33, 0.5f, [](double x, double z) { return 0.25 * x - 0.5 * z; });
  const auto relief = reference::reliefNear(validation::heightsOf(plane, parametersFor(plane)), 1.1, 2.2);
  EXPECT_NEAR(relief.slopeX, 0.25, 1e-6);
  EXPECT_NEAR(relief.slopeZ, 0.5, 1e-6);
}

}  // namespace
}  // namespace skitter::test
