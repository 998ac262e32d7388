// What the gait promises, from the states of a walk: two groups are never in the air together, steps are
// regular, and the legs of a group share them.
#include <set>

#include "crowd/simulation.h"

namespace skitter::test {
namespace {

using GaitTest = GpuTest;

void expectOneGroupInTheAir(Device& device, const Heightfield& ground, const Scene& scene, int ticks) {
  Crowd crowd(device, ground, scene);
  const Rig& rig = crowd.rig(0);
  const auto legs = static_cast<size_t>(rig.legCount());
  std::vector<int> flights(legs);
  for (int tick = 0; tick < ticks; ++tick) {
    simulate(device, crowd, 1);
    const HerdState state = crowd.download(0);
    for (size_t agent = 0; agent < state.agents; ++agent) {
      std::set<int> groups;
      for (size_t leg = 0; leg < legs; ++leg) {
        if (plantedOf(state, agent * legs + leg)) continue;
        groups.insert(rig.legs[leg].group);
        ++flights[leg];
      }
      ASSERT_LE(groups.size(), 1u) << "agent " << agent << " at tick " << tick;
    }
  }
  for (size_t leg = 0; leg < legs; ++leg)
    EXPECT_GT(flights[leg], 0) << rig.legs[leg].name << " never stepped";
}

TEST_F(GaitTest, OneGroupInTheAirOnRollingGround) {
  expectOneGroupInTheAir(device(), rollingGround(), sceneOf(32), 240);
}

TEST_F(GaitTest, OneGroupInTheAirAtACliffAndFast) {
  expectOneGroupInTheAir(device(), cliffGround(), sceneOf(16, 2), 400);
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
