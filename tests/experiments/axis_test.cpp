#include "experiments/page/axis.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace skitter::experiments {
namespace {

std::vector<std::string> labels(const Axis& axis) {
  std::vector<std::string> made;
  for (const Tick& tick : axis.ticks())
    if (!tick.label.empty()) made.push_back(tick.label);
  return made;
}

TEST(Axis, RoundsALinearRangeOutToTicks) {
  const Axis axis({}, {0.3, 9.7});
  EXPECT_EQ(axis.least(), 0);
  EXPECT_EQ(axis.most(), 10);
  EXPECT_EQ(labels(axis), (std::vector<std::string>{"0", "2", "4", "6", "8", "10"}));
  EXPECT_DOUBLE_EQ(axis.place(0), 0);
  EXPECT_DOUBLE_EQ(axis.place(5), 0.5);
  EXPECT_DOUBLE_EQ(axis.place(10), 1);
}

TEST(Axis, TicksAreRoundNumbersFarFromZeroToo) {
  const Axis axis({}, {-0.31, 0.29});
  for (const Tick& tick : axis.ticks()) {
    EXPECT_NEAR(std::fmod(std::fabs(tick.value) + 1e-12, 0.1), 0, 1e-9) << tick.value;
    EXPECT_LE(tick.label.size(), 4u) << tick.label;
  }
}

TEST(Axis, KeepsGivenEnds) {
  const Axis axis({.least = 0.0, .most = 0.7}, {0.2, 0.3});
  EXPECT_EQ(axis.least(), 0);
  EXPECT_EQ(axis.most(), 0.7);
}

TEST(Axis, LogarithmicDecadesLieEvenly) {
  const Axis axis({.log = true}, {1, 1000});
  EXPECT_DOUBLE_EQ(axis.place(1), 0);
  EXPECT_NEAR(axis.place(10), 1.0 / 3, 1e-12);
  EXPECT_NEAR(axis.place(1000), 1, 1e-12);
  EXPECT_EQ(labels(axis), (std::vector<std::string>{"1", "10", "100", "1000"}));
}

TEST(Axis, ShortLogarithmicRangesNameTwoAndFive) {
  const Axis axis({.log = true}, {2.5, 42});
  EXPECT_EQ(axis.least(), 2);
  EXPECT_EQ(axis.most(), 50);
  EXPECT_EQ(labels(axis), (std::vector<std::string>{"2", "5", "10", "20", "50"}));
}

TEST(Axis, ManyDecadesNameAFew) {
  const Axis axis({.log = true}, {1e-36, 1});
  EXPECT_LE(labels(axis).size(), 9u);
  EXPECT_GE(labels(axis).size(), 4u);
}

TEST(Axis, NothingOrOneValueIsStillARange) {
  for (const bool log : {false, true}) {
    for (const std::vector<double>& values : {std::vector<double>{}, {5}, {5, 5, 5}}) {
      const Axis axis({.log = log}, values);
      EXPECT_GT(axis.most(), axis.least());
      EXPECT_FALSE(axis.ticks().empty());
      for (const double value : values) {
        EXPECT_GE(axis.place(value), 0);
        EXPECT_LE(axis.place(value), 1);
      }
    }
  }
}

TEST(Axis, WhatCannotBeDrawnDoesNotCount) {
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  const Axis axis({.log = true}, {nan, infinity, 0, -3, 10, 100});
  EXPECT_EQ(axis.least(), 10);
  EXPECT_EQ(axis.most(), 100);
  EXPECT_FALSE(axis.holds(0));
  EXPECT_FALSE(axis.holds(nan));
  EXPECT_TRUE(Axis({}, {1}).holds(-3));
}

}  // namespace
}  // namespace skitter::experiments
