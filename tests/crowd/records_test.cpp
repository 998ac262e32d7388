// The layouts that GLSL and C++ share, as the compiled shaders really have them.
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <cstring>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "crowd/controllers/controllers.h"
#include "crowd/herd.h"
#include "crowd/record.h"
#include "crowd/stage.h"
#include "shared/bindings.h"
#include "shared/parameters.h"
#include "skitter/records.h"
#include "support/stages_page.h"
#include "validation/replay.h"

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
#define OFFSET(name) {#name, offsetof(shared::Parameters, name)},
      PARAMETERS(OFFSET)
#undef OFFSET
  };
  return offsets;
}

CrowdOptions everything(bool fuse) {
  return {.pose = true, .measure = true, .feet = true, .footfalls = 1, .sleep = true, .fuse = fuse};
}

// The stages of every controller, except wake, which has no parameters.
std::vector<crowd::Stage> everyStage() {
  std::vector<crowd::Stage> stages;
  for (const Controller controller : allControllers) {
    const crowd::ControllerStages& of = crowd::controllerStages(controller);
    for (const crowd::Stage& stage : of.all(everything(false)))
      if (!(stage.makes == crowd::StageId::wake)) stages.push_back(stage);
    if (of.fused != nullptr)
      for (const crowd::Stage& stage : of.fused()) stages.push_back(stage);
  }
  const size_t count = stages.size();
  for (size_t i = 0; i < count; ++i)
    for (const auto& code : {stages[i].hurtCode, stages[i].reactCode})
      if (code) stages.emplace_back(stages[i]).code = *code;
  return stages;
}

std::vector<std::string> namesOf(Controller controller, bool fuse, bool sleep,
                                 const crowd::StageForms& forms = {}) {
  CrowdOptions options = everything(fuse);
  options.sleep = sleep;
  std::vector<std::string> names;
  for (const crowd::Stage& stage : crowd::stagesOf(controller, options, forms))
    names.push_back(stage.makes.name());
  return names;
}

TEST(Stages, AreThoseOfTheirPage) {
  for (const Controller controller : allControllers)
    EXPECT_EQ(namesOf(controller, false, true, {.avoids = true, .reacts = true, .adapts = true}),
              stagesOnThePage({nameOf(controller)}))
        << nameOf(controller);
}

TEST(Stages, AreMadeAtOnceWhereTheyStandInARow) {
  for (const Controller controller : allControllers)
    for (const bool sleep : {false, true})
      for (const bool avoids : {false, true})
        EXPECT_EQ(fmt::format("{}", fmt::join(namesOf(controller, true, sleep, {.avoids = avoids}), "+")),
                  fmt::format("{}", fmt::join(namesOf(controller, false, sleep, {.avoids = avoids}), "+")));
  using testing::IsSupersetOf;
  EXPECT_THAT(namesOf(Controller::adaptive, true, false), IsSupersetOf({"navigate+body+gait", "swing+ik"}));
  // Where agents sleep, wake comes after navigate.
  EXPECT_THAT(namesOf(Controller::adaptive, true, true),
              IsSupersetOf({"navigate", "wake", "body+gait", "swing+ik"}));
  // Or avoid.
  EXPECT_THAT(namesOf(Controller::adaptive, true, false, {.avoids = true}),
              IsSupersetOf({"navigate", "avoid", "body+gait", "swing+ik"}));
  // adapt and react come before body.
  EXPECT_THAT(namesOf(Controller::adaptive, true, false, {.reacts = true, .adapts = true}),
              IsSupersetOf({"navigate", "adapt", "react", "body+gait", "swing+ik"}));
  CrowdOptions options = everything(true);
  options.shaders = {{.stage = "ik", .texel = {}, .storage = {}}};
  EXPECT_THAT(crowd::stagesOf(Controller::adaptive, options),
              testing::Contains(testing::Field(&crowd::Stage::makes, crowd::StageSet(crowd::StageId::ik))));
}

