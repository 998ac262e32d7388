// The gaits that the rule of docs/damage.md finds for legs that do not carry.
#include "crowd/regait.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <set>
#include <string>

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

// How far the body's centre is inside the feet that stand at their homes while a group is in the air: the
// least value of the support function, over directions a degree apart.
double marginOf(const Rig& rig, const Regait& gait, uint32_t idle, int air) {
  double margin = 1e9;
  for (int way = 0; way < 360; ++way) {
    const double angle = std::numbers::pi * way / 180;
    double reach = -1e9;
    for (size_t l = 0; l < rig.legs.size(); ++l) {
      if ((idle >> l & 1u) != 0 || gait.legs[l].group == air) continue;
      const glm::vec3 foot = rig.legs[l].home + gait.shift;
      reach = std::max(reach, std::cos(angle) * foot.x + std::sin(angle) * foot.z);
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
    EXPECT_EQ(gait.speed, 1);
    for (int air = 0; air < gait.groups; ++air)
      EXPECT_GT(marginOf(rig, gait, idle, air), 0.03) << "idle " << idle << ", group " << air;
  }
}

TEST(Regait, LegsOfOtherGroupsStand) {
  const Rig rig = spiderRig();
  for (uint32_t idle = 1; idle < 256; ++idle) {
    const Regait gait = regaitByRule(rig, Tuning{}, {.idle = idle});
    std::set<int> groups;
    for (size_t a = 0; a < 8; ++a) {
      if ((idle >> a & 1u) != 0) continue;
      groups.insert(gait.legs[a].group);
      for (size_t b = 0; b < 8; ++b) {
        const bool waits = (gait.legs[a].neighbours >> b & 1u) != 0;
        EXPECT_EQ(waits, (idle >> b & 1u) == 0 && gait.legs[a].group != gait.legs[b].group)
            << "idle " << idle << ", legs " << a << " and " << b;
      }
    }
    EXPECT_EQ(gait.groups, std::max<int>(1, static_cast<int>(groups.size()))) << "idle " << idle;
  }
}

TEST(Regait, OnTwoLegsACreatureLiesDown) {
  const Rig rig = spiderRig();
  for (const uint32_t idle : {0xffu, 0xfeu, 0x7eu}) {
    const Regait gait = regaitByRule(rig, Tuning{}, {.idle = idle});
    EXPECT_EQ(gait.speed, 0);
    EXPECT_EQ(gait.shift, glm::vec3(0, rig.bodyHeight, 0));
  }
  EXPECT_GT(regaitByRule(rig, Tuning{}, {.idle = 0xf8u}).speed, 0);
}

TEST(Regait, LameLegsSlowTheWalk) {
  const Rig rig = spiderRig();
  const Regait gait = regaitByRule(rig, Tuning{}, {.lame = 0b101});
  EXPECT_EQ(gait.groups, rig.groupCount());
  EXPECT_FLOAT_EQ(gait.speed, 1 - 2.0f / 16);
  for (size_t l = 0; l < 8; ++l)
    EXPECT_EQ(gait.legs[l].slowness, l == 0 || l == 2 ? crowd::lameSlowness : 1.0f);
  // A leg that does not carry is not lame.
  EXPECT_EQ(regaitByRule(rig, Tuning{}, {.idle = 1, .lame = 1}).speed, 1);
}

// The gait without a right leg is that without the left one, mirrored.
TEST(Regait, MirrorsALoss) {
  const Rig rig = spiderRig();
  const auto shiftWithout = [&](const char* leg) { return spiderWithout({leg}).shift; };
  for (const char* number : {"1", "2", "3", "4"}) {
    const std::string left = std::string("L") + number, right = std::string("R") + number;
    const glm::vec3 a = shiftWithout(left.c_str()), b = shiftWithout(right.c_str());
    EXPECT_NEAR(a.x, -b.x, 1e-5) << number;
    EXPECT_NEAR(a.z, b.z, 1e-5) << number;
    EXPECT_GT(a.x, 0) << number;  // the body leans to the side that has all of its legs
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
