#include "cpu_reference/stages/adapt.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "cpu_reference/stages/tolerances.h"
#include "gait_maps.h"
#include "reference_herd.h"
#include "skitter/records.h"
#include "validation/convert.h"

namespace skitter::test {
namespace {

using reference::GaitCandidate, reference::GaitMap, reference::Search, reference::Searching, reference::Tried;

// Candidates of two legs: how long the first one stands, and the fitness that is expected.
GaitMap mapOf(const std::vector<std::pair<double, double>>& sharesAndFitnesses) {
  GaitMap map;
  for (const auto& [share, fitness] : sharesAndFitnesses)
    map.candidates.push_back({.expected = fitness, .legs = {{}, {}}, .shares = {share, 0.5}});
  return map;
}

// A distance at which r is 1: the kernel is then 0.09 (1 + 1 + 1/3) / e.
const double unit = 1.2 / std::sqrt(5.0);
constexpr double kNear = 0.0772546827;

TEST(AdaptKernel, IsMatern52OfHowLongLegsStand) {
  const GaitMap map = mapOf({{0, 1}, {unit, 1}, {2 * unit, 1}});
  EXPECT_NEAR(reference::gaitKernel(map.candidates[0], map.candidates[0]), 0.09, 1e-15);
  EXPECT_NEAR(reference::gaitKernel(map.candidates[0], map.candidates[1]), kNear, 1e-9);
  // 0.09 (1 + 2 + 4/3) / e^2
  EXPECT_NEAR(reference::gaitKernel(map.candidates[2], map.candidates[0]), 0.0527807605, 1e-9);
  GaitCandidate aside{.shares = {0.3, 0.9}};
  const GaitCandidate origin{.shares = {0, 0.5}};
  EXPECT_NEAR(reference::gaitKernel(aside, origin),
              reference::gaitKernel(origin, GaitCandidate{.shares = {0.5, 0.5}}), 1e-15);
}

TEST(AdaptPosterior, OfOneTrialGoesByItsSurprise) {
  const GaitMap map = mapOf({{0, 0.9}, {unit, 0.7}});
  const std::vector<Tried> trials = {{0, 0.4}};
  const reference::Outlook outlook = reference::outlookOf(map, trials);
  ASSERT_EQ(outlook.untried.size(), 1u);
  const reference::Expectation& x = outlook.untried[0];
  EXPECT_EQ(x.candidate, 1u);
  EXPECT_NEAR(x.mean, 0.7 - 0.5 * kNear / 0.091, 1e-8);
  EXPECT_NEAR(x.variance, 0.09 - kNear * kNear / 0.091, 1e-9);
  EXPECT_NEAR(x.bound(), x.mean + 2 * std::sqrt(x.variance), 1e-15);
}

TEST(AdaptPosterior, OfTwoTrialsSolvesForBoth) {
  const GaitMap map = mapOf({{0, 0.9}, {unit, 0.7}, {2 * unit, 0.5}});
  const std::vector<Tried> trials = {{2, 0.6}, {0, 0.4}};
  const double far = reference::gaitKernel(map.candidates[0], map.candidates[2]);
  // Both are as near to candidate 1, so K^-1 k is the same number twice, kNear / (0.091 + far).
  const double weight = kNear / (0.091 + far);
  const reference::Outlook outlook = reference::outlookOf(map, trials);
  ASSERT_EQ(outlook.untried.size(), 1u);
  const reference::Expectation& x = outlook.untried[0];
  EXPECT_NEAR(x.mean, 0.7 + weight * (0.1 - 0.5), 1e-8);
  EXPECT_NEAR(x.variance, 0.09 - 2 * weight * kNear, 1e-8);
  EXPECT_NEAR(x.weights, 2 * weight, 1e-8);
}

TEST(AdaptPosterior, WithoutTrialsIsTheMaps) {
  const reference::Outlook outlook = reference::outlookOf(mapOf({{0, 0.5}, {0.3, 0.8}}), {});
  ASSERT_EQ(outlook.untried.size(), 2u);
  EXPECT_NEAR(outlook.untried[1].mean, 0.8, 1e-15);
  EXPECT_NEAR(outlook.untried[1].bound(), 0.8 + 0.6, 1e-12);
}

reference::Choice choice(const GaitMap& map, const std::vector<Tried>& trials) {
  return reference::chooseGait(map, trials, reference::outlookOf(map, trials));
}

TEST(AdaptChoice, BeginsWithTheHighestFitnessAndOfEqualOnesWithTheFirst) {
  EXPECT_EQ(choice(mapOf({{0, 0.5}, {1, 0.8}, {0.3, 0.8}, {0.2, 0.1}}), {}), (reference::Choice{false, 1}));
}

TEST(AdaptChoice, OfEqualBoundsTakesTheFirst) {
  const GaitMap map = mapOf({{0, 0.9}, {unit, 0.8}, {unit, 0.8}, {unit, 0.8}});
  EXPECT_EQ(choice(map, {{0, 0.1}}), (reference::Choice{false, 1}));
  EXPECT_EQ(choice(map, {{0, 0.1}, {1, 0.1}}), (reference::Choice{false, 2}));
}

TEST(AdaptChoice, PrefersWhatATrialDoesNotTellOf) {
  // A bad trial speaks against its like.
  EXPECT_EQ(choice(mapOf({{0, 0.9}, {0.05, 0.8}, {3, 0.5}}), {{0, 0.0}}), (reference::Choice{false, 2}));
}

TEST(AdaptChoice, EndsWhenGoodEnough) {
  const GaitMap map = mapOf({{0, 0.8}, {5, 1}});
  EXPECT_EQ(choice(map, {{0, 0.9}}), (reference::Choice{true, 0}));
  EXPECT_EQ(choice(map, {{0, 0.8999}}), (reference::Choice{false, 1}));
}

TEST(AdaptChoice, EndsWhereNothingMoreIsToBeExpected) {
  // The best of the map is tried and bad, and the bound of the last one is below what was found.
  const GaitMap map = mapOf({{0, 1}, {5, 0.8}, {5, 0.3}});
  const std::vector<Tried> trials = {{0, 0.1}, {1, 0.7}};
  const double bound = reference::outlookOf(map, trials).untried[0].bound();
  ASSERT_LT(bound, 0.7);
  ASSERT_GT(bound, 0.2);
  EXPECT_EQ(choice(map, trials), (reference::Choice{true, 1}));
  // A third gait may still be better than what was found.
  EXPECT_EQ(choice(mapOf({{0, 1}, {5, 0.8}, {5, 0.85}}), trials), (reference::Choice{false, 2}));
}

TEST(AdaptChoice, EndsWhenAllAreTriedOrAfterTwenty) {
  EXPECT_EQ(choice(mapOf({{0, 1}, {1, 0.5}}), {{0, 0.1}, {1, 0.2}}), (reference::Choice{true, 1}));
  std::vector<std::pair<double, double>> many;
  std::vector<Tried> trials;
  for (size_t c = 0; c < 25; ++c) many.emplace_back(1000.0 * static_cast<double>(c), 1.0);
  for (size_t c = 0; c < 19; ++c) trials.push_back({c, c == 7 || c == 9 ? 0.5 : 0.1});
  const GaitMap map = mapOf(many);
  EXPECT_EQ(choice(map, trials), (reference::Choice{false, 19}));
  trials.push_back({19, 0.1});
  EXPECT_EQ(choice(map, trials), (reference::Choice{true, 7})) << "of equal ones the first";
}

TEST(AdaptFitness, IsTheShareOfTheSpeedLessThatOfTimeWithoutSupport) {
  Search search;
  search.clock = 4.2;
  search.wanted = 2;
  search.progress = 1.5;
  search.unstable = 0.8;
  EXPECT_NEAR(reference::fitnessOf(search), 0.75 * 0.75, 1e-12);
  search.progress = 3;
  EXPECT_NEAR(reference::fitnessOf(search), 0.75, 1e-12);
  search.unstable = 4;
  EXPECT_EQ(reference::fitnessOf(search), 0);
  search.unstable = 0;
  search.progress = -1;
  EXPECT_EQ(reference::fitnessOf(search), 0);
}

// A spider that stands, whose feet are at their homes.
class Adapt : public testing::Test {
 protected:
  Adapt() {
    tuning.dt = 1.0 / 64;
    for (const reference::Limb& limb : creature.limbs) {
      hurt.legs.push_back({.group = limb.group, .lag = limb.lag, .neighbours = limb.neighbours});
      feet.push_back({.target = limb.home, .progress = 1});
      chains.emplace_back().tip = limb.home;
    }
    hurt.groups = creature.groups;
    body.speed = 0.5;
  }

