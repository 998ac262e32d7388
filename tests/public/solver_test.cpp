#include "skitter/solver.h"

#include <algorithm>

#include "public/public.h"

namespace skitter::test {
namespace {

TEST(PublicSolver, IsFoundByItsName) {
  for (const Solver each : allSolvers) EXPECT_EQ(solverNamed(nameOf(each)), each);
  EXPECT_EQ(solverNamed("dls"), Solver::dampedLeastSquares);
  EXPECT_EQ(solverNamed("guess"), std::nullopt);
}

TEST(PublicSolver, HerdsHaveSomeOfAll) {
  for (const Solver each : herdSolvers)
    EXPECT_NE(std::ranges::find(allSolvers, each), allSolvers.end()) << nameOf(each);
}

}  // namespace
}  // namespace skitter::test
