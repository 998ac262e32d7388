#include "skitter/steering.h"

#include "public/public.h"

namespace skitter::test {
namespace {

TEST(PublicAgentId, HoldsItsNumbers) {
  const AgentId id(1023, (1u << 24) - 1, (1u << 30) - 1);
  EXPECT_EQ(id.herd(), 1023u);
  EXPECT_EQ(id.agent(), (1u << 24) - 1);
  EXPECT_EQ(id.generation(), (1u << 30) - 1);
  EXPECT_EQ(AgentId::ofBits(AgentId(7, 8, 9).bits()), AgentId(7, 8, 9));
  EXPECT_NE(AgentId(7, 8, 9), AgentId(7, 8, 10));
}

TEST(PublicAgentId, IsOfNobodyWhereItsNumbersDoNotFit) {
  EXPECT_EQ(AgentId().bits(), UINT64_MAX);
  EXPECT_EQ(AgentId(1024, 0), AgentId());
  EXPECT_EQ(AgentId(0, 1 << 24), AgentId());
  EXPECT_EQ(AgentId(0, 0, 1 << 30), AgentId());
}

TEST(PublicReactionPhase, HasAName) {
  EXPECT_STREQ(nameOf(ReactionPhase::steady), "steady");
  EXPECT_STREQ(nameOf(ReactionPhase::rising), "rising");
}

TEST(PublicSearchPhase, HasAName) {
  EXPECT_STREQ(nameOf(SearchPhase::atEase), "at ease");
  EXPECT_STREQ(nameOf(SearchPhase::settled), "settled");
}

TEST(PublicHerdId, IsOfNoHerdByDefault) {
  EXPECT_EQ(HerdId(), (HerdId{UINT32_MAX, 0}));
  EXPECT_NE((HerdId{1, 0}), (HerdId{1, 2}));
}

}  // namespace
}  // namespace skitter::test