  reference::AdaptResult tick(const glm::dvec2& velocity = {0, 1}) {
    const reference::AdaptResult result =
        reference::adapt(tuning, map, search, hurt, body, feet, chains, velocity);
    search = result.search;
    hurt = result.hurt;
    return result;
  }
  // Ticks to the end of a trial.
  int trial(const glm::dvec2& velocity = {0, 1}) {
    for (int ticks = 1; ticks < 1000; ++ticks)
      if (tick(velocity).ended) return ticks;
    return -1;
  }

  reference::Tuning tuning = validation::tuningOf(parametersFor(flatField()));
  reference::Creature creature = spiderCreature();
  GaitMap map = oneLegMap(creature);
  Search search;
  reference::Hurt hurt;
  reference::AgentBody body = bodyAt(1, 1);
  std::vector<reference::Foot> feet;
  std::vector<reference::Chain> chains;
};

TEST_F(Adapt, WhoIsWholeIsAtEaseAndKeepsItsGait) {
  hurt.speed = 0.77;
  for (int i = 0; i < 100; ++i) tick();
  EXPECT_EQ(search.does, Searching::atEase);
  EXPECT_EQ(search.clock, 0);
  EXPECT_EQ(hurt.speed, 0.77);
}

TEST_F(Adapt, BeginsToSearchAsItNoticesALossAndHasTheGaitAtOnce) {
  hurt.lost = 1 << 2;
  hurt.stuck = 1 << 5;
  hurt.legs[2].lostFrom = 3;
  map.candidates[4].expected = 2;
  map.candidates[4].speed = 0.6;
  map.candidates[4].shift = {0.1, 0.2, 0.3};
  map.candidates[4].groups = 5;
  map.candidates[4].legs[1].slowness = 0.8;
  const reference::AdaptResult result = tick();
  EXPECT_TRUE(result.chose);
  EXPECT_EQ(search.idle, 1u << 2 | 1u << 5);
  EXPECT_EQ(search.does, Searching::searches);
  EXPECT_EQ(search.candidate, 4u);
  EXPECT_EQ(search.clock, 0);
  EXPECT_TRUE(search.trials.empty());
  EXPECT_EQ(hurt.speed, 0.6);
  EXPECT_EQ(hurt.groups, 5);
  EXPECT_EQ(hurt.shift, glm::dvec3(0.1, 0.2, 0.3));
  EXPECT_EQ(hurt.legs[1].slowness, 0.8);
  EXPECT_EQ(hurt.legs[2].lostFrom, 3u);
  EXPECT_EQ(hurt.lost, 1u << 2);
  tick();
  EXPECT_EQ(search.clock, tuning.dt);
}

TEST_F(Adapt, AnotherLossOrAHealedLegBeginsAnew) {
  hurt.stuck = 1;
  for (int i = 0; i < 100; ++i) tick();
  EXPECT_GT(search.wanted, 0);
  hurt.stuck = 3;
  tick();
  EXPECT_EQ(search.idle, 3u);
  EXPECT_EQ(search.clock, 0);
  EXPECT_EQ(search.wanted, 0);
  EXPECT_EQ(search.does, Searching::searches);
  trial();
  EXPECT_EQ(search.trials.size(), 1u);
  hurt.stuck = 0;
  hurt.speed = 0.77;  // the host's
  tick();
  EXPECT_EQ(search.does, Searching::atEase);
  EXPECT_EQ(search.idle, 0u);
  EXPECT_TRUE(search.trials.empty());
  EXPECT_EQ(search.bestFitness, 0);
  EXPECT_EQ(hurt.speed, 0.77);
}

TEST_F(Adapt, WithFewerThanThreeLegsItOnlyNotices) {
  hurt.lost = 0x3f;
  tick();
  EXPECT_EQ(search.does, Searching::atEase);
  EXPECT_EQ(search.idle, 0x3fu);
  tick();
  EXPECT_EQ(search.clock, 0);
  hurt.lost = 0x1f;
  tick();
  EXPECT_EQ(search.does, Searching::searches) << "three legs are enough";
}

TEST_F(Adapt, LameLegsAreSlowerAndSoIsTheBody) {
  hurt.lame = 1 << 1 | 1 << 6;
  tick();
  EXPECT_EQ(search.does, Searching::searches);
  EXPECT_EQ(search.candidate, 0u);
  EXPECT_EQ(hurt.legs[1].slowness, 1.5);
  EXPECT_EQ(hurt.legs[2].slowness, 1);
  EXPECT_EQ(hurt.speed, 1 - 2.0 / 16);
  tick();
  EXPECT_EQ(hurt.legs[1].slowness, 1.5) << "of the map's, not of the last tick's";
  for (int i = 1; i < 65; ++i) tick();
  EXPECT_NEAR(search.wanted, (1 - 2.0 / 16) * tuning.dt, 1e-12);
  // One of seven.
  hurt.lame = 1 << 6;
  hurt.stuck = 1 << 1;
  tick();
  EXPECT_EQ(hurt.legs[1].slowness, 1);
  EXPECT_NEAR(hurt.speed, 1 - 1.0 / 14, 1e-15);
  map.candidates[0].speed = 0.5;
  tick();
  EXPECT_NEAR(hurt.speed, 0.5 * (1 - 1.0 / 14), 1e-15);
}

TEST_F(Adapt, CountsAfterASecondAndEndsTheTrialAfterFourAndAFifth) {
  hurt.stuck = 1;

  tick();
  for (int i = 0; i < 64; ++i) tick({0, 2});
  EXPECT_EQ(search.clock, 1);
  EXPECT_EQ(search.wanted, 0);

  tick({0, 2});
  EXPECT_EQ(search.wanted, 2 * tuning.dt);
  EXPECT_EQ(search.progress, 0.5 * tuning.dt);

  EXPECT_EQ(search.unstable, 0);
  // The first tick at 4.2 s less half of one is the 269th.
  EXPECT_EQ(trial({0, 2}), 269 - 65);
  ASSERT_EQ(search.trials.size(), 1u);
  EXPECT_EQ(search.trials[0].candidate, 0u);
  EXPECT_NEAR(search.trials[0].fitness, 0.25, 1e-12);
  EXPECT_EQ(search.bestCandidate, 0u);
  EXPECT_EQ(search.bestFitness, search.trials[0].fitness);
  EXPECT_EQ(search.clock, 0);
  EXPECT_EQ(search.wanted, 0);
  EXPECT_EQ(search.progress, 0);

  EXPECT_NE(search.candidate, 0u);
}

TEST_F(Adapt, ProgressIsAlongTheWish) {
  hurt.stuck = 1;
  for (int i = 0; i < 66; ++i) tick({3, 4});
  // The heading is +z: 4/5 of the speed.
  EXPECT_NEAR(search.wanted, 5 * tuning.dt, 1e-12);
  EXPECT_NEAR(search.progress, 0.8 * 0.5 * tuning.dt, 1e-12);
}

TEST_F(Adapt, StandingStillStopsTheClock) {
  hurt.stuck = 1;
  for (int i = 0; i < 80; ++i) tick();
  const Search before = search;
  for (int i = 0; i < 80; ++i) tick({0.0999, 0});
  EXPECT_EQ(search.clock, before.clock);
  EXPECT_EQ(search.wanted, before.wanted);
  tick({0, 0.1});
  EXPECT_GT(search.clock, before.clock);
}

TEST_F(Adapt, IsUnstableWhereTheBodyIsTooNearTheEdgeOfItsSupport) {
  hurt.stuck = 1;
  tick();
  for (int i = 0; i < 64; ++i) tick();
  tick();
  EXPECT_EQ(search.unstable, 0);
  // A square whose edge is 0.02 behind the centre, and the idle leg far behind.
  for (size_t l = 1; l < 8; ++l) feet[l].progress = 0;
  const auto standAt = [&](size_t l, const glm::dvec2& at) {
    chains[l].tip = {at.x, 0, at.y};
    feet[l].progress = 1;
  };
  standAt(1, {-1, -0.02});
  standAt(2, {1, -0.02});
  standAt(3, {-1, 1});
  standAt(4, {1, 1});
  standAt(0, {0, -5});
  tick();
  EXPECT_EQ(search.unstable, tuning.dt);
  for (size_t l : {1, 2}) chains[l].tip.z = -0.031;
  tick();
  EXPECT_EQ(search.unstable, tuning.dt);
  for (size_t l = 1; l < 8; ++l) feet[l].progress = 0.99;
  tick();
  EXPECT_EQ(search.unstable, 2 * tuning.dt) << "without planted feet";
}

TEST_F(Adapt, SettlesOnTheBestAndKeepsIt) {
  hurt.stuck = 1;
  body.speed = 0.3;
  tick();
  trial();
  const uint32_t second = search.candidate;
  body.speed = 1;

  trial();
  EXPECT_EQ(search.does, Searching::settled);
  EXPECT_EQ(search.candidate, second);
  EXPECT_EQ(search.bestCandidate, second);
  EXPECT_NEAR(search.bestFitness, 1, 1e-12);
  const Search settled = search;
  hurt.speed = 0.1;
  tick();
  EXPECT_EQ(search.clock, 0);
  EXPECT_EQ(search.trials.size(), settled.trials.size());
  EXPECT_EQ(hurt.speed, map.candidates[second].speed) << "in every tick";
}

TEST_F(Adapt, ARecordSurvivesReadingAndWriting) {
  ReferenceHerd herd(flatField(), 2);
  herd.adapt(map);
  hurt.stuck = 1;
  tick();
  trial();
  for (int i = 0; i < 100; ++i) tick();
  search.trials.front().fitness = 0.25;
  validation::putSearch(herd.state(), 1, search);
  const std::vector<float> once = herd.state().search;
  validation::putSearch(herd.state(), 1, validation::searchOf(herd.state(), 1));
  EXPECT_EQ(herd.state().search, once);
  EXPECT_EQ(std::ranges::count(once, 0.25f), 1);
}

TEST(AdaptMap, SurvivesWritingAndReading) {
  const GaitMap map = oneLegMap(spiderCreature());
  const GaitMap got = validation::gaitMapOf(recordsOf(map), 8);
  ASSERT_EQ(got.candidates.size(), 9u);
  for (size_t c = 0; c < 9; ++c) {
    const GaitCandidate &want = map.candidates[c], &found = got.candidates[c];
    EXPECT_EQ(found.groups, want.groups);
    EXPECT_FLOAT_EQ(static_cast<float>(found.expected), static_cast<float>(want.expected));
    for (size_t l = 0; l < 8; ++l) {
      EXPECT_EQ(found.legs[l].neighbours, want.legs[l].neighbours);
      EXPECT_EQ(found.legs[l].slowness, want.legs[l].slowness);
      EXPECT_NEAR(found.shares[l], want.shares[l], 1e-7);
    }
  }
}

// A herd that the reference walks, and what replay says of it.
class AdaptingHerd : public testing::Test {
 protected:
  AdaptingHerd() {
    herd.adapt(demanding());
    hurt(0, 3);
    hurt(1, 5);
    herd.state().hurt[2 * stride + 2] = 1;  // lame
  }
  // No gait is as good as this map has it, so searches are long.
  static GaitMap demanding() {
    GaitMap map = oneLegMap(spiderCreature());
    for (GaitCandidate& candidate : map.candidates) candidate.expected += 1;
    return map;
  }
  void hurt(size_t agent, size_t leg) {
    herd.state().hurt[agent * stride + 1] += static_cast<float>(1u << leg);
  }
  // The states around the tick in which an agent chooses after so many trials.
  std::pair<HerdState, HerdState> choiceOf(size_t agent, size_t trials) {
    for (int i = 0; i < 3000; ++i) {
      HerdState before = herd.state();
      herd.tick();
      const Search was = validation::searchOf(before, agent);
      const Search is = validation::searchOf(herd.state(), agent);
      if (is.trials.size() == trials && (trials == 0 ? is.idle != was.idle : was.trials.size() < trials))
        return {before, herd.state()};
    }
    throw std::runtime_error("the agent does not choose");
  }
  validation::StageResult judged(const HerdState& before, const HerdState& after) {
    validation::Replay replay(herd.facts(), {crowd::StageId::adapt});
    replay.tick(herd.ticks(), before, after);
    return replay.results().front();
  }
  // As if the device had chosen so.
  HerdState choosing(const HerdState& state, size_t agent, Searching does, uint32_t candidate) const {
    HerdState other = state;
    Search search = validation::searchOf(other, agent);
    search.does = does;
    search.candidate = candidate;
    validation::putSearch(other, agent, search);
    const validation::HerdFacts facts = herd.facts();
    const GaitMap map = validation::gaitMapOf(facts.gaitMap, 8);
    const reference::Hurt record = validation::hurtOf(other, agent, 8);
    validation::putHurtGait(other, agent, reference::hurtWith(map.candidates[candidate], record));
    return other;
  }
  // Another fitness for its last trial, with what follows for the best.
  static HerdState found(const HerdState& state, size_t agent, double fitness) {
    HerdState other = state;
    Search search = validation::searchOf(other, agent);
    search.trials.back().fitness = fitness;
    validation::putSearch(other, agent, search);
    return other;
  }

