// The gaits that the rule of docs/damage.md finds for legs that do not carry.
#include "crowd/regait.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <set>
#include <string>
#include <utility>

#include "crowd/damage.h"
#include "crowd/leg_order.h"

namespace skitter::test {
namespace {

using crowd::LegPattern, crowd::Regait, crowd::regaitByRule;

uint32_t maskOf(const Rig& rig, const std::set<std::string>& names) {
  uint32_t mask = 0;
  for (size_t l = 0; l < rig.legs.size(); ++l)
    if (names.contains(rig.legs[l].name)) mask |= 1u << l;
  return mask;
}

Regait spiderWithout(const std::set<std::string>& names) {
  const Rig rig = spiderRig();
  return regaitByRule(rig, Tuning{}, {.idle = maskOf(rig, names)});
}

// How far the body's centre is inside the feet that stand while a group is in the air, at the moment `part`
// of its step: the least value of the support function, over directions a degree apart. Feet go back at the
// gait's share of one leg length per second.
double marginOf(const Rig& rig, const Regait& gait, uint32_t idle, int air, double part) {
  const Tuning usual;
  const double speed = double{gait.speed};
  const double step = double{usual.swingStill} / (1 + speed / double{usual.swingSpeed});
  const double duty = double{usual.dutyStill} - double{usual.dutyGain} * speed;
  const double cycle = std::max(step / (1 - duty), gait.groups * step * double{usual.windowSlack});
  double margin = 1e9;
  for (int way = 0; way < 360; ++way) {
    const double angle = std::numbers::pi * way / 180;
    double reach = -1e9;
    for (size_t l = 0; l < rig.legs.size(); ++l) {
      if ((idle >> l & 1u) != 0 || gait.legs[l].group == air) continue;
      const double own = double{gait.legs[l].slowness} * step;
      const int before = (air - gait.legs[l].group + gait.groups) % gait.groups;
      const double stood = before * cycle / gait.groups + (part - 1) * own;
      const double ahead = speed * ((cycle - own) / 2 - stood);
      const glm::vec3 foot = rig.legs[l].home + gait.shift;
      reach = std::max(reach, std::cos(angle) * double{foot.x} + std::sin(angle) * (double{foot.z} + ahead));
    }
    margin = std::min(margin, reach);
  }
  return margin;
}

TEST(Regait, AWholeCreatureKeepsItsOwn) {
  const Rig rig = spiderRig();
  const Regait gait = spiderWithout({});
  const auto order = crowd::legOrder(rig);
  EXPECT_EQ(gait.groups, rig.groupCount());
  EXPECT_EQ(gait.shift, glm::vec3(0));
  EXPECT_EQ(gait.speed, 1);
  for (size_t l = 0; l < rig.legs.size(); ++l) {
    EXPECT_EQ(gait.legs[l].group, rig.legs[l].group);
    EXPECT_EQ(gait.legs[l].lag, order[l].lag);
    EXPECT_EQ(gait.legs[l].neighbours, order[l].neighbours);
    EXPECT_EQ(gait.legs[l].slowness, 1);
  }
}

TEST(Regait, WithoutR2AndL3ASpiderGoesOnTripods) {
  const Rig rig = spiderRig();
  const Regait gait = spiderWithout({"R2", "L3"});
  ASSERT_EQ(gait.groups, 2);
  std::set<std::set<std::string>> groups;
  for (int g = 0; g < 2; ++g) {
    std::set<std::string> names;
    for (size_t l = 0; l < rig.legs.size(); ++l)
      if (gait.legs[l].group == g && rig.legs[l].name != "R2" && rig.legs[l].name != "L3")
        names.insert(rig.legs[l].name);
    groups.insert(names);
  }
  EXPECT_EQ(groups, (std::set<std::set<std::string>>{{"L1", "R3", "L4"}, {"R1", "L2", "R4"}}));
}

TEST(Regait, ASpiderOnSixLegsOrMoreStandsWhileAnyGroupIsInTheAir) {
  const Rig rig = spiderRig();
  for (uint32_t idle = 1; idle < 256; ++idle) {
    if (std::popcount(idle) > 2) continue;
    const Regait gait = regaitByRule(rig, Tuning{}, {.idle = idle});
    for (int air = 0; air < gait.groups; ++air)
      for (const double part : {0.0, 0.25, 0.5, 0.75, 1.0})
        EXPECT_GT(marginOf(rig, gait, idle, air, part), 0.0299)
            << "idle " << idle << ", group " << air << ", " << part;
  }
}

TEST(Regait, ASpiderKeepsItsSpeedWithoutALegAndMostOfItWithoutTwo) {
  const Rig rig = spiderRig();
  int whole = 0;
  for (uint32_t idle = 1; idle < 256; ++idle) {
    if (std::popcount(idle) > 2) continue;
    const float speed = regaitByRule(rig, Tuning{}, {.idle = idle}).speed;
    if (std::popcount(idle) == 1) {
      EXPECT_EQ(speed, 1) << "idle " << idle;
    }
    EXPECT_GE(speed, 0.8f) << "idle " << idle;
    whole += speed == 1;
  }
  EXPECT_EQ(whole, 8 + 24);
}

// As far as does not slow the body, or as in its own gait.
TEST(Regait, NoLegIsStretchedTooFarWhereOneCanWalk) {
  const Rig rig = spiderRig();
  for (uint32_t idle = 1; idle < 256; ++idle) {
    if (std::popcount(idle) > 5) continue;
    const Regait gait = regaitByRule(rig, Tuning{}, {.idle = idle});
    const float step = 0.35f / (1 + gait.speed / 1.7f);
    const float cycle = std::max(step / (0.25f + 0.05f * gait.speed), 1.1f * gait.groups * step);
    const float half = gait.speed * (cycle - (gait.groups > 2 ? 0.75f : 1.0f) * step) / 2;
    for (size_t l = 0; l < 8; ++l) {
      if ((idle >> l & 1u) != 0) continue;
      for (const float ahead : {-half, half}) {
        const glm::vec3 foot = rig.legs[l].home + gait.shift + glm::vec3(0, 0, ahead);
        EXPECT_LT(glm::distance(foot, rig.legs[l].root()) / rig.legs[l].reach, 0.931f)
            << idle << ", leg " << l;
      }
    }
  }
}

// A leg that is late must not hold up all others for good.
TEST(Regait, StepsAreQuickWhereManyGroupsTakeTurns) {
  const Rig rig = spiderRig();
  std::set<int> groups;
  for (uint32_t idle = 1; idle < 256; ++idle) {
    if (std::popcount(idle) > 5) continue;
    const Regait gait = regaitByRule(rig, Tuning{}, {.idle = idle});
    groups.insert(gait.groups);
    for (size_t l = 0; l < 8; ++l)
      if ((idle >> l & 1u) == 0) {
        EXPECT_EQ(gait.legs[l].slowness, gait.groups > 2 ? 0.75f : 1.0f) << idle;
      }
  }
  EXPECT_EQ(groups, (std::set<int>{2, 3, 4}));
}

TEST(Regait, ThreeLegsStandOrAllButOne) {
  const Rig rig = spiderRig();
  for (uint32_t idle = 1; idle < 256; ++idle) {
    const int legs = 8 - std::popcount(idle);
    if (legs < 3) continue;
    const Regait gait = regaitByRule(rig, Tuning{}, {.idle = idle});
    for (int air = 0; air < gait.groups; ++air) {
      int standing = 0;
      for (size_t l = 0; l < 8; ++l) standing += (idle >> l & 1u) == 0 && gait.legs[l].group != air;
      EXPECT_GE(standing, std::min(3, legs - 1)) << "idle " << idle;
    }
  }
}

TEST(Regait, AQuadrupedWalksOnThreeLegsAndLiesDownOnFewer) {
  Rig rig = spiderRig();
  rig.legs.erase(rig.legs.begin() + 4, rig.legs.end());
  for (uint32_t idle = 1; idle < 16; ++idle) {
    const Regait gait = regaitByRule(rig, Tuning{}, {.idle = idle});
    EXPECT_GE(gait.groups, 1) << idle;
    EXPECT_EQ(gait.speed > 0, std::popcount(idle) == 1) << idle;
    for (const float value : {gait.shift.x, gait.shift.y, gait.shift.z, gait.speed})
      EXPECT_TRUE(std::isfinite(value)) << idle;
  }
}

// Long cycles take five stretched legs, which no two groups can take turns on, beyond all reach at any speed.
TEST(Regait, WhoCannotReachGoesSlowly) {
  Rig rig = spiderRig();
  Tuning stiff;
  stiff.stretchSlow = 0.5f;
  stiff.windowSlack = 2;
  for (Leg& leg : rig.legs) leg.home = leg.root() + 1.5f * (leg.home - leg.root());
  const Regait gait = regaitByRule(rig, stiff, {.idle = maskOf(rig, {"L1", "R2", "L4"})});
  EXPECT_EQ(gait.speed, 0.5f);
  EXPECT_GE(gait.groups, 3);
}

// The gait without legs of the right side is that without those of the left one, mirrored.
TEST(Regait, MirrorsALoss) {
  for (const auto& [first, second] : {std::pair{"1", "2"}, {"2", "3"}, {"3", "4"}, {"1", "3"}, {"2", "4"}}) {
    const auto gaitWithout = [&](const char* side) {
      return spiderWithout({std::string(side) + first, std::string(side) + second});
    };
    const Regait left = gaitWithout("L"), right = gaitWithout("R");
    EXPECT_NEAR(left.shift.x, -right.shift.x, 1e-5) << first << second;
    EXPECT_NEAR(left.shift.z, right.shift.z, 1e-5) << first << second;
    EXPECT_EQ(left.speed, right.speed) << first << second;
    EXPECT_GT(left.shift.x, 0) << first << second;  // the body leans to the side that has all of its legs
  }
}

TEST(Damage, IsWhatItsValuesSay) {
  crowd::Damage damage;
  damage.set(0, LegState::lost, 15);
  damage.set(5, LegState::lost, 14);
  damage.set(6, LegState::lost, 0);
  damage.set(23, LegState::lost, 7);
  damage.set(3, LegState::stuck, 2);
  damage.set(4, LegState::lame, 2);
  EXPECT_EQ(crowd::Damage::ofValues(damage.values()), damage);
  EXPECT_EQ(damage.of(0), LegState::lost);
  EXPECT_EQ(damage.of(3), LegState::stuck);
  EXPECT_EQ(damage.of(4), LegState::lame);
  EXPECT_EQ(damage.of(7), LegState::whole);
  EXPECT_EQ(damage.bones[3], 0);
  EXPECT_EQ(damage.pattern(),
            (LegPattern{.idle = 1u << 0 | 1u << 3 | 1u << 5 | 1u << 6 | 1u << 23, .lame = 1u << 4}));
  for (const uint32_t leg : {0u, 3u, 4u, 5u, 6u, 23u}) damage.set(leg, LegState::whole, 9);
  EXPECT_TRUE(damage.isNone());
  EXPECT_EQ(damage, crowd::Damage{});
}

}  // namespace
}  // namespace skitter::test
