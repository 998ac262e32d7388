#include "app/run/damage.h"

#include <gmock/gmock.h>

#include <fstream>

#include "process.h"

namespace skitter::test {
namespace {

using app::DamageFigures;
using app::DamageTally;
using app::HurtAgent;

using Hurting = AppTest;

// On three legs of 2 m around its centre, and a fourth that does not carry. The first one is `x` from its
// place and `error` from its target.
HurtAgent standing(double x = 0, bool isPlanted = true, double error = 0) {
  return {.legLength = 2,
          .centre = {0, 0},
          .legs = {{.tip = {1 + x, 1}, .isPlanted = isPlanted, .error = error},
                   {.tip = {-1, 1}, .isPlanted = true},
                   {.tip = {0, -1}, .isPlanted = true},
                   {.tip = {9, 9}, .carries = false, .error = 5}}};
}

TEST(Damage, SlipIsThatOfStancesOfWhichBothEndsWereSeen) {
  DamageTally tally;
  uint64_t tick = 10;
  const auto goOn = [&](double x, bool isPlanted) { tally.add(3, tick++, standing(x, isPlanted)); };
  // It stood before.
  goOn(0, true);
  goOn(0.5, true);
  goOn(0.6, false);
  EXPECT_FALSE(tally.figures().slip);
  // Half a metre to land, which is no slip; then 0.02 m and back.
  goOn(1, true);
  goOn(1.02, true);
  goOn(1, true);
  EXPECT_FALSE(tally.figures().slip) << "it still stands";
  goOn(1.5, false);
  EXPECT_NEAR(tally.figures().slip.value(), 0.02, 1e-12);
  goOn(2, true);
  goOn(2, false);
  EXPECT_NEAR(tally.figures().slip.value(), 0.01, 1e-12) << "the mean of two stances";
}

TEST(Damage, SlipIsThatOfWhoSlipsMost) {
  DamageTally tally;
  for (const uint64_t agent : {1, 2, 3}) {
    const double slide = agent == 2 ? 0.06 : 0.002;
    tally.add(agent, 1, standing(0, false));
    tally.add(agent, 2, standing(0, true));
    tally.add(agent, 3, standing(slide, true));
    tally.add(agent, 4, standing(0, false));
  }
  EXPECT_NEAR(tally.figures().slip.value(), 0.03, 1e-12);
  EXPECT_EQ(tally.figures().agents, 3u);
}

// An agent that was whole for a while stands elsewhere when it is hurt again.
TEST(Damage, ATickThatIsMissingEndsNoStance) {
  DamageTally tally;
  tally.add(1, 1, standing(0, false));
  tally.add(1, 2, standing(0, true));
  tally.add(1, 9, standing(0.7, false));
  EXPECT_FALSE(tally.figures().slip);
}

TEST(Damage, WhoseCentreIsOutsideOfItsFeetIsUnstable) {
  DamageTally tally;
  tally.add(1, 1, standing());
  EXPECT_EQ(tally.figures().unstable, 0);
  HurtAgent leaning = standing();
  leaning.centre = {1.1, 0};
  tally.add(1, 2, leaning);
  EXPECT_EQ(tally.figures().unstable, 0.5);
  tally.add(1, 3, standing(0, false));  // two feet are a line
  tally.add(1, 4, standing());
  EXPECT_EQ(tally.figures().unstable, 0.5);
}

TEST(Damage, ReachErrorsAreOfLegsThatCarry) {
  DamageTally tally;
  for (uint64_t tick = 0; tick < 1000; ++tick) tally.add(1, tick, standing(0, true, tick < 40 ? 0.1 : 1e-4));
  // 40 of 3,000 are 0.05 leg lengths; two of three legs have none at all.
  EXPECT_NEAR(tally.figures().reachErrorP99.value(), 0.05, 0.05 * 0.022);
  DamageTally exact;
  exact.add(1, 1, standing());
  EXPECT_EQ(exact.figures().reachErrorP99, 0);
}

TEST(Damage, ASpeedCountsWhereFeetHoldAndArrive) {
  DamageTally tally;
  tally.add(1, 1, standing());
  EXPECT_FALSE(tally.figures().speedKept);
  EXPECT_FALSE(tally.figures().counts());
  tally.addSpeed(0.8, 1);
  tally.addSpeed(0.4, 0.5);
  EXPECT_DOUBLE_EQ(tally.figures().speedKept.value(), 0.8);
  EXPECT_TRUE(tally.figures().counts().value());
  EXPECT_FALSE((DamageFigures{.speedKept = 1, .slip = 0.011, .reachErrorP99 = 0}.counts().value()));
  EXPECT_FALSE((DamageFigures{.speedKept = 1, .slip = 0, .reachErrorP99 = 0.011}.counts().value()));
  EXPECT_TRUE((DamageFigures{.speedKept = 1, .slip = 0.01, .reachErrorP99 = 0.01}.counts().value()));
}

// docs/damage.md: without R2 and L3 a spider goes on tripods, and as fast as before.
TEST_F(Hurting, ARunSaysHowTheyGetOn) {
  std::ofstream(file("lost.json")) << R"({"terrain": {"columns": 65, "rows": 65, "amplitude": 0},
    "herds": [{"agents": 12, "hurt": true, "goal": {"kind": "velocity", "velocity": [0, 0.5]},
               "spawn": {"kind": "grid", "centre": [0, -4], "spacing": 2}}],
    "events": [{"at": 1, "agents": [0, 1, 2, 3, 4, 5, 6, 7], "leg": "R2"},
               {"at": 1, "agents": [0, 1, 2, 3, 4, 5, 6, 7], "leg": "L3"}]})";
  const auto run = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments = {"run", file("lost.json"), "--headless", "--frames"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Result result = skitter(arguments);
    EXPECT_EQ(result.code, 0) << result.err;
    return result.out;
  };
  const std::string told = run({"420", "--no-measure", "--json", file("run.json"), "--force"});
  EXPECT_THAT(told, testing::HasSubstr("damage      8 agents are hurt"));
  const nlohmann::json damage = json("run.json").at("damage");
  EXPECT_EQ(damage.at("agents"), 8);
  EXPECT_GT(damage.at("speedKept"), 0.95);
  EXPECT_LT(damage.at("speedKept"), 1.05);
  EXPECT_TRUE(damage.at("counts").get<bool>());
  EXPECT_EQ(damage.at("unstable"), 0);
  EXPECT_LT(damage.at("slip"), 0.01);
  EXPECT_LT(damage.at("reachErrorP99"), 0.01);
  EXPECT_EQ(damage.size(), 6u);

