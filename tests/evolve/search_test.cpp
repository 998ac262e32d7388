// The search for gaits: its parts without a device, then a small one as a whole.
#include <gmock/gmock.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <nlohmann/json.hpp>

#include "crowd/symmetry.h"
#include "evolve/archive.h"
#include "evolve/genes.h"
#include "evolve/map_file.h"
#include "evolve/patterns.h"
#include "skitter/error.h"
#include "skitter/evolve.h"
#include "skitter/rig_gaits.h"
#include "support/gpu_fixture.h"

namespace skitter::test {
namespace {

using namespace evolve;
using EvolutionTest = GpuTest;

Rig manyLegged(size_t legs) {
  Rig rig = spiderRig();
  while (rig.legs.size() < legs) {
    Leg leg = rig.legs[rig.legs.size() - 8];
    leg.home.z -= 2 * rig.legLength;
    for (Bone& bone : leg.bones) bone.start.z -= 2 * rig.legLength;
    rig.legs.push_back(leg);
  }
  rig.legs.resize(legs);
  return rig;
}

std::string faultOf(const auto& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing";
}

TEST(Patterns, ASpiderHasThemAllButForItsMirrorImages) {
  const Rig rig = spiderRig();
  const std::vector<size_t> mirror = crowd::mirroredLegs(rig);
  ASSERT_EQ(mirror.size(), 8u);
  for (size_t leg = 0; leg < 8; ++leg) {
    EXPECT_NE(mirror[leg], leg);
    EXPECT_EQ(mirror[mirror[leg]], leg);
    EXPECT_EQ(rig.legs[mirror[leg]].name.substr(1), rig.legs[leg].name.substr(1));
  }
  const std::vector<uint32_t> patterns = patternsOf(rig);
  EXPECT_EQ(patterns.size(), 114u);
  EXPECT_TRUE(std::ranges::is_sorted(patterns));
  std::vector<bool> has(256);
  for (const uint32_t idle : patterns) has[idle] = has[crowd::mirrored(idle, mirror)] = true;
  for (uint32_t idle = 0; idle < 256; ++idle)
    EXPECT_EQ(has[idle], idle > 0 && std::popcount(idle) <= 5) << idle;
}

TEST(Patterns, ARigThatIsNoMirrorImageHasEachByItself) {
  Rig rig = spiderRig();
  rig.legs[2].home.x += 0.01f * rig.legLength;
  EXPECT_TRUE(crowd::mirroredLegs(rig).empty());
  EXPECT_EQ(patternsOf(rig).size(), 218u);
}

TEST(Patterns, OfManyLegsAtMostTwoAreIdle) {
  const Rig rig = manyLegged(24);
  EXPECT_EQ(crowd::mirroredLegs(rig).size(), 24u);
  for (const uint32_t idle : patternsOf(rig)) EXPECT_LE(std::popcount(idle), 2);
  // 24 single legs and 276 pairs, of which 12 are their own images.
  EXPECT_EQ(patternsOf(rig).size(), 12u + 12u + (276u - 12u) / 2u);
  EXPECT_TRUE(patternsOf(manyLegged(8)).size() == 114u);
}

Elite eliteOf(uint64_t candidate, float fitness) {
  return {.candidate = candidate, .fitness = fitness, .genes = {1, 2}, .shares = {0.5f}};
}

TEST(Archive, ACellKeepsItsFittest) {
  Archive archive(3);
  EXPECT_EQ(archive.cellCount(), 3u * Archive::cellsOfPattern);
  EXPECT_FALSE(archive.offer(1, 7, eliteOf(0, 0)));
  EXPECT_TRUE(archive.offer(1, 7, eliteOf(1, 0.5f)));
  EXPECT_FALSE(archive.offer(1, 7, eliteOf(2, 0.5f)));
  EXPECT_FALSE(archive.offer(1, 7, eliteOf(3, 0.4f)));
  EXPECT_EQ(archive.at(1, 7)->candidate, 1u);
  EXPECT_TRUE(archive.offer(1, 7, eliteOf(4, 0.6f)));
  EXPECT_TRUE(archive.offer(1, 3, eliteOf(5, 0.6f)));
  EXPECT_TRUE(archive.offer(2, 7, eliteOf(6, 0.1f)));
  EXPECT_FALSE(archive.offer(2, 7, eliteOf(7, NAN)));
  EXPECT_EQ(archive.filledCount(), 3u);
  ASSERT_EQ(archive.elitesOf(1).size(), 2u);
  EXPECT_EQ(archive.elitesOf(1)[0]->candidate, 5u);  // by cell
  EXPECT_EQ(archive.bestOf(1)->candidate, 4u);       // the first of equal ones
  EXPECT_EQ(archive.bestOf(0), nullptr);
}

TEST(Archive, ABehaviourIsHowLongFrontAndRearLegsStand) {
  const Rig rig = spiderRig();
  const auto cell = [&](float front, float rear, uint32_t idle) {
    std::vector<float> shares;
    for (const Leg& leg : rig.legs) shares.push_back(leg.name[1] <= '2' ? front : rear);
    for (size_t leg = 0; leg < 8; ++leg)
      if ((idle >> leg & 1u) != 0) shares[leg] = 0;
    return cellOf(rig, idle, shares);
  };
  EXPECT_EQ(cell(0.41f, 0.41f, 0), 0u);
  EXPECT_EQ(cell(0, 0, 0), 0u);
  EXPECT_EQ(cell(1, 1, 0), Archive::cellsOfPattern - 1);
  EXPECT_EQ(cell(0.41f, 0.48f, 0), 1u);
  EXPECT_EQ(cell(0.48f, 0.41f, 0), Archive::steps);
  EXPECT_EQ(cell(0.48f, 0.41f, 1), Archive::steps);  // an idle leg does not count
  // Front and rear are about the middle of the legs, wherever the body has its origin.
  Rig ahead = rig;
  for (Leg& leg : ahead.legs) leg.home.z += 2 * rig.legLength;
  std::vector<float> shares;
  for (const Leg& leg : rig.legs) shares.push_back(leg.name[1] <= '2' ? 0.48f : 0.41f);
  EXPECT_EQ(cellOf(ahead, 0, shares), Archive::steps);
}

TEST(Genes, EveryGeneMakesAGaitThatATableMayHave) {
  const Rig rig = spiderRig();
  const GeneSpace space(rig, Tuning{}, Evolution::wantedSpeed);
  base::SplitMix64 random(3);
  std::vector<RigGait> gaits;
  Genes genes = space.drawn(random), other = space.drawn(random);
  for (const uint32_t idle : patternsOf(rig)) {
    genes = space.varied(genes, other, random);
    ASSERT_EQ(genes.size(), space.count());
    gaits.push_back(space.decode(genes, idle));
    EXPECT_LE(gaits.back().groups, 5u);
    EXPECT_LE(gaits.back().groups, static_cast<uint32_t>(8 - std::popcount(idle)));
    EXPECT_GE(gaits.back().groups, 2u);
    std::swap(genes, other);
  }
  for (const uint16_t all : {uint16_t{0}, uint16_t{65535}})
    gaits[all % 2] = space.decode(Genes(space.count(), all), gaits[all % 2].idle);
  EXPECT_EQ(parseGaits(writeGaits(rig, gaits, R"({"by": "a test"})"), "table", rig), gaits);
}

// Phases go round; all else ends where its range does. One gene in sixteen is drawn anew.
TEST(Genes, OnlyPhasesGoRound) {
  const GeneSpace space(spiderRig(), Tuning{}, Evolution::wantedSpeed);
  const Genes least(space.count(), 0);
  base::SplitMix64 random(5);
  std::vector<int> high(space.count());
  constexpr int children = 2000;
  for (int n = 0; n < children; ++n) {
    const Genes child = space.varied(least, least, random);
    for (size_t gene = 0; gene < child.size(); ++gene) high[gene] += child[gene] > 32767;
  }
  constexpr size_t firstPhase = 7, legs = 8;
  for (size_t gene = 0; gene < high.size(); ++gene) {
    const double share = high[gene] / double{children};
    if (gene >= firstPhase && gene < firstPhase + legs)
      EXPECT_NEAR(share, 0.5, 0.1) << gene;
    else
      EXPECT_NEAR(share, 1.0 / 32, 0.02) << gene;
  }
}

TEST(Genes, ACycleIsNoLongerThanATrialHasRoomFor) {
  const Rig rig = spiderRig();
  const Tuning tuning;
  const GeneSpace space(rig, tuning, Evolution::wantedSpeed);
  base::SplitMix64 random(4);
  for (int i = 0; i < 200; ++i) {
    const RigGait gait = space.decode(space.drawn(random), 1);
    float slowest = 1;
    for (size_t leg = 1; leg < 8; ++leg) slowest = std::max(slowest, gait.turns[leg].slowness);
    const double step = double{tuning.swingStill} /
                        (1 + double{gait.speed} * Evolution::wantedSpeed / double{tuning.swingSpeed});
    if (slowest == 1) continue;
    EXPECT_LE(gait.groups * step * double{tuning.windowSlack} * double{slowest},
              GeneSpace::longestCycle + 1e-6);
  }
}

TEST(Genes, TheGaitByRuleIsAmongThem) {
  const Rig rig = spiderRig();
  const GeneSpace space(rig, Tuning{}, Evolution::wantedSpeed);
  for (const uint32_t idle : patternsOf(rig)) {
    const crowd::Regait rule = crowd::regaitByRule(rig, Tuning{}, {.idle = idle});
    const crowd::Regait made =
        crowd::regaitOf(rig, space.decode(space.encode(rule, idle), idle), {.idle = idle});
    if (rule.groups > 5) continue;
    EXPECT_EQ(made.groups, rule.groups) << idle;
    EXPECT_NEAR(made.speed, rule.speed, 1e-4f) << idle;
    EXPECT_NEAR(made.shift.z, rule.shift.z, 1e-4f * rig.legLength) << idle;
    EXPECT_NEAR(made.shift.y, rule.shift.y, 1e-4f * rig.legLength) << idle;
    for (size_t leg = 0; leg < 8; ++leg) {
      EXPECT_EQ(made.legs[leg].neighbours, rule.legs[leg].neighbours) << idle << ", leg " << leg;
      if ((idle >> leg & 1u) != 0) continue;
      EXPECT_NEAR(static_cast<float>(made.legs[leg].group) + made.legs[leg].within,
                  static_cast<float>(rule.legs[leg].group), 1e-3f)
          << idle << ", leg " << leg;
    }
  }
}

TEST_F(EvolutionTest, TheSameSeedGivesTheSameBitsResumedOrNot) {
  // Few patterns, so that the last batches are children of the first ones.
  const Rig rig = loadRig(SKITTER_ROOT "/assets/quadruped.glb");
  const EvolutionOptions options{.seed = 5, .batch = 80, .dt = 1.0f / 20};
  Evolution whole(device(), rig, options), parts(device(), rig, options);
  EXPECT_EQ(whole.filledCount(), 0u);
  for (int i = 0; i < 2; ++i) whole.step(), parts.step();
  const std::string half = parts.map();
  EXPECT_EQ(whole.map(), half);
  Evolution resumed(device(), rig, half, "half");
  EXPECT_EQ(resumed.map(), half);
  EXPECT_EQ(resumed.evaluations(), 160u);
  EXPECT_GT(resumed.filledCount(), 0u);
  for (int i = 0; i < 2; ++i) whole.step(), resumed.step();
  EXPECT_EQ(whole.map(), resumed.map());
  EXPECT_NE(whole.map(), half);
  EvolutionOptions other = options;
  other.seed = 6;
  Evolution another(device(), rig, other);
  for (int i = 0; i < 2; ++i) another.step();
  EXPECT_NE(another.map(), half);
}

TEST_F(EvolutionTest, ItsGaitsAreATableThatIsJudged) {
  const Rig rig = spiderRig();
  Evolution search(device(), rig, {.batch = 240, .dt = 1.0f / 20});
  search.step();
  const std::vector<RigGait> gaits = search.gaits();
  EXPECT_EQ(search.patternCount(), 114u);
  EXPECT_GT(gaits.size(), 57u);
  EXPECT_EQ(gaits.back().idle, patternsOf(rig).back());
  EXPECT_GE(search.filledCount(), gaits.size());
  EXPECT_LT(search.filledCount(), search.cellCount());
  for (const RigGait& gait : gaits) EXPECT_GT(gait.fitness, 0) << gait.idle;
  EXPECT_EQ(parseGaits(writeGaits(rig, gaits), "table", rig), gaits);
  Rig walker = rig;
  walker.gaits = gaits;
  std::vector<uint32_t> patterns;
  for (size_t i = 0; i < 4; ++i) patterns.push_back(gaits[i].idle);
  const std::vector<GaitJudgement> judged = judgeGaits(device(), walker, patterns, 2, 1.0f / 20);
  ASSERT_EQ(judged.size(), 4u);
  for (size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(judged[i].idle, gaits[i].idle);
    EXPECT_GT(judged[i].speed, 0.3);
    EXPECT_LT(judged[i].speed, 1.6);
  }
}

// The legs that a pattern has idle never stand in its trials, and the others do.
TEST_F(EvolutionTest, APatternIsTriedWithItsOwnLegsIdle) {
  Evolution search(device(), spiderRig(), {.batch = 240, .dt = 1.0f / 20});
  search.step();
  const nlohmann::json map = nlohmann::json::parse(search.map());
  ASSERT_GT(map["elites"].size(), 50u);
  for (const nlohmann::json& elite : map["elites"])
    for (size_t leg = 0; leg < 8; ++leg)
      EXPECT_EQ(elite[5][leg] == 0, (elite[0].get<uint32_t>() >> leg & 1u) != 0)
          << "pattern " << elite[0] << ", leg " << leg;
}

TEST_F(EvolutionTest, EveryCreatureTriesGaits) {
  Evolution search(device(), spiderRig(), {.batch = 240, .dt = 1.0f / 20});
  search.step();
  const std::vector<AdaptationReport> reports = search.adapt(8, 3);
  ASSERT_FALSE(reports.empty());
  for (const AdaptationReport& report : reports) {
    EXPECT_GE(report.used, std::max(report.trials, 1u)) << report.lost;
    EXPECT_LE(report.used, 20u) << report.lost;
  }
}

// A creature finds the gait that it finds alone, whatever others there are, and in whichever batch it tries.
TEST_F(EvolutionTest, CreaturesThatTryInBatchesFindWhatTheyFindAtOnce) {
  const Rig rig = loadRig(SKITTER_ROOT "/assets/quadruped.glb");
  Evolution search(device(), rig, {.batch = 16, .dt = 1.0f / 20});
  for (int i = 0; i < 4; ++i) search.step();
  // A creature tries gaits only where the map has one without the legs that it lost.
  const std::vector<AdaptationReport> few = search.adapt(30, 3), many = search.adapt(120, 3);
  ASSERT_GT(few.size(), 4u);
  ASSERT_LE(few.size(), 16u);
  ASSERT_GT(many.size(), 2 * 16u);
  for (size_t i = 0; i < few.size(); ++i) {
    EXPECT_EQ(many[i].lost, few[i].lost) << i;
    EXPECT_EQ(many[i].found, few[i].found) << i;
    EXPECT_EQ(many[i].used, few[i].used) << i;
  }
  for (const AdaptationReport& report : many) EXPECT_GE(report.used, 1u) << report.lost;
}

// Spiders begin a centimetre from each other, with the same legs down. With all of them, they go as fast as
// they want to, but for their start.
TEST_F(EvolutionTest, ASpeedIsThatOfTheWayFromWhereOneBegan) {
  const std::vector<GaitJudgement> judged =
      judgeGaits(device(), spiderRig(), std::vector<uint32_t>(9, 0), 4, 1.0f / 20);
  for (const GaitJudgement& one : judged) {
    EXPECT_LE(one.speed, Evolution::wantedSpeed);
    EXPECT_NEAR(one.speed, judged[0].speed, 1e-4 * Evolution::wantedSpeed);
  }
  EXPECT_GT(judged[0].speed, 0.85 * Evolution::wantedSpeed);
}

// A table's gait is slower than the rule's, so that one is not taken for the other.
TEST_F(EvolutionTest, ATableIsJudgedForItsPatternsAndTheRuleForOthers) {
  Rig rig = spiderRig();
  rig.gaits = {};
  const std::vector<uint32_t> patterns = {0, 1, 2, 4};
  const std::vector<GaitJudgement> byRule = judgeGaits(device(), rig, patterns, 2, 1.0f / 20);
  RigGait slow{.idle = 2, .groups = 3, .speed = 0.5f, .turns = {}};
  for (size_t leg = 0; leg < 8; ++leg) slow.turns.push_back({static_cast<float>(leg % 3) / 3, 1});
  rig.gaits = {slow};
  const std::vector<GaitJudgement> byTable = judgeGaits(device(), rig, patterns, 2, 1.0f / 20);
  // 2 is R1 and 1 its mirror image, L1.
  for (const size_t i : {0, 3}) EXPECT_EQ(byTable[i].speed, byRule[i].speed) << i;
  for (const size_t i : {1, 2}) EXPECT_LT(byTable[i].speed, 0.8 * byRule[i].speed) << i;
}

// A spider without one of its two tripods lifts all the legs that are left at once, unless they take turns by
// the rule.
TEST_F(EvolutionTest, WhoDoesNotAdaptIsLessStable) {
  Rig rig = spiderRig();
  rig.gaits = {};
  uint32_t group = 0;
  for (size_t leg = 0; leg < 8; ++leg)
    if (rig.legs[leg].group == rig.legs[0].group) group |= 1u << leg;
  const std::vector<uint32_t> patterns = {0, group};
  const std::vector<GaitJudgement> byRule = judgeGaits(device(), rig, patterns, 4, 1.0f / 20),
                                   unadapted = judgeUnadapted(device(), rig, patterns, 4, 1.0f / 20);
  EXPECT_EQ(unadapted[0].speed, byRule[0].speed);
  EXPECT_EQ(unadapted[0].unstable, byRule[0].unstable);
  EXPECT_GT(unadapted[1].unstable, byRule[1].unstable + 0.05);
}

TEST_F(EvolutionTest, RefusesWhatCannotBe) {
  const Rig rig = spiderRig();
  EXPECT_THAT(faultOf([&] { Evolution(device(), rig, {.batch = 0}); }),
              "batch of a search is 0, expected 1 to 262144");
  EXPECT_THAT(faultOf([&] { Evolution(device(), rig, {.dt = 1}); }),
              testing::HasSubstr("dt of a search is 1"));
  Rig three = manyLegged(8);
  three.legs.resize(3);
  EXPECT_THAT(faultOf([&] { Evolution(device(), three); }),
              testing::HasSubstr("has 3 legs, expected at least 4"));
}

// A map of no more than what is looked at.
TEST(Maps, ADamagedOneIsRefusedByItsKey) {
  const Rig rig = spiderRig();
  const std::vector<uint32_t> patterns = patternsOf(rig);
  const size_t genes = GeneSpace(rig, Tuning{}, Evolution::wantedSpeed).count();
  SearchState state{
      .seed = 9, .batch = 4, .dt = 1.0f / 60, .evaluations = 8, .archive = Archive(patterns.size())};
  const Elite elite{
      .candidate = 3, .fitness = 0.25f, .genes = Genes(genes, 77), .shares = std::vector(8, 0.5f)};
  ASSERT_TRUE(state.archive.offer(2, 5, elite));
  const std::string text = writeMap(rig, patterns, state);
  const SearchState back = readMap(text, "map", rig, patterns, genes);
  EXPECT_EQ(back.archive, state.archive);
  EXPECT_EQ(back.seed, 9u);
  EXPECT_EQ(back.dt, state.dt);
  EXPECT_EQ(back.evaluations, 8u);
  const auto faultWith = [&](const std::string& from, const std::string& to) {
    std::string changed = text;
    const size_t at = changed.find(from);
    if (at == std::string::npos) return "not found: " + from;
    changed.replace(at, from.size(), to);
    return faultOf([&] { readMap(changed, "map", rig, patterns, genes); });
  };
  EXPECT_THAT(faultWith("\"version\": 1", "\"version\": 2"), "map: version is 2, expected 1");
  EXPECT_THAT(faultWith("\"batch\": 4", "\"batch\": 0"), testing::HasSubstr("map: batch is 0, expected"));
  EXPECT_THAT(faultWith("\"evaluations\": 8", "\"evaluations\": 7"),
              "map: evaluations is 7, expected whole batches of 4");
  EXPECT_THAT(faultWith("\"seed\": 9, ", ""), "map: seed is missing");
  EXPECT_THAT(faultWith(",5,3,", ",64,3,"), testing::HasSubstr("map: elites[0][1] is 64, expected"));
  EXPECT_THAT(faultWith(",5,3,", ",5,8,"), testing::HasSubstr("map: elites[0][2] is 8, expected"));
  EXPECT_THAT(faultWith(",0.25,", ",0,"), testing::HasSubstr("an elite with a fitness above 0"));
  EXPECT_THAT(faultWith("[77,", "["), testing::HasSubstr("map: elites[0][4] is"));
  EXPECT_THAT(faultWith("[77,", "[70000,"), testing::HasSubstr("70000"));
  Rig other = rig;
  other.legs[0].home.x += 0.1f;
  EXPECT_THAT(faultOf([&] { readMap(text, "map", other, patterns, genes); }),
              testing::HasSubstr("the fingerprint of this rig"));
}

}  // namespace
}  // namespace skitter::test
