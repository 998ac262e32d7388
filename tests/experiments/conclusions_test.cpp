#include "experiments/conclusions.h"

#include <gtest/gtest.h>

namespace skitter::experiments {
namespace {

// By figures alone: turned round, they turn the verdict.
TEST(Conclusions, FollowTheFigures) {
  Results results;
  const auto verdict = [&](size_t i) { return conclusionsOf(results).at(i).holds; };
  results.simulated.limits = {{"clip", false, 16.7, 20, 21, 0, 0},
                              {"loop", false, 16.7, 9, 10, 0, 0},
                              {"adaptive", false, 16.7, 4, 5, 0, 0}};
  EXPECT_EQ(verdict(0), true);
  EXPECT_EQ(verdict(1), true);
  EXPECT_EQ(verdict(2), true);
  results.simulated.limits[2].agents = 30000;
  EXPECT_EQ(verdict(0), false);
  EXPECT_EQ(verdict(1), false);
  EXPECT_EQ(verdict(2), false);
}

// Other users of a software device's cores may turn what its wall clock says.
TEST(Conclusions, AreNotSettledWhereTheClocksDisagree) {
  Results results;
  const auto limit = [](const char* name, uint32_t agents, double byCpu) {
    return AgentLimit{name, false, 16.7, agents, agents + 1, 0, 0, byCpu};
  };
  results.simulated.limits = {limit("clip", 3000, 2000), limit("loop", 2000, 3000),
                              limit("adaptive", 1000, 1000)};
  const std::vector<Conclusion> conclusions = conclusionsOf(results);
  EXPECT_EQ(conclusions.at(0).holds, false);
  EXPECT_FALSE(conclusions.at(1).holds.has_value());
  EXPECT_EQ(verdictOf(conclusions.at(1)), "not settled");
}

TEST(Conclusions, WhatWasNotMeasuredHasNoVerdict) {
  for (const Conclusion& c : conclusionsOf({})) {
    if (c.measured == "not measured") {
      EXPECT_FALSE(c.holds.has_value()) << c.claim;
    }
  }
}

}  // namespace
}  // namespace skitter::experiments