  // Nobody has been hurt for two seconds.
  EXPECT_THAT(run({"170", "--json", file("run.json"), "--force"}), testing::HasSubstr("nobody was hurt"));
  const nlohmann::json early = json("run.json").at("damage");
  EXPECT_EQ(early.at("agents"), 0);
  for (const char* figure : {"speedKept", "counts", "unstable", "slip", "reachErrorP99"})
    EXPECT_TRUE(early.at(figure).is_null()) << figure;

  // What else there would be is not known of a state.
  run({"200", "--save", file("lost.state"), "--force"});
  const Result result = skitter({"run", "--headless", "--resume", file("lost.state"), "--frames", "240",
                                 "--json", file("run.json"), "--force"});
  ASSERT_EQ(result.code, 0) << result.err;
  const nlohmann::json resumed = json("run.json").at("damage");
  EXPECT_EQ(resumed.at("agents"), 8);
  EXPECT_TRUE(resumed.at("speedKept").is_null());
  EXPECT_EQ(resumed.at("unstable"), 0);
  EXPECT_THAT(result.out, testing::HasSubstr("speed not compared"));
}

// It is not simulated twice, and no figure of the run is another one.
TEST_F(Hurting, WhoDoesNotAskIsNotTold) {
  const auto run = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments = {"run", SKITTER_ROOT "/assets/scenes/lost-legs.json", "--headless",
                                          "--frames", "200"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Result result = skitter(arguments);
    EXPECT_EQ(result.code, 0) << result.err;
    return result.out;
  };
  const auto hashIn = [](const std::string& text) { return text.substr(text.find("state hash"), 28); };
  const std::string quiet = run({}), asked = run({"--json", file("run.json")});
  EXPECT_THAT(quiet, testing::Not(testing::HasSubstr("damage")));
  EXPECT_THAT(asked, testing::HasSubstr("damage"));
  EXPECT_EQ(hashIn(quiet), hashIn(asked));
}

}  // namespace
}  // namespace skitter::test
