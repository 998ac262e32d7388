// What `skitter bench --avoid` rests on: the crowd has the neighbours that it is said to have, everybody is
// checked, and nobody is timed who is wrong.
#include "bench/crowd/avoid_contest.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "crowd/simulation.h"
#include "embedded/broken_avoid_comp_storage.h"
#include "embedded/broken_avoid_comp_texel.h"

namespace skitter::test {
namespace {

class AvoidContestTest : public GpuTest {
 protected:
  static bench::ContestOptions shortOne() {
    bench::ContestOptions options;
    options.warmUp = 60;
    options.rounds = 2;
    options.turnSeconds = 0;
    return options;
  }
  bench::AvoidMatch contest(uint32_t agents, const bench::ContestOptions& options = shortOne()) {
    return bench::avoidContest(
        device(), bench::avoidCrowdOf(Scene{}, agents), options, [](double) {}, [] { return false; });
  }
};

TEST_F(AvoidContestTest, EverybodyIsCheckedAndTimed) {
  const bench::AvoidMatch match = contest(400);
  EXPECT_EQ(match.agents, 400u);
  std::vector<std::string> names;
  for (const bench::Result& result : match.results) {
    SCOPED_TRACE(result.name);
    names.push_back(result.name.substr(0, result.name.find(',')));
    EXPECT_TRUE(result.pass);
    EXPECT_GE(result.ticks, 2u);
    EXPECT_GT(result.wall.median, 0);
    EXPECT_LE(result.wall.low, result.wall.high);
    const bool isOrca = names.back() == "ORCA", isDevice = names.back() == "device";
    ASSERT_EQ(result.checks.size(), isOrca || isDevice ? 1u : 2u);
    EXPECT_EQ(result.checks.front().name, isOrca ? "half-planes" : "avoid");
    EXPECT_GE(result.checks.front().samples, 100u);
    if (result.checks.size() == 2) {
      EXPECT_EQ(result.checks.back().samples, 400u);
    }
    ASSERT_EQ(result.stages.size(), 2u);
    EXPECT_EQ(result.stages.front().stage, isOrca ? "tree" : "grid");
    EXPECT_EQ(result.stages.back().stage, "avoid");
    for (const StageTime& stage : result.stages) EXPECT_GT(stage.milliseconds, 0) << stage.stage;
  }
  EXPECT_EQ(names.front(), "device");
  for (const char* name : {"CPU SIMD", "CPU scalar", "ORCA"})
    EXPECT_NE(std::ranges::find(names, name), names.end()) << name;
}

// At the edge of 2,000 there is room for 0.4 fewer than among many.
TEST_F(AvoidContestTest, AgentsHaveTenOthersInReach) {
  const bench::AvoidMatch match = contest(2000);
  EXPECT_NEAR(match.inReach, 9.7, 0.7);
  EXPECT_LE(match.keptClear, 8);
  EXPECT_GT(match.keptClear, 6.5);
}

TEST_F(AvoidContestTest, DensityDoesNotDependOnTheNumberOfAgents) {
  const bench::AvoidCrowd few = bench::avoidCrowdOf(Scene{}, 100),
                          many = bench::avoidCrowdOf(Scene{}, 200000);
  EXPECT_EQ(few.spacing, many.spacing);
  EXPECT_EQ(few.scene.herds.front().spawn.spacing, many.scene.herds.front().spawn.spacing);
  for (const bench::AvoidCrowd* crowd : {&few, &many}) {
    const Herd& herd = crowd->scene.herds.front();
    EXPECT_TRUE(herd.avoid);
    // Rows, and a tenth of their room beside them: the spawner closes up where there is less.
    const double side = std::sqrt(herd.agents) * 1.2 * herd.spawn.spacing;
    EXPECT_GT(crowd->ground.extentX(), side / 0.9 + 8);
    EXPECT_EQ(*std::ranges::max_element(crowd->ground.heights),
              *std::ranges::min_element(crowd->ground.heights));
  }
}

TEST_F(AvoidContestTest, ABrokenShaderIsFoundOut) {
  bench::ContestOptions options = shortOne();
  options.crowd.shaders.push_back(
      {"avoid", embedded::broken_avoid_comp_texel(), embedded::broken_avoid_comp_storage()});
  const bench::AvoidMatch match = contest(400, options);
  EXPECT_FALSE(match.results.front().pass);
  for (const bench::Result& result : match.results) {
    if (result.name == "device") continue;
    EXPECT_TRUE(result.checks.front().pass) << result.name << ": " << result.checks.front().why;
    if (result.checks.size() == 2) {
      EXPECT_FALSE(result.checks.back().pass) << result.name;
    }
  }
}

TEST_F(AvoidContestTest, WhoStopsGetsNothing) {
  const bench::AvoidMatch match = bench::avoidContest(
      device(), bench::avoidCrowdOf(Scene{}, 50), shortOne(), [](double) {}, [] { return true; });
  EXPECT_TRUE(match.results.empty());
}

TEST(AvoidGrowth, IsOfWhoWereInBoth) {
  const auto matchOf = [](uint64_t agents, double cpu, double wall, const char* name) {
    bench::AvoidMatch match{.agents = agents};
    match.results.resize(2);
    match.results.front().name = "device";
    match.results.front().cpu.median = cpu;
    match.results.front().wall.median = wall;
    match.results.back().name = name;
    return match;
  };
  const std::vector<bench::AvoidMatch> matches = {matchOf(100, 2, 1, "a"), matchOf(500, 100, 1, "a"),
                                                  matchOf(1000, 30, 12, "b")};
  const std::vector<bench::Growth> byCpu = bench::growthOf(matches, true),
                                   byWall = bench::growthOf(matches, false);
  ASSERT_EQ(byCpu.size(), 1u);
  EXPECT_EQ(byCpu.front().name, "device");
  EXPECT_EQ(byCpu.front().from, 100u);
  EXPECT_EQ(byCpu.front().to, 1000u);
  EXPECT_DOUBLE_EQ(byCpu.front().ratio, 1.5);
  EXPECT_DOUBLE_EQ(byWall.front().ratio, 1.2);
  EXPECT_TRUE(bench::growthOf({matches.front()}, true).empty());
}

}  // namespace
}  // namespace skitter::test