  static constexpr size_t stride = 4 * static_cast<size_t>(shared::hurtStride(8));
  ReferenceHerd herd{roughField(), 4};
};

TEST_F(AdaptingHerd, AgreesWithItself) {
  validation::Replay replay = herd.replay();
  uint64_t choices = 0;
  for (int i = 0; i < 900; ++i) {
    if (i == 700) hurt(3, 1);
    const HerdState before = herd.state();
    herd.tick();
    replay.tick(herd.ticks(), before, herd.state());
    for (size_t agent = 0; agent < 4; ++agent)
      choices += validation::searchOf(before, agent).trials.size() <
                 validation::searchOf(herd.state(), agent).trials.size();
  }
  EXPECT_TRUE(replay.pass()) << validation::table(replay.results());
  const auto results = replay.results();
  const auto adapt = std::ranges::find(results, std::string("adapt"), &validation::StageResult::name);
  ASSERT_NE(adapt, results.end());
  EXPECT_EQ(adapt->samples, 4u * 900);
  EXPECT_EQ(adapt->ties, 0u);
  EXPECT_GE(choices, 6u);
  EXPECT_EQ(validation::searchOf(herd.state(), 3).idle, 2u);
}

TEST_F(AdaptingHerd, AnotherChoiceIsRefused) {
  for (const size_t trials : {0, 1, 2}) {
    const auto [before, after] = choiceOf(0, trials);
    ASSERT_TRUE(judged(before, after).pass) << judged(before, after).why;
    const uint32_t chosen = validation::searchOf(after, 0).candidate;
    for (uint32_t c = 0; c < 9; ++c) {
      const auto result = judged(before, choosing(after, 0, Searching::searches, c));
      EXPECT_EQ(result.pass, c == chosen) << trials << " " << c << " " << result.why;
      EXPECT_FALSE(judged(before, choosing(after, 0, Searching::settled, c)).pass) << trials << " " << c;
    }
    EXPECT_FALSE(judged(before, choosing(after, 0, Searching::atEase, chosen)).pass);
  }
}

TEST_F(AdaptingHerd, AnotherFitnessIsRefused) {
  const auto [before, after] = choiceOf(0, 1);
  const double fitness = validation::searchOf(after, 0).trials[0].fitness;
  EXPECT_FALSE(judged(before, found(after, 0, fitness + 1e-5)).pass);
}

// Candidates that are alike but for less than float32 can tell.
TEST_F(AdaptingHerd, ACloseChoiceIsATieAndItsGaitMustFollow) {
  GaitMap map = oneLegMap(spiderCreature());
  for (GaitCandidate& candidate : map.candidates) candidate.expected = 0.5;
  map.candidates[2].expected = 0.9;
  map.candidates[5].expected = 0.9 + 1e-7;
  herd.adapt(map);
  hurt(0, 3);
  const auto [before, after] = choiceOf(0, 0);
  ASSERT_EQ(validation::searchOf(after, 0).candidate, 5u);
  HerdState other = choosing(after, 0, Searching::searches, 2);
  EXPECT_TRUE(judged(before, other).pass) << judged(before, other).why;
  EXPECT_EQ(judged(before, other).ties, 1u);
  other.hurt[14] += 1;
  EXPECT_FALSE(judged(before, other).pass);
  EXPECT_FALSE(judged(before, choosing(after, 0, Searching::searches, 3)).pass);
}

// The best is as near to 0.9 of the highest fitness as float32 can tell.
TEST_F(AdaptingHerd, ACloseEndIsATie) {
  const auto first = choiceOf(0, 1);
  const double fitness = validation::searchOf(first.second, 0).bestFitness;
  herd = ReferenceHerd(roughField(), 4);
  GaitMap map = oneLegMap(spiderCreature());
  for (GaitCandidate& candidate : map.candidates) candidate.expected = fitness;
  map.candidates[0].expected = fitness / 0.9;
  herd.adapt(map);
  hurt(0, 3);
  const auto [before, after] = choiceOf(0, 1);
  ASSERT_EQ(validation::searchOf(after, 0).bestFitness, fitness);
  const auto settled = judged(before, choosing(after, 0, Searching::settled, 0));
  const auto goesOn = judged(before, choosing(after, 0, Searching::searches, 1));
  EXPECT_TRUE(settled.pass) << settled.why;
  EXPECT_TRUE(goesOn.pass) << goesOn.why;
  EXPECT_EQ(settled.ties + goesOn.ties, 1u);
}

// No rounding tells them apart, so it is no tie to take the second.
TEST_F(AdaptingHerd, OfTwinsTheFirstMustBeTaken) {
  GaitMap map = oneLegMap(spiderCreature());
  map.candidates[6].expected = map.candidates[0].expected;
  herd.adapt(map);
  hurt(0, 3);
  const auto [before, after] = choiceOf(0, 0);
  ASSERT_EQ(validation::searchOf(after, 0).candidate, 0u);
  EXPECT_FALSE(judged(before, choosing(after, 0, Searching::searches, 6)).pass);
}

// The bounds in float32, as a device may compute them.
class FloatBounds {
 public:
  explicit FloatBounds(const GaitMap& map, const std::vector<Tried>& trials) : map_(map), trials_(trials) {
    const size_t n = trials.size();
    rows_.resize(n, std::vector<float>(n));
    for (size_t i = 0; i < n; ++i) {
      for (size_t j = 0; j <= i; ++j) {
        float sum = kernel(trials[i].candidate, trials[j].candidate) + (i == j ? 0.001f : 0);
        for (size_t k = 0; k < j; ++k) sum -= rows_[i][k] * rows_[j][k];
        rows_[i][j] = i == j ? std::sqrt(sum) : sum / rows_[j][j];
      }
    }
    std::vector<float> surprises;
    for (const Tried& tried : trials)
      surprises.push_back(static_cast<float>(tried.fitness) -
                          static_cast<float>(map.candidates[tried.candidate].expected));
    w_ = solved(surprises);
  }
  double of(size_t candidate) const {
    std::vector<float> shared;
    for (const Tried& tried : trials_) shared.push_back(kernel(candidate, tried.candidate));
    const std::vector<float> u = solved(shared);
    auto mean = static_cast<float>(map_.candidates[candidate].expected);
    float variance = kernel(candidate, candidate);
    for (size_t i = 0; i < u.size(); ++i) {
      mean += u[i] * w_[i];
      variance -= u[i] * u[i];
    }
    return double{mean + 2 * std::sqrt(std::max(0.0f, variance))};
  }

