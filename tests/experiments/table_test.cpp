#include "experiments/page/table.h"

#include <gtest/gtest.h>

#include <cmath>

namespace skitter::experiments {
namespace {

TEST(Table, CsvQuotesWhatMustBe) {
  const Table table{{"a", "b"}, {{"1", "x, y"}, {"2", "said \"no\""}}};
  EXPECT_EQ(table.csv(), "a,b\n1,\"x, y\"\n2,\"said \"\"no\"\"\"\n");
}

TEST(Table, FiguresHaveThreeDigits) {
  EXPECT_EQ(figure(0), "0");
  EXPECT_EQ(figure(1), "1.00");
  EXPECT_EQ(figure(12.345), "12.3");
  EXPECT_EQ(figure(-0.0123456), "-0.0123");
  EXPECT_EQ(figure(12345), "12345");
  EXPECT_EQ(figure(1.5e-7), "1.5e-07");
  EXPECT_EQ(figure(0.123, 2), "0.12");
}

TEST(Table, WhatIsNoNumberIsADash) {
  EXPECT_EQ(figure(std::nan("")), "-");
  EXPECT_EQ(figure(HUGE_VAL), "-");
}

}  // namespace
}  // namespace skitter::experiments
