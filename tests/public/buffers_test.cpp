#include "skitter/buffers.h"

#include <set>

#include "public/public.h"

namespace skitter::test {
namespace {

TEST(PublicRecordBuffer, FindsRecordsOfAgentsOneAfterTheOther) {
  const RecordBuffer bodies{.firstAgent = 2, .agents = 9, .first = 5, .stride = 4};
  EXPECT_EQ(bodies.recordAt(2), 20u);
  EXPECT_EQ(bodies.recordAt(4), 28u);
}

// Eight agents' first legs, then their second ones: no two records are in one place, and none is beyond the
// blocks of eight that the agents are in.
TEST(PublicRecordBuffer, FindsRecordsOfLegsInTheirBlocks) {
  const RecordBuffer steps{.firstAgent = 0, .agents = 20, .first = 3, .stride = 2, .legs = 5};
  EXPECT_EQ(steps.recordAt(0, 0), 2u * 3);
  EXPECT_EQ(steps.recordAt(0, 1), 2u * (8 + 3));
  EXPECT_EQ(steps.recordAt(5, 0), 2u * (5 * 8));
  std::set<uint32_t> places;
  for (uint32_t agent = 0; agent < 20; ++agent)
    for (uint32_t leg = 0; leg < 5; ++leg) {
      const uint32_t at = steps.recordAt(agent, leg);
      EXPECT_EQ(at % 2, 0u);
      EXPECT_LT(at, 2u * 24 * 5);
      EXPECT_TRUE(places.insert(at).second) << agent << ", " << leg;
    }
}

}  // namespace
}  // namespace skitter::test
