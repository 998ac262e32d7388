// Every record of a sleeper stays as it is, to the bit, and whoever changes it is named.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "crowd/controller.h"
#include "crowd/record.h"
#include "reference_herd.h"
#include "skitter/records.h"
#include "validation/convert.h"

namespace skitter::test {
namespace {

using validation::Replay;
using validation::StageResult;

// A record that a herd has between navigate and measure, and who writes it.
struct KeptRecord {
  Controller controller;
  crowd::StageId stage;
  Record record;

  size_t legs() const { return crowd::infoOf(record).per == crowd::Per::leg ? 8 : 1; }
  std::string name() const {
    std::string name = std::string(nameOf(controller)) + "_" + crowd::infoOf(record).name;
    std::ranges::replace(name, '-', '_');
    return name;
  }
};
void PrintTo(const KeptRecord& kept, std::ostream* out) { *out << kept.name(); }

std::vector<KeptRecord> keptRecords(std::span<const Controller> controllers) {
  std::vector<KeptRecord> kept;
  for (const Controller controller : controllers)
    for (const validation::CheckedStage& stage : validation::checkedStages(controller))
      for (const Record record : stage.writes) kept.push_back({controller, stage.stage, record});
  return kept;
}

class SleepersRecord : public testing::TestWithParam<KeptRecord> {
 protected:
  // Two agents of made-up records, unlike anything that the stages compute, but asleep.
  static constexpr size_t agents = 2, legs = 8, bones = 4;
  HerdState asleep() const {
    const Controller controller = GetParam().controller;
    HerdState state;
    state.agents = agents;
    state.sleep = true;
    const auto fill = [&](Record record) {
      const size_t count = crowd::infoOf(record).per == crowd::Per::leg ? legs : 1;
      const int joints = crowd::traitsOf(controller).playsClips ? 1 : 0;
      const auto stride = static_cast<size_t>(crowd::strideOf(record, legs, bones, joints));
      std::vector<float>& records = state.of(record);
      records.resize(4 * agents * count * stride);
      for (size_t i = 0; i < records.size(); ++i) records[i] = 0.001f * static_cast<float>(i % 977);
    };
    for (const Record record : allRecords)
      if (crowd::infoOf(record).kept == crowd::Kept::always) fill(record);
    for (const KeptRecord& kept : keptRecords({{controller}})) fill(kept.record);
    if (!state.hurt.empty()) fill(Record::carried);  // a herd that can be hurt has both
    for (size_t agent = 0; agent < agents; ++agent) {
      validation::putGoal(state, agent, {});
      validation::putSteer(state, agent, {0, 0}, true);
      state.body[16 * agent + 13] = 5;
      validation::putGait(state, agent, {.cycle = 1.2});
    }
    return state;
  }
  Replay judge() const {
    const ReferenceHerd herd(flatField(), 1);
    validation::HerdFacts facts = herd.facts();
    facts.controller = GetParam().controller;
    facts.clips.joints = 1;
    facts.clips.bones = {-1, 0, 0, 0};
    facts.clips.legs.resize(4 * legs * (bones + 1));
    facts.keyPoses.records.resize(4 * legs * static_cast<size_t>(shared::keyStride(bones, 0)));
    return Replay(facts);
  }
};

TEST_P(SleepersRecord, staysAndIsNoSample) {
  Replay replay = judge();
  replay.tick(9, asleep(), asleep());
  for (const StageResult& result : replay.results()) {
    EXPECT_TRUE(result.pass) << result.name << ": " << result.why;
    EXPECT_EQ(result.samples, result.name == "navigate" ? agents : 0) << result.name;
  }
}

TEST_P(SleepersRecord, mustBeWhatItWasToTheBit) {
  HerdState before = asleep(), after = asleep();
  // The last float of the second agent's or, of those of legs, of its last leg but one's.
  const size_t legsHere = GetParam().legs(), leg = legsHere > 1 ? legsHere - 2 : 0;
  const size_t each = before.of(GetParam().record).size() / agents / legsHere;
  float& was = before.of(GetParam().record)[(legsHere + leg + 1) * each - 1];
  float& is = after.of(GetParam().record)[(legsHere + leg + 1) * each - 1];
  const std::string place =
      "of a sleeper: tick 9, agent 1, leg " + std::to_string(legsHere > 1 ? static_cast<int>(leg) : -1) + ",";
  const float some = 0.25f, more = std::nextafter(some, 1.0f);
  for (const auto& [from, to] : {std::pair(some, more), {more, some}, {some, NAN}, {0.0f, -0.0f}}) {
    was = from, is = to;
    Replay replay = judge();
    replay.tick(9, before, after);
    for (const StageResult& result : replay.results()) {
      const bool writer = result.name == nameOf(GetParam().stage);
      EXPECT_EQ(result.pass, !writer) << result.name << ": " << result.worst;
      EXPECT_EQ(result.worst.find(place) != std::string::npos, writer) << result.worst;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(everyRecord, SleepersRecord, testing::ValuesIn(keptRecords(allControllers)),
                         [](const auto& param) { return param.param.name(); });

}  // namespace
}  // namespace skitter::test
