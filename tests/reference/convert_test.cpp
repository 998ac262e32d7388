#include "validation/convert.h"

#include <gtest/gtest.h>

#include "reference_herd.h"
#include "skitter/records.h"

namespace skitter::test {
namespace {

using namespace validation;

// Whatever a stage reads must be what another one wrote: reading and writing back changes no bit.
TEST(Convert, recordsSurviveReadingAndWriting) {
  ReferenceHerd herd(roughField(), 3, 1);
  for (int i = 0; i < 40; ++i) herd.tick();
  const HerdState& state = herd.state();
  HerdState copy = state;
  for (auto* buffer : {&copy.goal, &copy.steer, &copy.body, &copy.gait, &copy.step, &copy.arc, &copy.foot,
                       &copy.chain, &copy.tip, &copy.miss, &copy.pose, &copy.metric, &copy.watch}) {
    std::fill(buffer->begin(), buffer->end(), 0.0f);
  }
  const size_t bones = static_cast<size_t>(herd.bones());
  for (size_t agent = 0; agent < 3; ++agent) {
    putGoal(copy, agent, goalOf(state, agent));
    putSteer(copy, agent, desiredOf(state, agent), asleepOf(state, agent));
    putBody(copy, agent, bodyOf(state, agent));
    putGait(copy, agent, gaitOf(state, agent));
    putMetric(copy, agent, metricOf(state, agent));
    putWatched(copy, agent, watchedOf(state, agent, 8));
    for (size_t leg = 8 * agent; leg < 8 * agent + 8; ++leg) {
      putStep(copy, leg, stepOf(state, leg));
      putFoot(copy, leg, footOf(state, leg));
      putChain(copy, leg, herd.bones(), chainOf(state, leg, herd.bones()));
      putMiss(copy, agent, leg % 8, 8, herd.ticks(), missOf(state, agent, leg % 8, 8, herd.ticks()));
    }
    for (size_t i = 0; i < 1 + 8 * bones; ++i) {
      putBone(copy, agent * (1 + 8 * bones) + i, boneOf(state, agent * (1 + 8 * bones) + i));
    }
  }
  EXPECT_EQ(copy.goal, state.goal);
  EXPECT_EQ(copy.steer, state.steer);
  EXPECT_EQ(copy.body, state.body);
  EXPECT_EQ(copy.gait, state.gait);
  EXPECT_EQ(copy.step, state.step);
  EXPECT_EQ(copy.arc, state.arc);
  EXPECT_EQ(copy.foot, state.foot);
  EXPECT_EQ(copy.chain, state.chain);
  EXPECT_EQ(copy.tip, state.tip);
  EXPECT_EQ(copy.miss, state.miss);
  EXPECT_EQ(copy.pose, state.pose);
  EXPECT_EQ(copy.metric, state.metric);
  EXPECT_EQ(copy.watch, state.watch);
}

// As far as a body may go, and as long as a step may last.
TEST(Convert, stepsKnowTheirTilesFromTheBodys) {
  ReferenceHerd herd(flatField(), 1);
  HerdState state = herd.state();
  const double longest = shared::MOST_STEP_TICKS - 1, furthest = shared::STEP_TILES / 2 - 1;
  for (const double tile : {-2048.0, -33.0, -32.0, -1.0, 0.0, 31.0, 2047.0})
    for (const double apart : {-furthest, -1.0, 0.0, 1.0, furthest})
      for (const double ticks : {1.0, -1.0, 17.0, longest, -longest}) {
        reference::AgentBody body = bodyOf(state, 0);
        body.tileX = tile, body.tileZ = -tile - 1;
        putBody(state, 0, body);
        reference::Step step = stepOf(state, 3);
        step.tileX = body.tileX + apart, step.tileZ = body.tileZ - apart, step.duration = ticks;
        putStep(state, 3, step);
        const reference::Step got = stepOf(state, 3);
        EXPECT_EQ(got.tileX, step.tileX) << tile << " " << apart << " " << ticks;
        EXPECT_EQ(got.tileZ, step.tileZ) << tile << " " << apart << " " << ticks;
        EXPECT_EQ(got.duration, step.duration) << tile << " " << apart << " " << ticks;
      }
}

TEST(Convert, boneFramesAreRightHandedAndOrthonormal) {
  for (const reference::Limb& limb : spiderCreature().limbs) {
    double length = 0;
    for (const reference::BoneRest& bone : limb.bones) {
      EXPECT_NEAR(glm::determinant(bone.frame), 1, 1e-6);
      EXPECT_NEAR(glm::dot(bone.frame[0], bone.frame[2]), 0, 1e-6);
      length += bone.length;
    }
    EXPECT_NEAR(length, 1, 1e-6);
  }
}

}  // namespace
}  // namespace skitter::test
