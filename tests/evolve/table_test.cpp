// Tables of gaits: what is read and refused, and what becomes of it in a crowd.
#include <gmock/gmock.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>

#include "crowd/herd.h"
#include "crowd/regait.h"
#include "crowd/simulation.h"
#include "crowd/symmetry.h"
#include "skitter/error.h"
#include "skitter/rig_gaits.h"
#include "support/gpu_fixture.h"

namespace skitter::test {
namespace {

using TableTest = GpuTest;
using crowd::Regait, crowd::regaitByRule, crowd::regaitFor;

size_t legCalled(const Rig& rig, const std::string& name) {
  return static_cast<size_t>(std::ranges::find(rig.legs, name, &Leg::name) - rig.legs.begin());
}

// Without L2: seven legs one after the other, in the order of the rig.
RigGait gaitWithoutL2(const Rig& rig) {
  const size_t idle = legCalled(rig, "L2");
  RigGait gait{.idle = 1u << idle,
               .groups = 3,
               .adjacent = true,
               .shift = {0.05f, 0.02f, -0.1f},
               .speed = 0.75f,
               .fitness = 0.5f,
               .turns = std::vector<RigGait::Turn>(8)};
  for (size_t leg = 0, turn = 0; leg < 8; ++leg)
    if (leg != idle) gait.turns[leg] = {static_cast<float>(turn++) / 8, 1 + 0.01f * static_cast<float>(leg)};
  return gait;
}

Rig spiderWithTable() {
  Rig rig = spiderRig();
  rig.gaits = {gaitWithoutL2(rig)};
  return rig;
}

std::string refusal(const std::string& json, const Rig& rig) {
  try {
    parseGaits(json, "spider.gaits.json", rig);
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing";
}

TEST(RigGaits, WhatIsWrittenIsReadBack) {
  const Rig rig = spiderWithTable();
  const std::string text = writeGaits(rig, rig.gaits, R"({"evaluations": 3})");
  EXPECT_THAT(text, testing::HasSubstr(R"("found": {"evaluations":3})"));
  EXPECT_EQ(parseGaits(text, "table", rig), rig.gaits);
  EXPECT_TRUE(parseGaits(writeGaits(rig, {}), "table", rig).empty());
}

TEST(RigGaits, ABrokenTableIsRefusedByItsKey) {
  const Rig rig = spiderWithTable();
  const std::string text = writeGaits(rig, rig.gaits);
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string changed = text;
    const size_t at = changed.find(from);
    if (at == std::string::npos) return "not found: " + from;
    changed.replace(at, from.size(), to);
    return refusal(changed, rig);
  };
  const std::string name = "spider.gaits.json: ";
  EXPECT_EQ(with("\"version\": 1", "\"version\": 3"), name + "version is 3, expected 1");
  EXPECT_THAT(with("\"version\": 1,", ""), name + "version is missing");
  EXPECT_THAT(with("\"groups\"", "\"grups\""),
              testing::HasSubstr("gaits[0].grups is no known key; did you mean groups?"));
  EXPECT_THAT(with("\"groups\":3", "\"groups\":0"), name + "gaits[0].groups is 0, expected 1 to 24");
  EXPECT_THAT(with("\"groups\":3", "\"groups\":2.5"), testing::HasSubstr("gaits[0].groups is 2.5, expected"));
  EXPECT_THAT(with("adjacent", "nobody"), testing::HasSubstr("gaits[0].wait is"));
  EXPECT_THAT(with("[0.05,", "[5,"), name + "gaits[0].shift[0] is 5, expected -0.75 to 0.75");
  EXPECT_THAT(with("\"speed\":0.75", "\"speed\":0"), testing::HasSubstr("gaits[0].speed is 0, expected"));
  EXPECT_THAT(with("[\"L2\"]", "[\"L9\"]"), testing::HasSubstr("gaits[0].without[0] is"));
  EXPECT_THAT(with("[\"L2\"]", "[]"), testing::HasSubstr("gaits[0].without is"));
  EXPECT_THAT(with("[\"L2\"]", "[\"L2\",\"L2\"]"), testing::HasSubstr("expected no leg twice"));
  EXPECT_THAT(with("[\"L2\"]", "[\"L1\"]"), testing::HasSubstr("gaits[0].turns.L1 is"));
  EXPECT_THAT(with("\"L1\":[0.0,", "\"L1\":[1.0,"), testing::HasSubstr("gaits[0].turns.L1[0] is"));
  EXPECT_THAT(with("\"legs\": [\"", "\"legs\": [\"X\",\""), testing::HasSubstr("legs is"));
  std::string twice = text;
  const size_t first = text.find("{\"without\""), end = text.rfind("\n]");
  twice.insert(end, ",\n" + text.substr(first, end - first));
  EXPECT_THAT(refusal(twice, rig), testing::HasSubstr("gaits[1].without is"));
  EXPECT_THAT(refusal("[]", rig), name + "the file is an array of 0, expected an object");
}

TEST(RigGaits, LieBesideTheRig) {
  EXPECT_EQ(gaitsOf("a/crab.glb"), std::filesystem::path("a/crab.gaits.json"));
  EXPECT_EQ(gaitsOf("a/crab.rig.json"), std::filesystem::path("a/crab.gaits.json"));
  EXPECT_EQ(gaitsOf("crab.gltf"), std::filesystem::path("crab.gaits.json"));
}

TEST(RigGaits, AreReadWithARigAndNotMissed) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::temp_directory_path() / "skitter_table_test";
  fs::create_directories(folder);
  fs::copy_file(SKITTER_ROOT "/assets/spider.glb", folder / "own.glb", fs::copy_options::overwrite_existing);
  EXPECT_TRUE(loadRig(folder / "own.glb").gaits.empty());
  const Rig rig = spiderWithTable();
  std::ofstream(folder / "own.gaits.json") << writeGaits(rig, rig.gaits);
  EXPECT_EQ(loadRig(folder / "own.glb").gaits, rig.gaits);
  std::ofstream(folder / "own.gaits.json") << "{}";
  EXPECT_THROW(loadRig(folder / "own.glb"), Error);
  fs::remove_all(folder);
}

TEST(RigGaits, AreTakenForTheirPatternAndItsMirrorImageAlone) {
  const Rig rig = spiderWithTable();
  const std::vector<size_t> mirror = crowd::mirroredLegs(rig);
  const RigGait& gait = rig.gaits.front();
  const Regait made = regaitFor(rig, Tuning{}, {.idle = gait.idle});
  EXPECT_EQ(made.groups, 3);
  EXPECT_EQ(made.speed, 0.75f);
  EXPECT_EQ(made.shift, gait.shift * rig.legLength);
  const size_t r2 = legCalled(rig, "R2");
  const Regait image = regaitFor(rig, Tuning{}, {.idle = 1u << r2});
  EXPECT_EQ(image.shift, made.shift * glm::vec3(-1, 1, 1));
  for (size_t leg = 0; leg < 8; ++leg) {
    const crowd::LegTurn &turn = made.legs[leg], &other = image.legs[mirror[leg]];
    if ((gait.idle >> leg & 1u) == 0) {
      EXPECT_FLOAT_EQ(static_cast<float>(turn.group) + turn.within, 3 * gait.turns[leg].phase) << leg;
      EXPECT_EQ(turn.slowness, gait.turns[leg].slowness) << leg;
    }
    EXPECT_EQ(turn.group, other.group) << leg;
    EXPECT_EQ(turn.within, other.within) << leg;
    EXPECT_EQ(crowd::mirrored(turn.neighbours, mirror), other.neighbours) << leg;
  }
  const uint32_t l1 = 1u << legCalled(rig, "L1");
  EXPECT_EQ(regaitFor(rig, Tuning{}, {.idle = l1}).groups, regaitByRule(rig, Tuning{}, {.idle = l1}).groups);
  EXPECT_EQ(regaitFor(rig, Tuning{}, {.idle = l1}).legs.size(), 8u);
  EXPECT_EQ(regaitFor(rig, Tuning{}, {}).speed, 1);
}

TEST(RigGaits, LameLegsAreSlowerByTableToo) {
  const Rig rig = spiderWithTable();
  const uint32_t idle = rig.gaits.front().idle, lame = 1u << legCalled(rig, "R3");
  const Regait whole = regaitFor(rig, Tuning{}, {.idle = idle}),
               made = regaitFor(rig, Tuning{}, {.idle = idle, .lame = lame});
  EXPECT_FLOAT_EQ(made.speed, whole.speed * (1 - 1.0f / 14));
  for (size_t leg = 0; leg < 8; ++leg)
    EXPECT_FLOAT_EQ(made.legs[leg].slowness,
                    whole.legs[leg].slowness * ((lame >> leg & 1u) != 0 ? shared::LAME_SLOWNESS : 1.0f));
}

TEST(RigGaits, OnlyTheNextLegsWaitWhereSoSaid) {
  Rig rig = spiderWithTable();
  const Regait few = regaitFor(rig, Tuning{}, {.idle = rig.gaits.front().idle});
  rig.gaits.front().adjacent = false;
  const Regait all = regaitFor(rig, Tuning{}, {.idle = rig.gaits.front().idle});
  for (size_t leg = 0; leg < 8; ++leg) {
    EXPECT_LE(std::popcount(few.legs[leg].neighbours), 2) << leg;
    EXPECT_EQ(few.legs[leg].neighbours & ~all.legs[leg].neighbours, 0u) << leg;
    for (size_t other = 0; other < 8; ++other)
      EXPECT_EQ(all.legs[leg].neighbours >> other & 1u, all.legs[other].neighbours >> leg & 1u);
  }
  EXPECT_GT(std::popcount(all.legs[legCalled(rig, "L1")].neighbours), 2);
}

TEST_F(TableTest, ATableThatCannotBeIsRefusedBeforeACrowdIsMade) {
  Scene scene = sceneOf(1);
  scene.herds[0].hurt = true;
  const auto expectRefused = [&](const char* words, const std::function<void(RigGait&)>& spoil) {
    CrowdOptions options;
    options.rigs = {spiderWithTable()};
    spoil(options.rigs.front().gaits.front());
    try {
      Crowd(device(), flatGround(), scene, options);
      ADD_FAILURE() << words;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr(words));
    }
  };
  expectRefused("gaits[0] has 7 turns, expected 8", [](RigGait& gait) { gait.turns.pop_back(); });
  expectRefused("gaits[0] has 0 groups", [](RigGait& gait) { gait.groups = 0; });
  expectRefused("gaits[0] is without legs 0x100", [](RigGait& gait) { gait.idle = 256; });
  expectRefused("out of its range", [](RigGait& gait) { gait.turns[0].phase = 1; });
  expectRefused("out of its range", [](RigGait& gait) { gait.shift.y = NAN; });
}

