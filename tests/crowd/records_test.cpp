// The layouts that GLSL and C++ share, as the compiled shaders really have them.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstring>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "crowd/herd.h"
#include "crowd/stage.h"
#include "shared/bindings.h"
#include "shared/parameters.h"
#include "shared/records.h"

namespace skitter::test {
namespace {

// SPIR-V opcodes and decorations (SPIR-V specification 1.6, sections 3.52 and 3.20).
constexpr uint32_t kOpName = 5, kOpMemberName = 6, kOpDecorate = 71, kOpMemberDecorate = 72;
constexpr uint32_t kArrayStride = 6, kOffset = 35;

struct Layout {
  std::map<std::string, std::map<std::string, uint32_t>> offsets;  // struct -> member -> bytes
  std::vector<uint32_t> arrayStrides;
};

Layout layoutOf(std::span<const uint8_t> spirv) {
  std::vector<uint32_t> words(spirv.size() / 4);
  std::memcpy(words.data(), spirv.data(), words.size() * 4);
  const auto text = [&](size_t at) { return std::string(reinterpret_cast<const char*>(&words[at])); };
  std::map<uint32_t, std::string> names;
  std::map<uint32_t, std::map<uint32_t, std::string>> members;
  std::map<uint32_t, std::map<uint32_t, uint32_t>> offsets;
  Layout layout;
  for (size_t at = 5; at < words.size(); at += words[at] >> 16) {
    const uint32_t op = words[at] & 0xffff;
    if (op == kOpName) names[words[at + 1]] = text(at + 2);
    if (op == kOpMemberName) members[words[at + 1]][words[at + 2]] = text(at + 3);
    if (op == kOpMemberDecorate && words[at + 3] == kOffset)
      offsets[words[at + 1]][words[at + 2]] = words[at + 4];
    if (op == kOpDecorate && words[at + 2] == kArrayStride) layout.arrayStrides.push_back(words[at + 3]);
  }
  for (const auto& [id, list] : offsets)
    for (const auto& [member, offset] : list) layout.offsets[names[id]][members[id][member]] = offset;
  return layout;
}

const std::map<std::string, size_t>& parameterOffsets() {
  static const std::map<std::string, size_t> offsets = {
#include "parameter_offsets.inc"
  };
  return offsets;
}

std::vector<crowd::Stage> everyStage() {
  return {crowd::navigateStage(),
          crowd::bodyStage(),
          crowd::gaitStage(),
          crowd::bodyAndGaitStage(),
          crowd::navigateBodyAndGaitStage(),
          crowd::footholdStage(),
          crowd::swingStage(),
          crowd::swingAndIkStage(),
          crowd::ikStage(),
          crowd::poseStage(),
          crowd::measureStage(),
          crowd::blindBodyStage(),
          crowd::loopGaitStage(),
          crowd::loopSwingStage(),
          crowd::clipStage(),
          crowd::clipSwingStage(),
          crowd::clipPoseStage(),
          crowd::plantedSwingStage(),
          crowd::plantedIkStage(),
          crowd::plantedPoseStage(),
          crowd::footfallStage(),
          crowd::keyPoseGaitStage(),
          crowd::keyPoseSwingStage()};
}

TEST(Records, ParametersLieWhereBothSidesThink) {
  ASSERT_EQ(parameterOffsets().size() * sizeof(float), sizeof(shared::Parameters));
  for (const crowd::Stage& stage : everyStage())
    for (const auto code : {stage.code.texel, stage.code.storage}) {
      const Layout layout = layoutOf(code);
      ASSERT_TRUE(layout.offsets.contains("Parameters")) << stage.name;
      const auto& offsets = layout.offsets.at("Parameters");
      ASSERT_EQ(offsets.size(), parameterOffsets().size()) << stage.name;
      for (const auto& [member, offset] : parameterOffsets())
        EXPECT_EQ(offsets.at(member), offset) << stage.name << ": " << member;
    }
}

TEST(Records, PushConstantsAndStrides) {
  for (const crowd::Stage& stage : everyStage()) {
    const Layout layout = layoutOf(stage.code.storage);
    const auto& constants = layout.offsets.at("TickConstants");
    EXPECT_EQ(constants.at("count"), offsetof(shared::TickConstants, count)) << stage.name;
    EXPECT_EQ(constants.at("tick"), offsetof(shared::TickConstants, tick)) << stage.name;
    EXPECT_EQ(constants.at("first"), offsetof(shared::TickConstants, first)) << stage.name;
    EXPECT_EQ(constants.at("every"), offsetof(shared::TickConstants, every)) << stage.name;
    EXPECT_EQ(constants.at("watched"), offsetof(shared::TickConstants, watched)) << stage.name;
    EXPECT_EQ(constants.at("room"), offsetof(shared::TickConstants, room)) << stage.name;
    const bool pairs = crowd::makes(stage.name, "ik");  // miss records
    for (const uint32_t stride : layout.arrayStrides)
      EXPECT_TRUE(stride == 16 || stride == 4 || (pairs && stride == 8)) << stage.name << ": " << stride;
  }
}

TEST(Records, BlocksHoldEveryLegOnce) {
  for (const int legs : {1, 2, 6, 8}) {
    std::set<int> seen;
    for (int agent = 0; agent < 3 * shared::BLOCK; ++agent)
      for (int leg = 0; leg < legs; ++leg) {
        const int record = shared::legRecord(agent, leg, legs);
        EXPECT_EQ(shared::agentOfRecord(record, legs), agent) << record;
        EXPECT_EQ(shared::legOfRecord(record, legs), leg) << record;
        seen.insert(record);
      }
    EXPECT_EQ(seen.size(), static_cast<size_t>(3 * shared::BLOCK * legs));
    EXPECT_EQ(*seen.rbegin(), 3 * shared::BLOCK * legs - 1);
  }
}

}  // namespace
}  // namespace skitter::test
