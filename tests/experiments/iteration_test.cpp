#include "experiments/iteration.h"

#include <gtest/gtest.h>

namespace skitter::experiments {
namespace {

TEST(Iteration, KeepsBonesAndComesNearer) {
  const FabrikIteration it = measureIteration();
  EXPECT_LT(it.errorAfter(), it.errorBefore());
  EXPECT_LT(glm::distance(it.backward.back(), it.target), 1e-12);
  EXPECT_LT(glm::length(it.forward.front()), 1e-12);
  for (const auto* joints : {&it.before, &it.backward, &it.forward})
    for (size_t i = 1; i < joints->size(); ++i)
      EXPECT_NEAR(glm::distance((*joints)[i - 1], (*joints)[i]), 0.25, 1e-12);
}

}  // namespace
}  // namespace skitter::experiments