TEST(Records, ReplayHoldsAllThatAStageWrites) {
  for (const Controller controller : allControllers) {
    const std::vector<validation::CheckedStage> checked = validation::checkedStages(controller);
    auto next = checked.begin();
    for (const crowd::Stage& stage :
         crowd::stagesOf(controller, everything(false), {.avoids = true, .reacts = true, .adapts = true})) {
      if (stage.makes == crowd::StageId::wake) continue;
      SCOPED_TRACE(std::string(nameOf(controller)) + ", " + stage.makes.name());
      ASSERT_NE(next, checked.end());
      EXPECT_TRUE(stage.makes == next->stage) << nameOf(next->stage);
      std::set<Record> written;
      for (const gpu::BindingDecl& declared : stage.bindings)
        if (crowd::isWritten(declared.binding)) written.insert(*crowd::recordAt(declared.binding));
      if (stage.isOfTheAwake() || stage.over == crowd::Stage::Over::listed) {
        EXPECT_EQ(std::set(next->writes.begin(), next->writes.end()), written);
      }
      ++next;
    }
    EXPECT_EQ(next, checked.end());
  }
}

TEST(Records, HaveBindingsOfTheirOwn) {
  std::set<uint32_t> taken = {
      shared::BINDING_PARAMETERS, shared::BINDING_HEIGHTS,   shared::BINDING_RIG,
      shared::BINDING_KEY,        shared::BINDING_CLIP,      shared::BINDING_CLIP_FRAME,
      shared::BINDING_CLIP_ROW,   shared::BINDING_CLIP_LEG,  shared::BINDING_CLIP_JOINT,
      shared::BINDING_LIST,       shared::BINDING_COUNTERS,  shared::BINDING_HISTOGRAM,
      shared::BINDING_AWAKE,      shared::BINDING_AWAKE_OUT, shared::BINDING_FOOTFALL_OUT,
      shared::BINDING_CELL,       shared::BINDING_PLACE,     shared::BINDING_WALKER,
      shared::BINDING_CROWDING,   shared::BINDING_WAY,       shared::BINDING_FORAGE_GROUND,
      shared::BINDING_TRAIL};
  for (const Record record : allRecords)
    for (const uint32_t binding : {crowd::infoOf(record).binding, crowd::infoOf(record).binding + 1})
      EXPECT_TRUE(taken.insert(binding).second) << crowd::infoOf(record).name << ": " << binding;
}

TEST(Records, ParametersLieWhereBothSidesThink) {
  ASSERT_EQ(parameterOffsets().size() * sizeof(float), sizeof(shared::Parameters));
  for (const crowd::Stage& stage : everyStage())
    for (const auto code : {stage.code.texel, stage.code.storage}) {
      const Layout layout = layoutOf(code);
      ASSERT_TRUE(layout.offsets.contains("Parameters")) << stage.makes.name();
      const auto& offsets = layout.offsets.at("Parameters");
      ASSERT_EQ(offsets.size(), parameterOffsets().size()) << stage.makes.name();
      for (const auto& [member, offset] : parameterOffsets())
        EXPECT_EQ(offsets.at(member), offset) << stage.makes.name() << ": " << member;
    }
}

TEST(Records, PushConstantsAndStrides) {
  for (const crowd::Stage& stage : everyStage()) {
    const Layout layout = layoutOf(stage.code.storage);
    const auto& constants = layout.offsets.at("TickConstants");
    EXPECT_EQ(constants.at("count"), offsetof(shared::TickConstants, count)) << stage.makes.name();
    EXPECT_EQ(constants.at("tick"), offsetof(shared::TickConstants, tick)) << stage.makes.name();
    EXPECT_EQ(constants.at("first"), offsetof(shared::TickConstants, first)) << stage.makes.name();
    EXPECT_EQ(constants.at("every"), offsetof(shared::TickConstants, every)) << stage.makes.name();
    EXPECT_EQ(constants.at("watched"), offsetof(shared::TickConstants, watched)) << stage.makes.name();
    EXPECT_EQ(constants.at("room"), offsetof(shared::TickConstants, room)) << stage.makes.name();
    const bool pairs = stage.makes.has(crowd::StageId::ik);  // miss records
    for (const uint32_t stride : layout.arrayStrides)
      EXPECT_TRUE(stride == 16 || stride == 4 || (pairs && stride == 8))
          << stage.makes.name() << ": " << stride;
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
