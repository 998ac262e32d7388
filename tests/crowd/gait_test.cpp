// What the gait promises, from the states of a walk: neighbours are never in the air together, nobody is ever
// about to fall over on flat ground, and the legs of a side lift in a spider's order.
#include <cmath>
#include <complex>
#include <glm/gtc/constants.hpp>
#include <map>
#include <set>

#include "crowd/leg_order.h"
#include "crowd/simulation.h"

namespace skitter::test {
namespace {

using GaitTest = GpuTest;

// Six legs of the built-in spider: a hexapod in alternating tripods.
Rig hexapod() {
  Rig rig = spiderRig();
  std::vector<Leg> legs;
  for (Leg leg : rig.legs) {
    if (leg.name.back() == '3') continue;
    if (leg.name.back() == '2') leg.home.z = 0;
    if (leg.name.back() == '4') leg.group = 1 - leg.group;
    legs.push_back(leg);
  }
  rig.legs = legs;
  rig.gaits.clear();  // of eight legs
  rig.vertices.clear();
  rig.indices.clear();
  return rig;
}

// The law of docs/stages/gait.md, written out: who must stand while a leg is in the air. Around a spider's
// body every next leg is of the other group; below eight legs it is every leg of another group.
const std::map<std::string, std::set<std::string>> kBesideOfSpider = {
    {"L1", {"R1", "L2"}}, {"L2", {"L1", "L3"}}, {"L3", {"L2", "L4"}}, {"L4", {"L3", "R4"}},
    {"R1", {"L1", "R2"}}, {"R2", {"R1", "R3"}}, {"R3", {"R2", "R4"}}, {"R4", {"R3", "L4"}}};

uint32_t mustStand(const Rig& rig, size_t leg) {
  uint32_t mask = 0;
  for (size_t other = 0; other < rig.legs.size(); ++other) {
    const bool stands = rig.legs.size() < 8
                            ? rig.legs[other].group != rig.legs[leg].group
                            : kBesideOfSpider.at(rig.legs[leg].name).count(rig.legs[other].name) > 0;
    mask |= stands ? 1u << other : 0u;
  }
  return mask;
}

// Signed distance of the body's centre from the edge of the planted feet's hull seen from above: the least
// value of the hull's support function, over directions 3 degrees apart.
double stabilityMargin(const HerdState& state, size_t agent, size_t legs) {
  double margin = 1e9;
  for (int way = 0; way < 120; ++way) {
    const double angle = glm::two_pi<double>() * way / 120;
    double reach = -1e9;
    for (size_t leg = agent * legs; leg < (agent + 1) * legs; ++leg) {
      if (!plantedOf(state, leg)) continue;
      const float* foot = state.foot.data() + leg * 4;
      reach = std::max(reach, std::cos(angle) * foot[0] + std::sin(angle) * foot[2]);
    }
    margin = std::min(margin, reach);
  }
  return margin;
}

void expectOrderly(Device& device, const Heightfield& ground, const Scene& scene, const Rig& rig, int ticks,
                   int stableFrom) {
  Crowd crowd(device, ground, scene, {.rigs = {rig}});
  const auto legs = static_cast<size_t>(rig.legCount());
  std::vector<int> flights(legs);
  for (int tick = 0; tick < ticks; ++tick) {
    simulate(device, crowd, 1);
    const HerdState state = crowd.download(0);
    for (size_t agent = 0; agent < state.agents; ++agent) {
      uint32_t air = 0;
      for (size_t leg = 0; leg < legs; ++leg)
        if (!plantedOf(state, agent * legs + leg)) air |= 1u << leg;
      for (size_t leg = 0; leg < legs; ++leg) {
        if ((air >> leg & 1u) == 0) continue;
        ++flights[leg];
        ASSERT_EQ(air & mustStand(rig, leg), 0u) << "agent " << agent << " at tick " << tick;
      }
      if (tick >= stableFrom) {
        ASSERT_GE(stabilityMargin(state, agent, legs), 0) << "agent " << agent << " at tick " << tick;
      }
    }
  }
  for (size_t leg = 0; leg < legs; ++leg)
    EXPECT_GT(flights[leg], 0) << rig.legs[leg].name << " never stepped";
}

TEST_F(GaitTest, NeighboursStandOnRollingGround) {
  expectOrderly(device(), rollingGround(), sceneOf(32), spiderRig(), 240, 240);
}

TEST_F(GaitTest, NeighboursStandAtACliffAndFast) {
  expectOrderly(device(), cliffGround(), sceneOf(16, 2), spiderRig(), 400, 400);
}

TEST_F(GaitTest, SpidersNeverTopple) {
  for (const float speed : {0.3f, 1.0f, 3.0f})
    expectOrderly(device(), flatGround(), sceneOf(16, speed), spiderRig(), 240, 0);
}

// Six legs cannot take turns as fast as a body that starts leaves its feet behind; walking, they do.
TEST_F(GaitTest, HexapodsNeverToppleOnceTheyWalk) {
  for (const float speed : {0.3f, 1.0f})
    expectOrderly(device(), flatGround(), sceneOf(16, speed), hexapod(), 240, 60);
}

TEST_F(GaitTest, LegsOfASideLiftInTheOrder4231) {
  Crowd crowd(device(), flatGround(), sceneOf(1));
  const Rig& rig = crowd.rig(0);
  simulate(device(), crowd, 120);
  std::map<std::string, std::complex<double>> when;
  HerdState before = crowd.download(0);
  for (int tick = 0; tick < 240; ++tick) {
    simulate(device(), crowd, 1);
    HerdState after = crowd.download(0);
    for (size_t leg = 0; leg < 8; ++leg)
      if (plantedOf(before, leg) && !plantedOf(after, leg))
        when[rig.legs[leg].name] += std::polar(1.0, glm::two_pi<double>() * after.gait[0]);
    before = std::move(after);
  }
  for (const std::string side : {"L", "R"}) {
    double last = 0;
    for (const char* pair : {"2", "3", "1"}) {
      const double turns = std::arg(when[side + pair] / when[side + "4"]) / glm::two_pi<double>();
      const double after = turns - std::floor(turns);
      EXPECT_GT(after, last + 0.03) << side << pair;
      last = after;
    }
    // 4 and 2 are of one group and lift a small lag apart, and so do 3 and 1.
    const double lag = std::arg(when[side + "2"] / when[side + "4"]) / glm::two_pi<double>();
    EXPECT_GT(lag, 0.1) << side;
    EXPECT_LT(lag, 0.2) << side;
  }
}

TEST(LegOrder, OfTheSpider) {
  const Rig rig = spiderRig();
  const std::vector<crowd::LegOrder> order = crowd::legOrder(rig);
  // Where the model has the feet of the legs 1 to 4, metres forward. A group has one leg of each number.
  const double forward[] = {0.540691665, 0.189204646, -0.205754984, -0.563896882};
  for (size_t l = 0; l < 8; ++l) {
    SCOPED_TRACE(rig.legs[l].name);
    const double at = forward[rig.legs[l].name[1] - '1'];
    EXPECT_EQ(order[l].neighbours, mustStand(rig, l));
    EXPECT_NEAR(order[l].lag, (at - forward[3]) / (forward[0] - forward[3]), 1e-6);
  }
}

// Four legs in a trot: the front one and the rear one of a side would be a whole lag apart, and wait for each
// other.
TEST(LegOrder, OfTheQuadruped) {
  Rig rig = spiderRig();
  rig.legs = {rig.legs[0], rig.legs[1], rig.legs[6], rig.legs[7]};  // L1 R1 L4 R4, of the groups A B B A
  const std::vector<crowd::LegOrder> order = crowd::legOrder(rig);
  const uint32_t neighbours[] = {0b0110, 0b1001, 0b1001, 0b0110};
  const float lags[] = {0.75f, 0.75f, 0, 0};
  for (size_t l = 0; l < 4; ++l) {
    EXPECT_EQ(order[l].neighbours, neighbours[l]) << rig.legs[l].name;
    EXPECT_NEAR(order[l].lag, lags[l], 1e-6) << rig.legs[l].name;
  }
}

// Beside each other and of one group, they swing together.
TEST(LegOrder, LegsOfOneGroupAreNoNeighbours) {
  Rig rig = spiderRig();
  ASSERT_EQ(rig.legs[2].name, "L2");
  rig.legs[2].group = rig.legs[0].group;
  const std::vector<crowd::LegOrder> order = crowd::legOrder(rig);
  EXPECT_EQ(order[2].neighbours, 0u);          // L1 and L3 are of its group
  EXPECT_EQ(order[0].neighbours, 0b10u);       // R1
  EXPECT_EQ(order[4].neighbours, 0b1000000u);  // L4
  EXPECT_EQ(order[7].neighbours, mustStand(rig, 7));
}

TEST_F(GaitTest, AnyNumberOfLegsHasAnOrder) {
  const Rig spider = spiderRig();
  for (size_t legs = 1; legs <= spider.legs.size(); ++legs) {
    Rig rig = spider;
    rig.legs.resize(legs);
    const std::vector<crowd::LegOrder> order = crowd::legOrder(rig);
    for (size_t l = 0; l < legs; ++l) {
      EXPECT_GE(order[l].lag, 0);
      EXPECT_LE(order[l].lag, 1);
      EXPECT_EQ(order[l].neighbours >> legs, 0u);
      for (size_t m = 0; m < legs; ++m) {
        EXPECT_EQ(order[l].neighbours >> m & 1u, order[m].neighbours >> l & 1u);
        const bool sameGroup = rig.legs[l].group == rig.legs[m].group;
        if (sameGroup || legs < 8) {
          EXPECT_EQ(order[l].neighbours >> m & 1u, sameGroup ? 0u : 1u);
        }
      }
    }
  }
}

TEST_F(GaitTest, NobodyStepsWithoutAGoal) {
  Scene scene = sceneOf(64);
  scene.herds[0].goal.kind = Goal::Kind::none;
  Crowd crowd(device(), rollingGround(), scene);
  simulate(device(), crowd, 120);
  const HerdState settled = crowd.download(0);
  simulate(device(), crowd, 240);
  const HerdState later = crowd.download(0);
  EXPECT_EQ(settled.step, later.step);
  for (size_t leg = 0; leg < settled.foot.size() / 4; ++leg) EXPECT_TRUE(plantedOf(later, leg));
}

}  // namespace
}  // namespace skitter::test