 private:
  float kernel(size_t x, size_t y) const {
    return static_cast<float>(reference::gaitKernel(map_.candidates[x], map_.candidates[y]));
  }
  std::vector<float> solved(std::vector<float> right) const {
    for (size_t i = 0; i < right.size(); ++i) {
      for (size_t k = 0; k < i; ++k) right[i] -= rows_[i][k] * right[k];
      right[i] /= rows_[i][i];
    }
    return right;
  }

  const GaitMap& map_;
  const std::vector<Tried>& trials_;
  std::vector<std::vector<float>> rows_;
  std::vector<float> w_;
};

// As many gaits as in a spider's map, many of them alike.
TEST(AdaptTolerance, HoldsInFloat32AndIsNotWide) {
  GaitMap map;
  uint32_t draw = 1;
  const auto next = [&] {
    draw = draw * 1664525u + 1013904223u;
    return (draw >> 8) / 16777216.0;
  };
  for (uint32_t idle = 0; idle < 219; ++idle) {
    GaitCandidate& candidate = map.candidates.emplace_back();
    candidate.expected = double{static_cast<float>(next())};
    for (uint32_t l = 0; l < 8; ++l)
      candidate.shares.push_back((idle >> l & 1u) != 0 ? 0 : double{static_cast<float>(0.55 + 0.1 * next())});
  }
  double worst = 0, widest = 0;
  for (int search = 0; search < 20; ++search) {
    std::vector<Tried> trials;
    for (size_t n = 0; n <= 20; ++n) {
      const reference::Outlook outlook = reference::outlookOf(map, trials);
      const FloatBounds device(map, trials);
      for (const reference::Expectation& x : outlook.untried) {
        const double bound = reference::tolerance::gaitBound(outlook, x);
        worst = std::max(worst, std::abs(device.of(x.candidate) - x.bound()) / bound);
        widest = std::max(widest, bound);
      }
      size_t other = static_cast<size_t>(219 * next());
      while (std::ranges::find(trials, other, &Tried::candidate) != trials.end()) other = (other + 1) % 219;
      trials.push_back({other, double{static_cast<float>(next())}});
    }
  }
  EXPECT_LT(worst, 1);
  EXPECT_GT(worst, 1e-3) << "a bound that is never near has no use";
  EXPECT_LT(widest, 0.01);
}

}  // namespace
}  // namespace skitter::test
