#include "experiments/conclusions.h"

#include <gtest/gtest.h>

namespace skitter::experiments {
namespace {

Conclusion conclusionOn(const Results& results, const std::string& subject) {
  for (const Conclusion& c : conclusionsOf(results))
    if (c.claim.find(subject) != std::string::npos) return c;
  ADD_FAILURE() << "no conclusion on " << subject;
  return {};
}

bench::SolveSweep sweepThatAccuracyEnds(const std::string& name, double share) {
  bench::SolvePoint point;
  point.stops = {share, 1 - share, 0, 0};
  return {name, {point}, {}};
}

bench::InstancePoint batch(const char* altered, uint32_t instances, uint32_t iterations,
                           double milliseconds) {
  return {"fabrik", altered, instances, iterations, milliseconds, milliseconds};
}

// By figures alone: turned round, they turn the verdict.
TEST(Conclusions, FollowTheFigures) {
  Results results;
  const auto verdict = [&](size_t i) { return conclusionsOf(results).at(i).holds; };
  results.simulated.limits = {{Controller::clip, false, 16.7, 20, 21, 0, 0},
                              {Controller::loop, false, 16.7, 9, 10, 0, 0},
                              {Controller::adaptive, false, 16.7, 4, 5, 0, 0}};
  EXPECT_EQ(verdict(0), true);
  EXPECT_EQ(verdict(1), true);
  EXPECT_EQ(verdict(2), true);
  results.simulated.limits[2].agents = 30000;
  EXPECT_EQ(verdict(0), false);
  EXPECT_EQ(verdict(1), false);
  EXPECT_EQ(verdict(2), false);
}

// Other users of a software device's cores may turn what its wall clock says.
TEST(Conclusions, AreNotSettledWhereTheClocksDisagree) {
  Results results;
  const auto limit = [](Controller controller, uint32_t agents, double byCpu) {
    return AgentLimit{controller, false, 16.7, agents, agents + 1, 0, 0, byCpu};
  };
  results.simulated.limits = {limit(Controller::clip, 3000, 2000), limit(Controller::loop, 2000, 3000),
                              limit(Controller::adaptive, 1000, 1000)};
  const std::vector<Conclusion> conclusions = conclusionsOf(results);
  EXPECT_EQ(conclusions.at(0).holds, false);
  EXPECT_FALSE(conclusions.at(1).holds.has_value());
  EXPECT_EQ(verdictOf(conclusions.at(1)), "not settled");
}

TEST(Conclusions, WhatWasNotMeasuredHasNoVerdict) {
  const std::vector<Conclusion> conclusions = conclusionsOf({});
  EXPECT_FALSE(conclusions.empty());
  for (const Conclusion& c : conclusions) {
    EXPECT_EQ(verdictOf(c), "not measured") << c.claim;
    EXPECT_FALSE(c.criterion.empty()) << c.claim;
  }
}

// Two figures decide, and one alone is no measurement.
TEST(Conclusions, HalfOfAMeasurementHasNoVerdict) {
  Results results;
  results.sweeps = {sweepThatAccuracyEnds("accuracy-steps", 0.1)};
  results.instances = {batch("instances", 100, 100, 1), batch("instances", 200, 100, 2)};
  EXPECT_EQ(verdictOf(conclusionOn(results, "accuracy threshold")), "not measured");
  EXPECT_EQ(verdictOf(conclusionOn(results, "More iterations")), "not measured");
}

TEST(Conclusions, AccuracyMustBeRareInBothReadings) {
  const auto holds = [](double steps, double factors) {
    Results results;
    results.sweeps = {sweepThatAccuracyEnds("accuracy-steps", steps),
                      sweepThatAccuracyEnds("accuracy-factors", factors)};
    return conclusionOn(results, "accuracy threshold").holds;
  };
  EXPECT_EQ(holds(0.1, 0.1), true);
  EXPECT_EQ(holds(0.9, 0.1), false);
  EXPECT_EQ(holds(0.1, 0.9), false);
}

TEST(Conclusions, IterationsCostAsInstancesDoIfTheirPowersAgree) {
  const auto holds = [](double millisecondsOfTwiceTheIterations) {
    Results results;
    results.instances = {batch("instances", 100, 100, 1), batch("instances", 200, 100, 2),
                         batch("iterations", 100, 100, 1),
                         batch("iterations", 100, 200, millisecondsOfTwiceTheIterations)};
    return conclusionOn(results, "More iterations").holds;
  };
  EXPECT_EQ(holds(2), true);
  EXPECT_EQ(holds(1.1), false);
}

TEST(Conclusions, CollectingIsNoticeableIfItIsOnDeviceAndCpu) {
  const auto holds = [](double device, double cpu) {
    Results results;
    results.collection.times.emplace_back();
    CollectionTime& time = results.collection.times.back();
    time.rule = "nearest";
    time.legs = 1;
    time.deviceMilliseconds = device;
    time.cpuMilliseconds = cpu;
    return conclusionOn(results, "points of one leg").holds;
  };
  EXPECT_EQ(holds(1, 1), true);
  EXPECT_EQ(holds(1, 0.1), false);
  EXPECT_EQ(holds(0.1, 1), false);
}

}  // namespace
}  // namespace skitter::experiments
