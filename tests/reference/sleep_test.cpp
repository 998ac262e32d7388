// Herds that fall asleep, sleep and wake, and that lock-step replay holds them to it.
#include <gtest/gtest.h>

#include <cmath>

#include "reference_herd.h"
#include "validation/convert.h"

namespace skitter::test {
namespace {

using reference::GoalKind;
using validation::Replay;
using validation::StageResult;

// A herd that stands, and its replay.
class SleepingHerd : public testing::Test {
 protected:
  SleepingHerd() {
    herd.state().sleep = true;
    for (size_t agent = 0; agent < agents; ++agent) wish(agent, GoalKind::none);
  }

  void wish(size_t agent, GoalKind kind, const glm::dvec2& way = {0, 3}) {
    const glm::dvec2 here = validation::bodyOf(herd.state(), agent).world();
    validation::putGoal(herd.state(), agent, {here + way, here - way, 1, 0.5, kind});
  }
  // `spoil` is done to the state after the last tick.
  template <typename Spoil>
  void compare(int ticks, const Spoil& spoil) {
    for (int i = 1; i <= ticks; ++i) {
      const HerdState before = herd.state();
      herd.tick();
      HerdState after = herd.state();
      if (i == ticks) spoil(after);
      replay.tick(herd.ticks(), before, after);
    }
  }
  void compare(int ticks) {
    compare(ticks, [](HerdState&) {});
  }
  size_t sleepers() const {
    size_t count = 0;
    for (size_t agent = 0; agent < agents; ++agent)
      count += validation::asleepOf(herd.state(), agent) ? 1 : 0;
    return count;
  }
  void fallAsleep() {
    for (int i = 0; i < untilAsleep; ++i) herd.tick();
    ASSERT_EQ(sleepers(), agents);
  }
  // What of the first stage that fails was worst.
  std::string failure() const {
    for (const StageResult& result : replay.results())
      if (!result.pass) return result.name + ": " + result.worst;
    return "";
  }

