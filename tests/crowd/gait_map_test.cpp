// The map of gaits that an agent tries (docs/stages/adapt.md#the-map), against the reference's kernel.
#include "crowd/gait_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "cpu_reference/stages/adapt.h"
#include "cpu_reference/stages/tolerances.h"
#include "crowd/leg_order.h"
#include "crowd/regait.h"
#include "shared/adapt.h"
#include "skitter/rig.h"
#include "skitter/tuning.h"
#include "validation/convert.h"

namespace skitter::test {
namespace {

// A spider's, which is made once.
class GaitMapTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    made = new crowd::GaitMap(crowd::gaitMapOf(spiderRig(), Tuning{}));
    read = new reference::GaitMap(validation::gaitMapOf(*made, legs));
  }
  static void TearDownTestSuite() {
    delete made;
    delete read;
  }
  static uint32_t idleOf(const reference::GaitCandidate& candidate) {
    uint32_t idle = 0;
    for (size_t l = 0; l < candidate.shares.size(); ++l)
      if (candidate.shares[l] == 0) idle |= 1u << l;
    return idle;
  }

  static constexpr int legs = 8;
  static inline crowd::GaitMap* made = nullptr;
  static inline reference::GaitMap* read = nullptr;
  const Rig rig = spiderRig();
};

TEST_F(GaitMapTest, RowsAreTheReferencesKernelToFloatRounding) {
  const auto all = static_cast<int>(made->candidates);
  constexpr double most = reference::tolerance::gaitKernel;
  for (int x = 0; x < all; ++x)
    for (int y = 0; y < all; ++y) {
      const size_t row = 4 * static_cast<size_t>(shared::gaitMapRow(x, all, legs));
      const double want = reference::gaitKernel(read->candidates[static_cast<size_t>(x)],
                                                read->candidates[static_cast<size_t>(y)]);
      ASSERT_NEAR(double{made->records[row + static_cast<size_t>(y)]}, want, most) << x << " " << y;
    }
  const int end = shared::gaitMapRow(all, all, legs);
  EXPECT_EQ(made->records.size(), 4 * static_cast<size_t>(end));
}

TEST_F(GaitMapTest, BeginsWithTheWholeCreaturesGait) {
  const reference::GaitCandidate& whole = read->candidates[0];
  EXPECT_EQ(idleOf(whole), 0u);
  EXPECT_EQ(whole.expected, 1);
  EXPECT_EQ(whole.speed, 1);
  EXPECT_EQ(whole.groups, rig.groupCount());
  EXPECT_EQ(whole.shift, glm::dvec3(0));
  const std::vector<crowd::LegOrder> order = crowd::legOrder(rig);
  for (size_t l = 0; l < rig.legs.size(); ++l) {
    EXPECT_EQ(whole.legs[l].group, rig.legs[l].group);
    EXPECT_EQ(whole.legs[l].lag, double{order[l].lag});
    EXPECT_EQ(whole.legs[l].neighbours, order[l].neighbours);
    EXPECT_EQ(whole.legs[l].slowness, 1);
    EXPECT_GT(whole.shares[l], 0.3);
  }
}

TEST_F(GaitMapTest, HasEveryPatternOnceByItsMask) {
  const std::vector<uint32_t> patterns = crowd::walkingPatterns(rig);
  ASSERT_EQ(read->candidates.size(), 1 + patterns.size());
  EXPECT_EQ(patterns.size(), 218u);
  for (size_t c = 0; c < patterns.size(); ++c) EXPECT_EQ(idleOf(read->candidates[c + 1]), patterns[c]) << c;
}

TEST_F(GaitMapTest, HasTheGaitOfEachPattern) {
  for (const reference::GaitCandidate& candidate : read->candidates) {
    const uint32_t idle = idleOf(candidate);
    const crowd::Regait gait = crowd::regaitFor(rig, Tuning{}, {.idle = idle});
    EXPECT_EQ(candidate.groups, gait.groups) << idle;
    EXPECT_EQ(candidate.speed, double{gait.speed}) << idle;
    EXPECT_EQ(candidate.expected, double{gait.worth}) << idle;
    EXPECT_EQ(candidate.shift, glm::dvec3(gait.shift)) << idle;
    for (size_t l = 0; l < rig.legs.size(); ++l) {
      if ((idle >> l & 1u) != 0) continue;
      const crowd::LegTurn& turn = gait.legs[l];
      EXPECT_EQ(candidate.legs[l].group, double{static_cast<float>(turn.group) + turn.within}) << idle;
      EXPECT_EQ(candidate.legs[l].lag, double{turn.lag}) << idle;
      EXPECT_EQ(candidate.legs[l].neighbours, turn.neighbours) << idle;
      EXPECT_EQ(candidate.legs[l].slowness, double{turn.slowness}) << idle;
    }
  }
}

TEST_F(GaitMapTest, LegsThatAreIdleInAPatternGoAlong) {
  const std::vector<crowd::LegOrder> order = crowd::legOrder(rig);
  for (const reference::GaitCandidate& candidate : read->candidates) {
    const uint32_t idle = idleOf(candidate);
    for (size_t l = 0; l < rig.legs.size(); ++l) {
      const reference::Hurt::Turn& turn = candidate.legs[l];
      EXPECT_EQ(turn.neighbours & idle, 0u) << idle << ": nobody waits for them";
      if ((idle >> l & 1u) == 0) continue;
      EXPECT_EQ(turn.group, rig.legs[l].group % candidate.groups) << idle;
      EXPECT_EQ(turn.lag, double{order[l].lag}) << idle;
      EXPECT_EQ(turn.neighbours, 0u) << idle;
      EXPECT_EQ(turn.slowness, 1) << idle;
    }
  }
}

// 1 - T / C, of the step and the cycle of docs/damage.md at 1.5 sigma leg lengths a second.
TEST_F(GaitMapTest, SharesAreThoseOfStepAndCycle) {
  const Tuning usual;
  for (const reference::GaitCandidate& candidate : read->candidates) {
    const uint32_t idle = idleOf(candidate);
    double slowest = 0;
    for (size_t l = 0; l < rig.legs.size(); ++l)
      if ((idle >> l & 1u) == 0) slowest = std::max(slowest, candidate.legs[l].slowness);
    const double speed = 1.5 * candidate.speed;
    const double fresh = double{usual.swingStill} / (1 + speed / double{usual.swingSpeed});
    const double duty =
        std::max(double{usual.dutyStill} - double{usual.dutyGain} * speed, double{usual.dutyLeast});
    const double cycle =
        std::max(std::min(double{usual.cycleMax}, fresh / (1 - duty)),
                 candidate.groups * std::max(fresh, slowest * fresh) * double{usual.windowSlack});
    for (size_t l = 0; l < rig.legs.size(); ++l) {
      if ((idle >> l & 1u) != 0) continue;
      EXPECT_NEAR(candidate.shares[l], 1 - candidate.legs[l].slowness * fresh / cycle, 1e-6)
          << idle << " " << l;
    }
  }
}

}  // namespace
}  // namespace skitter::test
