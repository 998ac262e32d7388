#include "experiments/other_work.h"

#include <gtest/gtest.h>

#include <chrono>

namespace skitter::experiments {
namespace {

TEST(OtherWork, ReadsWhatTheSystemTells) {
  const auto times = parseCpuTimes("cpu  100 20 30 400 50 6 7 8 90 9", 100);
  ASSERT_TRUE(times);
  EXPECT_NEAR(times->busy, 1.71, 1e-12);
  EXPECT_NEAR(times->all, 6.21, 1e-12);
  EXPECT_FALSE(parseCpuTimes("cpu0 1 2 3 4 5 6 7 8", 100));
  EXPECT_FALSE(parseCpuTimes("cpu 1 2 3", 100));
  EXPECT_FALSE(parseCpuTimes("", 100));
}

// What this process does itself is no other work: all of the machine's time is its own, others' or idle.
TEST(OtherWork, IsAShare) {
  const OtherWork work;
  const auto until = std::chrono::steady_clock::now() + std::chrono::milliseconds(50);
  while (std::chrono::steady_clock::now() < until) {
  }
  const auto share = work.share();
  ASSERT_TRUE(share);
  EXPECT_GE(*share, 0);
  EXPECT_LE(*share, 1);
}

}  // namespace
}  // namespace skitter::experiments
