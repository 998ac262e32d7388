#include "skitter/error.h"

#include <gtest/gtest.h>

namespace skitter::test {
namespace {

TEST(Error, DetailLeavesOutTheNameThatTheMessageBeginsWith) {
  EXPECT_EQ(inputError("crab.glb: has no legs").detail("crab.glb"), "has no legs");
  EXPECT_EQ(inputError("a: b.glb: has no legs").detail("a: b.glb"), "has no legs");
  EXPECT_EQ(inputError("a\nb.glb: has no legs").detail("a\nb.glb"), "has no legs");
}

TEST(Error, DetailIsTheWholeMessageOfAnotherName) {
  EXPECT_EQ(inputError("crab.glb: has no legs").detail("rab.glb"), "crab.glb: has no legs");
  EXPECT_EQ(inputError("crab.glb has no legs").detail("crab.glb"), "crab.glb has no legs");
}

}  // namespace
}  // namespace skitter::test
