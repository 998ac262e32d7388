#include "validation/convert.h"
#include "validation/solve.h"

#include <gtest/gtest.h>

// A leg of a fox as it was met: its tip is at its target but for rounding, and solver `transpose` takes a
// last step that divides by next to nothing. Of 4,096 erring solves half end within 3.5e-6 of the reach of
// the exact pose, one in a thousand beyond 4.5e-4.
namespace skitter::test {
namespace {

using glm::dmat3;
using glm::dvec2;
using glm::dvec3;

constexpr int kBones = 3;

reference::BoneRest bone(double length, double tan, double stiffness, const dmat3& frame) {
  reference::BoneRest rest;
  rest.length = length;
  rest.tanHalfCone = tan;
  rest.stiffness = stiffness;
  rest.frame = frame;
  return rest;
}

class IkTailTest : public testing::Test {
 protected:
  IkTailTest() {
    limb_.reach = 1.78;
    limb_.bones = {bone(0.359697908, 0.577350318, 0.2,
                        {1, 4.82984603e-07, -5.49307174e-07, 4.8298459e-07, 0.127967611, 0.991778374,
                         5.49307174e-07, -0.991778374, 0.127967611}),
                   bone(0.340684593, 1.7320509, 1,
                        {1, 1.95289175e-07, -6.22334312e-07, 6.18852647e-07, -0.585493863, 0.810676873,
                         -2.06056498e-07, -0.810676873, -0.585493863}),
                   bone(0.299617559, 1.7320509, 1,
                        {1, 0.000156873022, 2.30326659e-05, -7.20301952e-05, 0.320062217, 0.947396539,
                         0.000141249067, -0.947396517, 0.32006222})};
    setting_.legs = 1;
    setting_.bones = kBones;
    setting_.creature.limbs = {limb_};
    setting_.ik = {reference::IkSolver::transpose, 4, 0};
    setting_.tuning.approachError = 2e-5;
    previous_.directions = {
        {-0.0936649665, -0.525401115}, {0.000837967033, 0.383247763}, {0.00086944754, -0.510779619}};
    foot_.target = limb_.reach * dvec3(-0.14521917645587148, -0.64775435566683948, -0.74822121158095534);
    foot_.progress = 1;
    for (HerdState* state : {&before_, &after_}) {
      state->agents = 1;
      state->body.resize(4 * shared::BODY_STRIDE);
      state->step.resize(4 * shared::STEP_STRIDE);
      state->foot.resize(4 * shared::FOOT_STRIDE);
      state->chain.resize(4 * static_cast<size_t>(shared::chainStride(kBones)));
      reference::AgentBody body;
      body.orientation = glm::dquat(1, 0, 0, 0);
      validation::putBody(*state, 0, body);
      validation::putFoot(*state, 0, foot_);
    }
    validation::putChain(before_, 0, kBones, previous_);
  }

  reference::Chain solved(reference::Arithmetic arithmetic = {}) const {
    return reference::ik(setting_.tuning, limb_, validation::bodyOf(after_, 0), validation::footOf(after_, 0),
                         validation::chainOf(before_, 0, kBones), setting_.ik, arithmetic);
  }

  validation::SolveVerdict judged(const reference::Chain& got, bool tails) {
    validation::putChain(after_, 0, kBones, got);
    const validation::Surroundings around;
    return compareSolve(setting_, {1, before_, after_, 0, around}, 0, limb_,
                        validation::chainOf(before_, 0, kBones), tails);
  }

  reference::Limb limb_;
  validation::Setting setting_;
  reference::Chain previous_;
  reference::Foot foot_;
  HerdState before_, after_;
};

TEST_F(IkTailTest, TheExactPosePasses) {
  const validation::SolveVerdict verdict = judged(solved(), false);
  EXPECT_TRUE(verdict.sample.passes());
  EXPECT_FALSE(verdict.tie);
}

// What a device made of it.
TEST_F(IkTailTest, ARareErrorPassesAsATieWhereTailsAreLookedAt) {
  const reference::Chain got = {
      {{-0.0943732411, -0.525862336}, {0.00038820217, 0.383622199}, {0.0006074587, -0.510761619}}};
  EXPECT_FALSE(judged(got, false).sample.passes());
  const validation::SolveVerdict verdict = judged(got, true);
  EXPECT_TRUE(verdict.sample.passes());
  EXPECT_TRUE(verdict.tie);
}

// A fifth of a radian is more than any of the erring solves shows.
TEST_F(IkTailTest, APoseThatRoundingDoesNotExplainIsRefused) {
  reference::Chain got = solved();
  got.directions[1].x += 0.1;
  EXPECT_FALSE(judged(got, true).sample.passes());
}

}  // namespace
}  // namespace skitter::test
