#include "crowd/support.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace skitter::test {
namespace {

using crowd::SupportPolygon;
using Feet = std::vector<glm::dvec2>;

TEST(SupportPolygon, HasItsEdgesAsFarAwayAsTheyAre) {
  // A square of 4, a corner of which is there twice, and feet within it and on an edge.
  const SupportPolygon square(Feet{{2, 2}, {-2, -2}, {2, -2}, {-2, 2}, {2, 2}, {0, 1}, {2, 0}});
  EXPECT_DOUBLE_EQ(square.marginOf({0, 0}), 2);
  EXPECT_DOUBLE_EQ(square.marginOf({1.5, 0}), 0.5);
  EXPECT_DOUBLE_EQ(square.marginOf({2, 1}), 0);
  EXPECT_DOUBLE_EQ(square.marginOf({0, -3}), -1);
  const SupportPolygon triangle(Feet{{0, 2}, {-1, -1}, {1, -1}});
  EXPECT_DOUBLE_EQ(triangle.marginOf({0, -0.5}), 0.5);
  // The slanted edges go through (0, 2) with a slope of 3.
  EXPECT_NEAR(triangle.marginOf({0, 1}), 1 / std::sqrt(10), 1e-12);
  EXPECT_LT(triangle.marginOf({1, 1}), 0);
}

TEST(SupportPolygon, OfALineOrAPointHasNoInside) {
  const SupportPolygon line(Feet{{0, 0}, {0, 2}});
  EXPECT_EQ(line.marginOf({0, 1}), 0);
  EXPECT_DOUBLE_EQ(line.marginOf({0.5, 1}), -0.5);
  EXPECT_DOUBLE_EQ(line.marginOf({0, 3}), -1);
  const SupportPolygon row(Feet{{0, 0}, {0, 1}, {0, 2}});
  EXPECT_EQ(row.marginOf({0, 1.5}), 0);
  EXPECT_DOUBLE_EQ(row.marginOf({3, 1}), -3);
  EXPECT_DOUBLE_EQ(SupportPolygon(Feet{{1, 1}}).marginOf({1, 3}), -2);
  EXPECT_EQ(SupportPolygon(Feet{}).marginOf({0, 0}), -std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace skitter::test
