#include "skitter/evolve.h"

#include <utility>

#include "public/public.h"

namespace skitter::test {
namespace {

using PublicEvolution = PublicTest;

TEST_F(PublicEvolution, SearchesAndGoesOn) {
  const Rig rig = spiderRig();
  Evolution first(device(), rig, {.seed = 2, .batch = 1000, .dt = 1.0f / 20});
  Evolution search = std::move(first);
  EXPECT_EQ(search.options().seed, 2u);
  EXPECT_EQ(search.evaluations(), 0u);
  EXPECT_EQ(search.patternCount(), 114u);
  EXPECT_EQ(search.cellCount(), 114u * 64);
  EXPECT_NEAR(search.seconds(), 4.2, 0.1);
  search.step();
  EXPECT_EQ(search.evaluations(), 1000u);
  EXPECT_GT(search.filledCount(), 0u);
  const std::vector<RigGait> gaits = search.gaits();
  ASSERT_FALSE(gaits.empty());
  const std::string map = search.map();
  search = Evolution(device(), rig, map, "map");
  EXPECT_EQ(search.map(), map);
  EXPECT_EQ(search.gaits(), gaits);
  const std::vector<AdaptationReport> reports = search.adapt(5, 1);
  ASSERT_FALSE(reports.empty());
  EXPECT_LE(reports.size(), 5u);
  for (const AdaptationReport& report : reports) {
    EXPECT_NE(report.lost, 0u);
    EXPECT_GT(report.bestKnown, 0);
    EXPECT_LE(report.trials, 20u);
    EXPECT_EQ(report.trials > 0, report.found >= 0.9 * report.bestKnown);
  }
  expectRefused("map:", [&] { Evolution(device(), rig, "{", "map"); });
}

TEST_F(PublicEvolution, GaitsAreJudged) {
  const Rig rig = spiderRig();
  const std::vector<uint32_t> patterns = {0, 1};
  const std::vector<GaitJudgement> judged = judgeGaits(device(), rig, patterns, 1, 1.0f / 20);
  ASSERT_EQ(judged.size(), 2u);
  EXPECT_EQ(judged[1].idle, 1u);
  EXPECT_GT(judged[0].speed, 0);
  EXPECT_TRUE(judgeGaits(device(), rig, {}, 1).empty());
  EXPECT_EQ(judgeUnadapted(device(), rig, patterns, 1, 1.0f / 20).size(), patterns.size());
  expectRefused("seconds of a judgement is 0", [&] { judgeGaits(device(), rig, patterns, 0); });
  expectRefused("dt of a judgement is 1", [&] { judgeGaits(device(), rig, patterns, 1, 1); });
  expectRefused("pattern of a judgement is 0x100",
                [&] { judgeGaits(device(), rig, std::vector<uint32_t>{256}, 1); });
}

}  // namespace
}  // namespace skitter::test
