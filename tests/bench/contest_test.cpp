// What `skitter bench` rests on: the counts, the peaks, and that nobody is timed who is wrong.
#include "bench/crowd/contest.h"

#include <chrono>
#include <thread>

#include "bench/crowd/operations.h"
#include "bench/crowd/peaks.h"
#include "crowd/simulation.h"
#include "embedded/broken_swing_comp_storage.h"
#include "embedded/broken_swing_comp_texel.h"
#include "embedded/counted_comp.h"
#include "skitter/error.h"

namespace skitter::test {
namespace {

TEST(Operations, AreCountedAfterSpecialisation) {
  const auto count = [](int turns, bool more) {
    return bench::operationsAnInvocation(embedded::counted_comp(), {{3, turns}, {4, more}});
  };
  EXPECT_EQ(count(1, false), 7);
  EXPECT_EQ(count(5, false), 35);
  EXPECT_EQ(count(5, true), 37);
  EXPECT_EQ(count(0, true), 2);
}

TEST(Operations, RefuseWhatIsNoShader) {
  const std::vector<uint8_t> noise(64, 7);
  EXPECT_THROW(bench::operationsAnInvocation(noise, {}), Error);
}

constexpr uint32_t kWarmUp = 30;  // ticks: feet are in the air by then
constexpr uint32_t kRounds = 2;

class ContestTest : public GpuTest {
 protected:
  bench::Match contest(const Scene& scene, const CrowdOptions& crowd) {
    bench::ContestOptions options;
    options.crowd = crowd;
    options.warmUp = kWarmUp;
    options.rounds = kRounds;
    options.turnSeconds = 0;
    return bench::contest(
        device(), rollingGround(), scene, options, [](double) {}, [] { return false; });
  }
  static CrowdOptions unmeasured() {
    CrowdOptions options;
    options.measure = false;
    options.timestamps = true;
    return options;
  }
};

TEST_F(ContestTest, PeaksAreFinite) {
  const bench::Peaks peaks = bench::measurePeaks(context());
  EXPECT_GT(peaks.bytesPerSecond, 1e6);
  EXPECT_GT(peaks.operationsPerSecond, 1e6);
  EXPECT_LT(peaks.bytesPerSecond, 1e15);
  EXPECT_LT(peaks.operationsPerSecond, 1e16);
}

TEST_F(ContestTest, EverybodyIsCheckedAndTimed) {
  const bench::Match match = contest(sceneOf(33), unmeasured());
  ASSERT_GE(match.results.size(), 3u);
  EXPECT_EQ(match.agents, 33u);
  for (const bench::Result& result : match.results) {
    SCOPED_TRACE(result.name);
    EXPECT_TRUE(result.pass);
    // navigate to pose. Feet that swing and ik make at once are judged by ik.
    EXPECT_EQ(result.checks.size(), result.name == "device" ? 6u : 7u);
    for (const validation::StageResult& check : result.checks) {
      // That no leg begins a step in a tick can be.
      EXPECT_TRUE(check.samples > 0 || check.name == "foothold") << check.name;
    }
    EXPECT_EQ(result.ticks, 2u);  // of a turn however short, beside the one that is not counted
    // Two ticks tell how long one takes. In each turn a tick goes before the counted ones, and others in
    // which stages are timed follow.
    const uint64_t turn = 1 + result.ticks + 2, since = result.checkedTick - kWarmUp - 2 - 1;
    EXPECT_LT(since, kRounds * turn);
    EXPECT_GE(since % turn, 1u);
    EXPECT_LE(since % turn, result.ticks);
    EXPECT_GT(result.wall.median, 0);
    EXPECT_LE(result.wall.low, result.wall.high);
    EXPECT_FALSE(result.stages.empty());
  }
}

// Bytes of swing by include/skitter/records.h: the body, eight steps and arcs in, eight feet out.
TEST_F(ContestTest, BytesAreThoseOfTheRecords) {
  CrowdOptions options = unmeasured();
  options.fuse = false;
  const bench::Match match = contest(sceneOf(16), options);  // whole blocks
  const auto swing = std::find_if(match.demands.begin(), match.demands.end(),
                                  [](const bench::StageDemand& d) { return d.stage == "swing"; });
  ASSERT_NE(swing, match.demands.end());
  EXPECT_EQ(swing->bytes, 16 * 16 * (4 + 8 * (4 + 1)));
  EXPECT_GT(swing->operations, 16 * 8 * 20);
}

class Sleeper : public bench::Runner {
 public:
  explicit Sleeper(int milliseconds) : milliseconds_(milliseconds) {}
  std::string name() const override { return "sleeper"; }
  int threads() const override { return 1; }
  void tick() override { std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds_)); }
  void timeStages(bool) override {}
  std::vector<StageTime> stageTimes() const override { return {}; }

 private:
  int milliseconds_;
};

// So a contestant that is a thousand times slower than the device does not hold the run up.
TEST(Turns, HaveFewerTicksOfWhoIsSlower) {
  Sleeper slow(10), quick(0);
  EXPECT_EQ(bench::ticksATurn(slow, 0), 2u);
  EXPECT_LE(bench::ticksATurn(slow, 0.3), 30u);
  EXPECT_EQ(bench::ticksATurn(quick, 10), 500u);
}

TEST_F(ContestTest, ABrokenShaderIsFoundOut) {
  CrowdOptions options = unmeasured();
  options.shaders.push_back(
      {"swing", embedded::broken_swing_comp_texel(), embedded::broken_swing_comp_storage()});
  const bench::Match match = contest(sceneOf(33), options);
  EXPECT_FALSE(match.results.front().pass);
  for (size_t i = 1; i < match.results.size(); ++i)
    EXPECT_TRUE(match.results[i].pass) << match.results[i].name;
}

TEST_F(ContestTest, WhoStopsGetsNothing) {
  const bench::Match match = bench::contest(
      device(), rollingGround(), sceneOf(2), {}, [](double) {}, [] { return true; });
  EXPECT_TRUE(match.results.empty());
}

}  // namespace
}  // namespace skitter::test
