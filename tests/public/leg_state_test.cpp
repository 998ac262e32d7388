#include "skitter/leg_state.h"

#include <set>

#include "public/public.h"

namespace skitter::test {
namespace {

TEST(PublicLegState, IsFoundByItsName) {
  std::set<std::string> names;
  for (const LegState each : allLegStates) {
    names.insert(nameOf(each));
    EXPECT_EQ(legStateNamed(nameOf(each)), each);
  }
  EXPECT_EQ(names.size(), allLegStates.size());
  EXPECT_EQ(legStateNamed("broken"), std::nullopt);
}

}  // namespace
}  // namespace skitter::test
