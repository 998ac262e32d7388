// Differences in ik that lock-step replay takes for rounding, and others.
#include <gtest/gtest.h>

#include <optional>

#include "cpu_reference/stages/ik.h"
#include "reference_herd.h"
#include "validation/convert.h"

namespace skitter::test {
namespace {

using namespace validation;

class IkTies : public testing::Test {
 protected:
  static constexpr size_t leg = 2;
  static constexpr size_t ikRow = 5;

  IkTies() {
    for (int i = 0; i < 60; ++i) herd.tick();
    before = herd.state();
    herd.tick();
  }

  // The foot's place after the tick, moved: as the record has it.
  reference::Foot footAt(const glm::dvec3& moved) const {
    HerdState state = herd.state();
    reference::Foot foot = footOf(state, leg);
    foot.target += moved;
    putFoot(state, leg, foot);
    return footOf(state, leg);
  }
  reference::Chain solve(const reference::Foot& foot, reference::Arithmetic& arithmetic) const {
    return reference::ik(setting.tuning, limb, bodyOf(herd.state(), 0), foot,
                         validation::chainOf(before, leg, herd.bones()), setting.ik, arithmetic);
  }
  std::vector<bool> decisionsAt(const glm::dvec3& moved) const {
    reference::Arithmetic exact;
    solve(footAt(moved), exact);
    return exact.decisions();
  }

  // The last place from `foot` along `way` before a decision turns.
  glm::dvec3 lastBeforeItTurns(const glm::dvec3& way, double from, double to) const {
    const auto decisions = decisionsAt(way * from);
    while (to - from > 1e-9) {
      const double middle = (from + to) / 2;
      (decisionsAt(way * middle) == decisions ? from : to) = middle;
    }
    return way * from;
  }

  // The herd's state after the tick with this foot and this chain.
  StageResult judged(const reference::Foot& foot, const reference::Chain& chain) const {
    HerdState after = herd.state();
    putFoot(after, leg, foot);
    putChain(after, leg, herd.bones(), chain);
    putMiss(after, 0, leg, herd.legs(), herd.ticks(), chain.miss);
    Replay replay = herd.replay();
    replay.tick(herd.ticks(), before, after);
    return replay.results()[ikRow];
  }

  double farthest(const reference::Chain& a, const reference::Chain& b) const {
    const reference::Posture p(limb, a.directions), q(limb, b.directions);
    double apart = 0;
    for (size_t i = 1; i <= limb.bones.size(); ++i)
      apart = std::max(apart, glm::length(p.joint(i) - q.joint(i)));
    return apart;
  }

  // A foot where a decision is open, and where it leads if it falls otherwise.
  struct Tie {
    reference::Foot foot;
    reference::Chain falls, otherwise;
    std::vector<bool> told;
  };
  std::optional<Tie> findTie(double step, double leastApart) const {
    for (const glm::dvec3& way : {glm::dvec3(0, 1, 0), glm::dvec3(0, -1, 0), glm::dvec3(1, 0, 0),
                                  glm::dvec3(-1, 0, 0), glm::dvec3(0, 0, 1), glm::dvec3(0, 0, -1)}) {
      for (double s = 0; s < 0.5; s += step) {
        if (decisionsAt(way * s) == decisionsAt(way * (s + step))) continue;
        Tie tie;
        tie.foot = footAt(lastBeforeItTurns(way, s, s + step));
        reference::Arithmetic exact;
        tie.falls = solve(tie.foot, exact);
        size_t least = 0;
        for (size_t i = 1; i < exact.margins().size(); ++i)
          if (std::abs(exact.margins()[i]) < std::abs(exact.margins()[least])) least = i;
        tie.told.assign(exact.decisions().begin(),
                        exact.decisions().begin() + static_cast<ptrdiff_t>(least) + 1);
        tie.told.back().flip();
        reference::Arithmetic other(tie.told);
        tie.otherwise = solve(tie.foot, other);
        if (farthest(tie.falls, tie.otherwise) > leastApart) return tie;
      }
    }
    return {};
  }

  ReferenceHerd herd{roughField(), 1};
  const Heightfield ground = roughField();
  const Setting setting = settingOf(herd.facts(), ground);
  const reference::Limb& limb = setting.creature.limbs[leg];
  HerdState before;
};

TEST_F(IkTies, EitherEndingIsRight) {
  const auto tie = findTie(1e-3, 1e-4);
  ASSERT_TRUE(tie);
  const StageResult falls = judged(tie->foot, tie->falls), otherwise = judged(tie->foot, tie->otherwise);
  EXPECT_TRUE(falls.pass) << falls.worst;
  EXPECT_EQ(falls.ties, 0u);
  EXPECT_TRUE(otherwise.pass) << otherwise.worst;
  EXPECT_EQ(otherwise.ties, 1u);
}

TEST_F(IkTies, NothingBetweenTheEndingsIsRight) {
  const auto tie = findTie(1e-3, 1e-4);
  ASSERT_TRUE(tie);
  reference::Chain between = tie->falls;
  for (size_t i = 0; i < limb.bones.size(); ++i)
    between.directions[i] = (tie->falls.directions[i] + tie->otherwise.directions[i]) / 2.0;
  const reference::Posture posture(limb, between.directions);
  const reference::AgentBody body = bodyOf(herd.state(), 0);
  const double error = glm::length(reference::ikTarget(limb, body, tie->foot.target) - posture.tip());
  between.tip = body.orientation * (limb.root + limb.reach * posture.tip());
  between.reachError = error * limb.reach;
  between.miss = tie->foot.progress >= 1 && error > setting.tuning.missLeast ? error : 0;
  const StageResult result = judged(tie->foot, between);
  EXPECT_FALSE(result.pass);
  EXPECT_NE(result.worst.find("joint positions"), std::string::npos) << result.worst;
}

// A hair's breadth away the decision is no longer rounding's.
TEST_F(IkTies, WhatIsDecidedIsDecided) {
  const auto tie = findTie(1e-3, 1e-4);
  ASSERT_TRUE(tie);
  int decided = 0;
  for (const glm::dvec3& way : {glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1)}) {
    const reference::Foot foot = footAt(tie->foot.target + 1e-3 * way - footAt({}).target);
    reference::Arithmetic exact, other(tie->told);
    const reference::Chain falls = solve(foot, exact), otherwise = solve(foot, other);
    if (exact.decisions() == other.decisions()) continue;
    ++decided;
    EXPECT_TRUE(judged(foot, falls).pass);
    EXPECT_FALSE(judged(foot, otherwise).pass);
  }
  EXPECT_GT(decided, 0);
}

}  // namespace
}  // namespace skitter::test
