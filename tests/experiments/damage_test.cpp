#include "experiments/damage.h"

#include <gmock/gmock.h>

namespace skitter::experiments {
namespace {

TEST(DamageStudy, CreaturesThatFoundNothingNeededNoTrials) {
  DamageStudy study;
  EXPECT_TRUE(study.trialsNeeded().empty());
  for (const uint32_t trials : {7u, 0u, 2u, 20u, 0u, 2u}) study.creatures.push_back({.trials = trials});
  EXPECT_THAT(study.trialsNeeded(), ::testing::ElementsAre(2, 2, 7, 20));
}

TEST(DamageStudy, TheTableHasEachNumberOfLegsEvolvedAndByRule) {
  DamageStudy study;
  study.byTable = {{.legs = 1, .patterns = 8, .kept = 1, .keptLeast = 0.75, .unstable = 0.125},
                   {.legs = 2, .patterns = 28}};
  study.byRule = {{.legs = 1, .patterns = 8, .kept = 0.5}, {.legs = 2, .patterns = 28}};
  const Table table = study.table();
  ASSERT_EQ(table.rows.size(), 4u);
  EXPECT_THAT(table.rows[0], ::testing::ElementsAre("1", "8", "evolved", "1.0000", "0.7500", "0.1250"));
  EXPECT_THAT(table.rows[1], ::testing::ElementsAre("1", "8", "by rule", "0.5000", "0.0000", "0.0000"));
  EXPECT_EQ(table.rows[3][0], "2");
}

}  // namespace
}  // namespace skitter::experiments