// Lock-step replay with phases that are no whole turns.
TEST_F(TableTest, ACrowdGoesByItsTableAndTheReferenceFollows) {
  Scene scene = sceneOf(12);
  scene.herds[0].hurt = true;
  const Heightfield ground = rollingGround();
  CrowdOptions options{.feet = true};
  options.rigs = {spiderWithTable()};
  Crowd crowd(device(), ground, scene, options);
  simulate(device(), crowd, 20);
  const Rig& rig = crowd.rig(0);
  const auto l2 = static_cast<uint32_t>(legCalled(rig, "L2")),
             r2 = static_cast<uint32_t>(legCalled(rig, "R2"));
  for (uint32_t agent = 0; agent < 12; ++agent) crowd.hurt(crowd.agentId(0, agent), agent % 2 == 0 ? l2 : r2);
  expectAllPass(replay(device(), crowd, ground, 90));
  const HerdState state = crowd.download(0);
  const size_t floats = 4 * static_cast<size_t>(shared::hurtStride(8));
  EXPECT_EQ(state.hurt[3], 3);
  EXPECT_EQ(state.hurt[11], 0.75f);
  EXPECT_EQ(state.hurt[floats + 11], 0.75f);
  bool isBetween = false;
  for (size_t leg = 0; leg < 8; ++leg) {
    const float group = state.hurt[4 * (shared::HURT_LEGS + leg)];
    isBetween = isBetween || group != std::floor(group);
  }
  EXPECT_TRUE(isBetween);
}

}  // namespace
}  // namespace skitter::test