  static constexpr size_t agents = 6;
  static constexpr int untilAsleep = 210;  // 2 s and a breath
  ReferenceHerd herd{roughField(), agents};
  Replay replay = herd.replay();
};

TEST_F(SleepingHerd, everyoneFallsAsleepAfterABreath) {
  size_t before = 0;
  std::vector<size_t> fallen;
  for (int i = 0; i < untilAsleep; ++i) {
    herd.tick();
    EXPECT_GE(sleepers(), before);
    if (sleepers() > before) fallen.push_back(herd.ticks());
    before = sleepers();
  }
  ASSERT_EQ(before, agents);
  EXPECT_GT(fallen.front(), 120u);
  EXPECT_GE(fallen.size(), 4u) << "phases differ";
}

TEST_F(SleepingHerd, sleepIsAFixedPoint) {
  fallAsleep();
  const HerdState asleep = herd.state();
  for (int i = 0; i < 100; ++i) herd.tick();
  for (const auto records :
       {&HerdState::goal, &HerdState::steer, &HerdState::body, &HerdState::gait, &HerdState::step,
        &HerdState::arc, &HerdState::foot, &HerdState::chain, &HerdState::pose})
    EXPECT_EQ(herd.state().*records, asleep.*records);
  EXPECT_GT(herd.state().metric[0], asleep.metric[0]) << "measured all the same";
}

// They do not doze off where it is not asked for: they breathe.
TEST_F(SleepingHerd, theAwakeBreathe) {
  herd.state().sleep = false;
  for (int i = 0; i < untilAsleep; ++i) herd.tick();
  const HerdState awake = herd.state();
  for (int i = 0; i < 30; ++i) herd.tick();
  EXPECT_EQ(sleepers(), 0u);
  EXPECT_NE(herd.state().body, awake.body);
}

TEST_F(SleepingHerd, agreesWithItselfFallingAsleepSleepingAndWaking) {
  compare(untilAsleep + 10);
  EXPECT_EQ(sleepers(), agents);
  wish(1, GoalKind::point);
  wish(4, GoalKind::cross);
  compare(60);
  EXPECT_EQ(sleepers(), agents - 2);
  compare(360);
  EXPECT_EQ(sleepers(), agents - 1) << "agent 1 is there and asleep again";
  herd.state().watched = true;
  compare(1);
  EXPECT_EQ(sleepers(), 0u);
  compare(130);
  herd.state().watched = false;
  compare(80);
  EXPECT_EQ(sleepers(), agents - 1);
  EXPECT_TRUE(replay.pass()) << validation::table(replay.results());
  const auto results = replay.results();
  EXPECT_EQ(results[0].ties, 0u);
  // Only of those who are awake.
  EXPECT_LT(results[1].samples, results[0].samples - 6 * 200);
}

TEST_F(SleepingHerd, isWokenByItsGoal) {
  fallAsleep();
  wish(2, GoalKind::cross);
  herd.tick();
  EXPECT_EQ(sleepers(), agents - 1);
  EXPECT_FALSE(validation::asleepOf(herd.state(), 2));
  EXPECT_EQ(validation::bodyOf(herd.state(), 2).still, 0);
}

TEST_F(SleepingHerd, aFlagWithoutTheOptionIsFound) {
  fallAsleep();
  compare(1, [](HerdState& s) { s.sleep = false; });
  EXPECT_NE(failure().find("navigate: asleep"), std::string::npos) << failure();
}

TEST_F(SleepingHerd, aFlagSoonAfterAnEditIsFound) {
  fallAsleep();
  compare(1, [](HerdState& s) { s.watched = true; });
  EXPECT_NE(failure().find("navigate: asleep"), std::string::npos) << failure();
}

TEST_F(SleepingHerd, halfAFlagIsFound) {
  fallAsleep();
  compare(1, [](HerdState& s) { s.steer[4 * 3 + 2] = 0.5f; });
  EXPECT_NE(failure().find("navigate: asleep"), std::string::npos) << failure();
  EXPECT_NE(failure().find("agent 3"), std::string::npos) << failure();
}

TEST_F(SleepingHerd, aFlagOfOneWhoWalksIsFound) {
  fallAsleep();
  wish(2, GoalKind::cross);
  compare(1, [](HerdState& s) { s.steer[4 * 2 + 2] = 1; });
  EXPECT_NE(failure().find("navigate: asleep"), std::string::npos) << failure();
  EXPECT_NE(failure().find("agent 2"), std::string::npos) << failure();
}

// One who should sleep and does not is compared with one who is awake.
TEST_F(SleepingHerd, aFlagTooFewIsFoundAndTheRestFollows) {
  fallAsleep();
  const HerdState before = herd.state();
  herd.state().sleep = false;
  herd.tick();
  HerdState after = herd.state();
  after.sleep = true;
  replay.tick(herd.ticks(), before, after);
  const auto results = replay.results();
  EXPECT_FALSE(results[0].pass);
  for (size_t s = 1; s < results.size(); ++s) EXPECT_TRUE(results[s].pass) << failure();
  EXPECT_EQ(results[1].samples, agents);
}

// Records that stay as they are without a flag are those of nobody: for the awake time goes on.
TEST_F(SleepingHerd, isNotStillWithoutAFlag) {
  fallAsleep();
  HerdState state = herd.state();
  state.sleep = false;
  for (size_t agent = 0; agent < agents; ++agent) state.steer[4 * agent + 2] = 0;
  state.metric.clear();
  replay.tick(herd.ticks() + 1, state, state);
  EXPECT_NE(failure().find("body: still time"), std::string::npos) << failure();
}

// What is not near is no tie; what is counts once, however long the sleep that it began.
TEST_F(SleepingHerd, aNearTieFollowsTheDeviceAndCountsOnce) {
  fallAsleep();
  const auto fall = [&](float phase) {
    herd.state().gait[8 * 5] = phase;
    HerdState before = herd.state(), after = herd.state();
    before.steer[4 * 5 + 2] = 0;
    after.steer[4 * 5 + 2] = 1;
    Replay other = herd.replay();
    // Measured 20 times alike: not of interest here.
    for (HerdState* state : {&before, &after}) state->metric.clear();
    for (uint64_t n = 1; n <= 20; ++n) other.tick(n, n == 1 ? before : after, after);
    return other.results()[0];
  };
  const double first = herd.parameters().dt / double{herd.state().gait[8 * 5 + 5]};
  const auto near = static_cast<float>(first);
  const float above = std::nextafter(near, 1.0f), beyond = static_cast<float>(first * (1 + 1e-6));
  ASSERT_GE(above, first);
  EXPECT_TRUE(fall(above).pass);
  EXPECT_EQ(fall(above).ties, 1u);
  EXPECT_FALSE(fall(beyond).pass);
  EXPECT_EQ(fall(std::nextafter(near, 0.0f)).ties, 0u);
}

TEST_F(SleepingHerd, sleepersAreMeasured) {
  fallAsleep();
  compare(1, [](HerdState& s) { s.metric[28 * 2] -= 1; });
  EXPECT_NE(failure().find("measure: ticks"), std::string::npos) << failure();
  EXPECT_NE(failure().find("agent 2"), std::string::npos) << failure();
}

TEST_F(SleepingHerd, sleepersDoNotTouchDown) {
  fallAsleep();
  compare(1, [](HerdState& s) {
    s.footfallsKept = true;
    s.footfalls.push_back({.agent = 3, .leg = 2});
  });
  EXPECT_NE(failure().find("footfall: touched down"), std::string::npos) << failure();
}

TEST_F(SleepingHerd, samplesOfAHerdSleepToo) {
  fallAsleep();
  const AgentSample every{1, 3};
  const auto part = [&] {
    HerdState state = validation::sampled(herd.state(), every);
    state.metric.clear();
    return state;
  };
  const HerdState before = part();
  herd.tick();
  HerdState after = part();
  replay.tick(herd.ticks(), before, after);
  EXPECT_TRUE(replay.pass()) << failure();
  after.body[16] += 1e-6f;
  replay.tick(herd.ticks(), before, after);
  EXPECT_NE(failure().find("body: body of a sleeper: tick 211, agent 4, leg -1"), std::string::npos)
      << failure();
}

}  // namespace
}  // namespace skitter::test
