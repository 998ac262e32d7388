// Pipelines are specialised by some tuning values, so these must hold while a crowd lives.
#include "crowd/tuning.h"

#include <gtest/gtest.h>

#include <set>

#include "crowd/simulation.h"

namespace skitter::test {
namespace {

TEST(KnownParameters, DoNotFollowTheTick) {
  const auto tuning = [](float dt) {
    return crowd::tuningFor(spiderRig(), crowd::ikPlanFor("active-set"), rollingGround(), dt);
  };
  const shared::Parameters slow = tuning(1.0f / 20), quick = tuning(1.0f / 240);
  EXPECT_NE(slow.heightBlend, quick.heightBlend);
#define EXPECT_KNOWN(number, name) EXPECT_EQ(slow.name, quick.name) << #name;
  KNOWN_PARAMETERS(EXPECT_KNOWN)
#undef EXPECT_KNOWN
}

TEST(KnownParameters, HaveNumbersOfTheirOwn) {
  std::set<int> numbers;
#define EXPECT_NEW(number, name) EXPECT_TRUE(numbers.insert(number).second) << #name;
  KNOWN_PARAMETERS(EXPECT_NEW)
#undef EXPECT_NEW
}

}  // namespace
}  // namespace skitter::test
