// Every check is seen to fail: per stage, one small error in its shader (tests/crowd/CMakeLists.txt says
// which), and lock-step replay must refuse that stage and no other.
#include "crowd/simulation.h"
#include "embedded/broken_body_comp_storage.h"
#include "embedded/broken_body_comp_texel.h"
#include "embedded/broken_foothold_comp_storage.h"
#include "embedded/broken_foothold_comp_texel.h"
#include "embedded/broken_gait_comp_storage.h"
#include "embedded/broken_gait_comp_texel.h"
#include "embedded/broken_ik_comp_storage.h"
#include "embedded/broken_ik_comp_texel.h"
#include "embedded/broken_measure_comp_storage.h"
#include "embedded/broken_measure_comp_texel.h"
#include "embedded/broken_navigate_comp_storage.h"
#include "embedded/broken_navigate_comp_texel.h"
#include "embedded/broken_pose_comp_storage.h"
#include "embedded/broken_pose_comp_texel.h"
#include "embedded/broken_swing_comp_storage.h"
#include "embedded/broken_swing_comp_texel.h"

namespace skitter::test {
namespace {

StageShader broken(const std::string& stage) {
  using namespace embedded;
  if (stage == "navigate") return {stage, broken_navigate_comp_texel(), broken_navigate_comp_storage()};
  if (stage == "body") return {stage, broken_body_comp_texel(), broken_body_comp_storage()};
  if (stage == "gait") return {stage, broken_gait_comp_texel(), broken_gait_comp_storage()};
  if (stage == "foothold") return {stage, broken_foothold_comp_texel(), broken_foothold_comp_storage()};
  if (stage == "swing") return {stage, broken_swing_comp_texel(), broken_swing_comp_storage()};
  if (stage == "ik") return {stage, broken_ik_comp_texel(), broken_ik_comp_storage()};
  if (stage == "pose") return {stage, broken_pose_comp_texel(), broken_pose_comp_storage()};
  return {stage, broken_measure_comp_texel(), broken_measure_comp_storage()};
}

class MutantTest : public GpuTest, public ::testing::WithParamInterface<const char*> {};

TEST_P(MutantTest, IsRefused) {
  const Heightfield ground = rollingGround();
  Crowd crowd(device(), ground, sceneOf(64), {.shaders = {broken(GetParam())}});
  for (const validation::StageResult& stage : replay(device(), crowd, ground, 60))
    EXPECT_EQ(stage.pass, stage.name != GetParam()) << stage.name << ": " << stage.worst;
}

INSTANTIATE_TEST_SUITE_P(, MutantTest,
                         ::testing::Values("navigate", "body", "gait", "foothold", "swing", "ik", "pose",
                                           "measure"),
                         [](const auto& param) { return std::string(param.param); });

}  // namespace
}  // namespace skitter::test
