// Reach-triggered stepping: no rhythm, but the same promises.
#include <cmath>

#include "crowd/leg_order.h"
#include "crowd/simulation.h"
#include "skitter/error.h"

namespace skitter::test {
namespace {

using SteppingTest = GpuTest;

Scene reaching(uint32_t agents, float speed = 1) {
  Scene scene = sceneOf(agents, speed);
  scene.herds[0].stepping = Stepping::reach;
  return scene;
}

TEST_F(SteppingTest, WalksByReachAlone) {
  Crowd crowd(device(), rollingGround(), reaching(32));
  simulate(device(), crowd, 60);
  const HerdState start = crowd.download(0);
  simulate(device(), crowd, 300);
  const HerdState end = crowd.download(0);
  double sum = 0;
  for (size_t agent = 0; agent < 32; ++agent) {
    const glm::dvec3 way = positionOf(end, agent) - positionOf(start, agent);
    EXPECT_GT(std::hypot(way.x, way.z), 0.75 * 5) << "agent " << agent;
    sum += std::hypot(way.x, way.z);
  }
  EXPECT_GT(sum / 32, 0.9 * 5);
  const Fidelity f = crowd.fidelity();
  EXPECT_LT(f.slip, 4e-4);
  EXPECT_LT(f.penetration, 3e-6);
  EXPECT_LT(f.floating, 6e-5);
  EXPECT_LT(f.reachErrorP99, 3e-3);
}

TEST_F(SteppingTest, NeighboursStandAndEveryLegSteps) {
  Crowd crowd(device(), rollingGround(), reaching(16));
  const std::vector<crowd::LegOrder> order = crowd::legOrder(crowd.rig(0));
  std::vector<int> flights(8);
  for (int tick = 0; tick < 240; ++tick) {
    simulate(device(), crowd, 1);
    const HerdState state = crowd.download(0);
    for (size_t agent = 0; agent < 16; ++agent) {
      uint32_t air = 0;
      for (size_t l = 0; l < 8; ++l)
        if (!plantedOf(state, agent * 8 + l)) air |= 1u << l, ++flights[l];
      for (size_t l = 0; l < 8; ++l) {
        if ((air >> l & 1u) == 0) continue;
        ASSERT_EQ(air & order[l].neighbours, 0u) << "tick " << tick;
      }
    }
  }
  for (const int flight : flights) EXPECT_GT(flight, 100);
}

TEST_F(SteppingTest, AgreesWithTheReference) {
  Crowd crowd(device(), rollingGround(), reaching(32, 1.5f));
  expectAllPass(replay(device(), crowd, rollingGround(), 240));
}

}  // namespace
}  // namespace skitter::test
