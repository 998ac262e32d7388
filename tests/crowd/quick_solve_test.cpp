// The first dispatch of stage ik leaves few legs to the second (docs/stages/ik.md).
#include "crowd/page.h"
#include "crowd/simulation.h"
#include "gpu/transfer.h"

namespace skitter::test {
namespace {

using QuickSolveTest = GpuTest;

// The share of legs that are solved at once while a crowd walks.
double solvedAtOnce(Device& device, Scene scene) {
  constexpr int ticks = 60;
  Crowd crowd(device, rollingGround(), std::move(scene));
  simulate(device, crowd, 60);
  const crowd::Kind& kind = implOf(crowd).kindOf(0);
  double listed = 0;
  for (int tick = 0; tick < ticks; ++tick) {
    simulate(device, crowd, 1);
    for (const crowd::Page& page : kind.pages)
      listed += gpu::download<uint32_t>(device.context(), page.counters)[shared::COUNTER_IK_LISTED];
  }
  return 1 - listed / (static_cast<double>(kind.agents) * kind.legs * ticks);
}

TEST_F(QuickSolveTest, SolvesAlmostEveryLeg) {
  for (const Controller controller : {Controller::adaptive, Controller::planted, Controller::loop}) {
    SCOPED_TRACE(testNameOf(controller));
    EXPECT_GT(solvedAtOnce(device(), sceneOf(64, 1, 3, controller)), 0.999);
    // In a run some legs are stretched to their limits.
    EXPECT_GT(solvedAtOnce(device(), sceneOf(64, 2, 3, controller)), 0.95);
  }
}

}  // namespace
}  // namespace skitter::test
