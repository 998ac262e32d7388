#include "bench/statistics.h"

#include <gtest/gtest.h>

namespace skitter::bench {
namespace {

TEST(Statistics, Quantiles) {
  EXPECT_DOUBLE_EQ(quantile({3}, 0.5), 3);
  EXPECT_DOUBLE_EQ(quantile({4, 1, 3, 2}, 0.5), 2.5);
  EXPECT_DOUBLE_EQ(quantile({5, 1, 2, 4, 3}, 0.25), 2);
  EXPECT_DOUBLE_EQ(quantile({5, 1, 2, 4, 3}, 1), 5);
}

}  // namespace
}  // namespace skitter::bench
