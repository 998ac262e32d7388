// Trials of gaits: their kernel held against the reference, and that nothing but the gait decides.
#include <gtest/gtest.h>

#include "evolve/trial_parity.h"
#include "support/gpu_fixture.h"

namespace skitter::test {
namespace {

using TrialTest = GpuTest;
using evolve::TrialFigures, evolve::Trials;

constexpr float trialTick = 1.0f / 30;

void expectSameFigures(const TrialFigures& a, const TrialFigures& b) {
  EXPECT_EQ(a.distance, b.distance);
  EXPECT_EQ(a.cycles, b.cycles);
  EXPECT_EQ(a.unstable, b.unstable);
  EXPECT_EQ(a.slip, b.slip);
  EXPECT_EQ(a.error, b.error);
  EXPECT_EQ(a.least, b.least);
  EXPECT_EQ(a.shares, b.shares);
}

TEST_F(TrialTest, TheKernelCountsWhatTheReferenceDoes) {
  const Rig rig = spiderRig();
  Trials trials(device(), rig, 24, 1.0f / 60);
  EXPECT_EQ(differenceOf(trials, drawnTasks(rig, 24, 1), 30, 24), "");
}

TEST_F(TrialTest, NeitherTheSlotNorEarlierTrialsDecide) {
  const Rig rig = spiderRig();
  Trials trials(device(), rig, 20, trialTick);
  const std::vector<evolve::TrialTask> tasks = drawnTasks(rig, 20, 2);
  const std::vector<TrialFigures> first = trials.run(tasks);
  std::vector<evolve::TrialTask> turned(tasks.rbegin(), tasks.rend());
  const std::vector<TrialFigures> second = trials.run(turned);
  ASSERT_EQ(first.size(), 20u);
  for (size_t i = 0; i < 20; ++i) expectSameFigures(first[i], second[19 - i]);
  const std::vector<TrialFigures> third = trials.run(std::span(tasks).first(3));
  ASSERT_EQ(third.size(), 3u);
  for (size_t i = 0; i < 3; ++i) expectSameFigures(first[i], third[i]);
  EXPECT_NE(first[0].distance, first[1].distance);
}

TEST_F(TrialTest, ACreatureByRuleWalksAndIdleLegsNeverStand) {
  const Rig rig = spiderRig();
  Trials trials(device(), rig, 8, trialTick);
  std::vector<evolve::TrialTask> tasks;
  for (uint32_t leg = 0; leg < 8; ++leg)
    tasks.push_back({1u << leg, crowd::regaitByRule(rig, Tuning{}, {.idle = 1u << leg})});
  const std::vector<TrialFigures> figures = trials.run(tasks);
  for (size_t leg = 0; leg < 8; ++leg) {
    EXPECT_EQ(figures[leg].samples, trials.samples());
    EXPECT_GT(figures[leg].distance, 0.8 * Evolution::wantedSpeed * trials.countedSeconds()) << leg;
    EXPECT_GE(figures[leg].cycles, 3) << leg;
    EXPECT_EQ(figures[leg].shares[leg], 0) << leg;
    EXPECT_GT(figures[leg].shares[(leg + 1) % 8], 0.3f) << leg;
    const double fitness =
        evolve::fitnessOf(figures[leg], 1, 7, trials.countedSeconds(), Evolution::wantedSpeed);
    // The rule looks at one leg length a second. At the speed of a trial, forelegs that are left reach too far.
    if (leg < 2) {
      EXPECT_GT(figures[leg].error, 0.05) << leg;
    } else {
      EXPECT_GT(fitness, 0.3) << leg;
    }
  }
}

TEST(Fitness, IsTheShareOfTheWayLessEachBreach) {
  const TrialFigures good{.samples = 100, .distance = 3, .cycles = 4};
  const auto fitness = [](const TrialFigures& figures) { return evolve::fitnessOf(figures, 2, 5, 2, 1.5); };
  EXPECT_DOUBLE_EQ(fitness(good), 0.5);
  TrialFigures other = good;
  other.unstable = 25;
  EXPECT_DOUBLE_EQ(fitness(other), 0.375);
  other = good;
  other.error = 0.05;
  EXPECT_DOUBLE_EQ(fitness(other), 0.25);
  other = good;
  other.slip = 0.375;
  EXPECT_DOUBLE_EQ(fitness(other), 0.25);
  other = good;
  other.cycles = 2.9;
  EXPECT_EQ(fitness(other), 0);
  other = good;
  other.distance = 100;
  EXPECT_EQ(fitness(other), 1);
  other.distance = -1;
  EXPECT_EQ(fitness(other), 0);
  other.error = 1;
  EXPECT_EQ(fitness(other), 0);
}

}  // namespace
}  // namespace skitter::test
