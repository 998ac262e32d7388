#include <fmt/format.h>
#include <signal.h>

#include <filesystem>
#include <fstream>

#include "../support/stages_page.h"
#include "process.h"
#include "skitter/controller.h"

namespace skitter::test {
namespace {

using Validate = AppTest;

std::vector<std::string> stagesThatAgree(const nlohmann::json& validation) {
  std::vector<std::string> names;
  for (const nlohmann::json& stage : validation.at("stages")) {
    names.push_back(stage.at("name"));
    EXPECT_TRUE(stage.at("pass")) << names.back();
    EXPECT_GT(stage.at("samples"), 0) << names.back();
    EXPECT_LE(stage.at("maxError"), stage.at("tolerance")) << names.back();
    EXPECT_TRUE(stage.at("ties").is_number_unsigned()) << names.back();
    EXPECT_EQ(stage.at("why"), "") << names.back();
  }
  return names;
}

int samplesOf(const nlohmann::json& validation, const std::string& name) {
  for (const nlohmann::json& stage : validation.at("stages"))
    if (stage.at("name") == name) return stage.at("samples").get<int>();
  return -1;
}

TEST_F(Validate, EveryStageAgreesWithTheReference) {
  for (const Controller controller : allControllers) {
    SCOPED_TRACE(nameOf(controller));
    const Result result = skitter({"validate", "--controller", nameOf(controller), "--agents", "16",
                                   "--frames", "30", "--seed", "5", "--json", file("v.json")});
    EXPECT_EQ(result.code, 0) << result.out << result.err;
    EXPECT_NE(result.out.find("seed 5"), std::string::npos);
    const nlohmann::json validation = json("v.json");
    EXPECT_TRUE(validation.at("pass"));
    EXPECT_FALSE(validation.at("interrupted"));
    EXPECT_EQ(validation.at("ticks"), 30);
    EXPECT_EQ(validation.at("ticksWanted"), 30);
    EXPECT_TRUE(validation.at("device").is_string());
    EXPECT_EQ(stagesThatAgree(validation), replayedOnThePage({nameOf(controller)}));
  }
}

// Bounds grow with the legs: a step's arc is as high as they are long.
TEST_F(Validate, LegsOfAnyLengthAgreeWithTheReference) {
  std::filesystem::copy_file(SKITTER_ROOT "/assets/quadruped.glb", file("quadruped.glb"));
  std::ifstream from(SKITTER_ROOT "/assets/quadruped.rig.json");
  nlohmann::json rig = nlohmann::json::parse(from);
  const auto validated = [&](double metres, const char* terrain) {
    rig["legLength"] = metres;
    std::ofstream(file("quadruped.rig.json")) << rig;
    return skitter({"validate", "--rig", file("quadruped.rig.json"), "--agents", "4", "--terrain", terrain});
  };
  for (const double metres : {0.001, 0.03, 22.0, 40.0, 60.0, 100.0}) {
    for (const char* terrain : {"noise:amplitude=0", "noise"}) {
      const Result result = validated(metres, terrain);
      EXPECT_EQ(result.code, 0) << metres << " m, " << terrain << ": " << result.out << result.err;
    }
  }
  expectRefusal(validated(1000, "noise"), 2, {"legs of 1000 m, expected at most 100 m: scale the rig down"});
}

TEST_F(Validate, AgentsThatAvoidEachOtherAgreeWithTheReference) {
  for (const Controller controller : allControllers) {
    SCOPED_TRACE(nameOf(controller));
    const Result result =
        skitter({"validate", SKITTER_ROOT "/assets/scenes/head-on.json", "--avoid", "--controller",
                 nameOf(controller), "--agents", "25", "--frames", "30", "--json", file("v.json")});
    EXPECT_EQ(result.code, 0) << result.out << result.err;
    EXPECT_EQ(stagesThatAgree(json("v.json")), replayedOnThePage({nameOf(controller)}, true));
  }
  expectRefusal(skitter({"validate", "--avoid", "--free-run"}), 2,
                {"--free-run: herds[0].avoid of", "is true"});
  expectRefusal(skitter({"validate", "--stages", "avoid"}), 2,
                {"--stages: no herd of", "has avoid compared"});
}

TEST_F(Validate, AgentsThatFindTheirWayAgreeWithTheReference) {
  for (const Controller controller : allControllers) {
    SCOPED_TRACE(nameOf(controller));
    const Result result = skitter({"validate", SKITTER_ROOT "/assets/scenes/maze.json", "--controller",
                                   nameOf(controller), "--agents", "9", "--frames", "60"});
    EXPECT_EQ(result.code, 0) << result.out << result.err;
  }
}

TEST_F(Validate, ForagersAgreeWithTheReference) {
  for (const Controller controller : allControllers) {
    SCOPED_TRACE(nameOf(controller));
    const Result result = skitter({"validate", SKITTER_ROOT "/assets/scenes/foraging.json", "--controller",
                                   nameOf(controller), "--agents", "9", "--frames", "60"});
    EXPECT_EQ(result.code, 0) << result.out << result.err;
  }
  for (const char* scene : {"double-bridge", "double-bridge-equal"})
    EXPECT_EQ(skitter({"validate", fmt::format(SKITTER_ROOT "/assets/scenes/{}.json", scene), "--agents",
                       "20", "--frames", "60"})
                  .code,
              0);
  expectRefusal(skitter({"validate", SKITTER_ROOT "/assets/scenes/foraging.json", "--free-run"}), 2,
                {"--free-run: herds[0]", "forages"});
}

// Neither changes a bit of what is compared.
TEST_F(Validate, PagesAndFusionChangeNothing) {
  const std::vector<std::string> plain = {"validate", "--agents", "40", "--frames", "40", "--dt", "0.15"};
  std::vector<std::string> parted = plain;
  parted.insert(parted.end(), {"--page-agents", "17", "--apart", "--json", file("parted.json")});
  std::vector<std::string> whole = plain;
  whole.insert(whole.end(), {"--json", file("whole.json")});
  EXPECT_EQ(skitter(whole).code, 0);
  EXPECT_EQ(skitter(parted).code, 0);
  nlohmann::json parts = json("parted.json"), all = json("whole.json");
  for (nlohmann::json* each : {&parts, &all}) each->at("manifest").erase("command");
  EXPECT_EQ(parts, all);
}

TEST_F(Validate, HerdsWithDifferentStagesAreOneTable) {
  write("mixed.json", R"({"terrain": {"kind": "noise"}, "herds": [
    {"rig": "spider", "controller": "clip", "agents": 4},
    {"rig": "spider", "controller": "adaptive", "agents": 4}]})");
  const Result result = skitter({"validate", file("mixed.json"), "--frames", "20", "--json", file("v.json")});
  EXPECT_EQ(result.code, 0) << result.out << result.err;
  EXPECT_EQ(stagesThatAgree(json("v.json")), replayedOnThePage({"clip", "adaptive"}));
}

TEST_F(Validate, AFreeRunStaysTogether) {
  for (const Controller controller : allControllers) {
    SCOPED_TRACE(nameOf(controller));
    const Result result = skitter({"validate", "--controller", nameOf(controller), "--agents", "8",
                                   "--frames", "120", "--free-run", "--json", file("v.json")});
    EXPECT_EQ(result.code, 0) << result.out << result.err;
    EXPECT_NE(result.out.find("free run: "), std::string::npos) << result.out;
    EXPECT_GE(json("v.json").at("freeRunShare"), 0.75);
  }
}

TEST_F(Validate, TheGroundMayChangeUnderTheCrowd) {
  for (const Controller controller : allControllers) {
    SCOPED_TRACE(nameOf(controller));
    const Result result = skitter({"validate", "--controller", nameOf(controller), "--agents", "24",
                                   "--frames", "90", "--edits", "--free-run", "--json", file("v.json")});
    EXPECT_EQ(result.code, 0) << result.out << result.err;
    // Four times, near 16 agents each.
    EXPECT_EQ(json("v.json").at("edits"), 64);
    EXPECT_NE(result.out.find("edits of the ground: 64\n"), std::string::npos) << result.out;
    EXPECT_GE(json("v.json").at("freeRunShare"), 0.75);
  }
}

// Ground that changes when the scene says.
TEST_F(Validate, EventsOfASceneAreReplayed) {
  const Result result = skitter({"validate", SKITTER_ROOT "/assets/scenes/events.json", "--agents", "40",
                                 "--frames", "130", "--free-run", "--json", file("v.json")});
  EXPECT_EQ(result.code, 0) << result.out << result.err;
  EXPECT_FALSE(stagesThatAgree(json("v.json")).empty());
  EXPECT_GE(json("v.json").at("freeRunShare"), 0.75);
}

// Agents that are steered, moved, added and removed when the scene says, with every controller.
TEST_F(Validate, EventsAboutAgentsAreReplayed) {
  for (const Controller controller : allControllers) {
    SCOPED_TRACE(nameOf(controller));
    const Result result =
        skitter({"validate", SKITTER_ROOT "/assets/scenes/steered.json", "--controller", nameOf(controller),
                 "--dt", "0.05", "--frames", "45", "--free-run", "--json", file("v.json")});
    EXPECT_EQ(result.code, 0) << result.out << result.err;
    EXPECT_EQ(stagesThatAgree(json("v.json")), replayedOnThePage({nameOf(controller)}));
    EXPECT_GE(json("v.json").at("freeRunShare"), 0.75);
  }
}

// Herds that come and go when the scene says, with every controller.
TEST_F(Validate, HerdsThatComeAndGoAreReplayed) {
  for (const Controller controller : allControllers) {
    SCOPED_TRACE(nameOf(controller));
    for (const char* option : {"--free-run", "--edits"}) {
      const Result result =
          skitter({"validate", SKITTER_ROOT "/assets/scenes/waves.json", "--controller", nameOf(controller),
                   "--agents", "8", "--dt", "0.05", "--frames", "45", option, "--json", file("v.json")});
      EXPECT_EQ(result.code, 0) << result.out << result.err;
      EXPECT_EQ(stagesThatAgree(json("v.json")), replayedOnThePage({nameOf(controller)}));
      // Eight all along, 16 from tick 10 on with two more places, and 6 in their place from tick 30 on.
      // Agents who are not there are not compared in navigate.
      EXPECT_GE(samplesOf(json("v.json"), "navigate"), 8 * 45 + 16 * 20 + 6 * 16);
      EXPECT_LE(samplesOf(json("v.json"), "navigate"), 8 * 45 + 18 * 20 + 6 * 16);
      if (json("v.json").contains("freeRunShare")) {
        EXPECT_GE(json("v.json").at("freeRunShare"), 0.75);
      }
    }
  }
}

TEST_F(Validate, AHerdThatComesLaterIsCompared) {
  write("empty.json", R"({"herds": [], "events": [{"at": 0.1, "addHerd": {}}]})");
  const Result result =
      skitter({"validate", file("empty.json"), "--agents", "6", "--frames", "60", "--json", file("v.json")});
  EXPECT_EQ(result.code, 0) << result.out << result.err;
  EXPECT_EQ(stagesThatAgree(json("v.json")), replayedOnThePage({"adaptive"}));
  EXPECT_EQ(samplesOf(json("v.json"), "navigate"), 6 * 55);
  write("lost.json", R"({"herds": [{}], "events": [{"at": 0.1, "addHerd": {"rig": "none.glb"}}]})");
  expectRefusal(skitter({"validate", file("lost.json"), "--quiet"}), 2,
                {"lost: events[0].addHerd: ", "none.glb"});
}

// The usual number of agents does not suit a scene that names some, whatever it is.
TEST_F(Validate, AgentsThatEventsNameAreThere) {
  write("named.json", R"({"herds": [{"agents": 70}], "events": [{"at": 0.1, "agents": [69], "speed": 2}]})");
  const Result result = skitter({"validate", file("named.json"), "--frames", "10"});
  EXPECT_EQ(result.code, 0) << result.out << result.err;
  EXPECT_NE(result.out.find(": 70 agents, 10 ticks"), std::string::npos) << result.out;
  expectRefusal(skitter({"validate", file("named.json"), "--agents", "69"}), 2,
                {"named: events[0].agents[0] is 69, expected less than 69"});
  write("gone.json", R"({"herds": [{"agents": 3, "reserve": 1}],
                         "events": [{"at": 0.1, "remove": [1]}, {"at": 0.2, "remove": [1]}]})");
  expectRefusal(skitter({"validate", file("gone.json"), "--quiet"}), 2,
                {"gone: events[1]: herd 0, agent 1: nobody, expected one of 2 agents"});
}

TEST_F(Validate, WhoComesLaterIsCompared) {
  write("empty.json", R"({"herds": [{"agents": 0, "reserve": 4}],
                          "events": [{"at": 0.1, "add": [{"position": [1, 2]}, {"position": [5, 2]}]}]})");
  const Result result =
      skitter({"validate", file("empty.json"), "--agents", "0", "--frames", "60", "--json", file("v.json")});
  EXPECT_EQ(result.code, 0) << result.out << result.err;
  EXPECT_EQ(stagesThatAgree(json("v.json")), replayedOnThePage({"adaptive"}));
}

TEST_F(Validate, EverySizeOfAHerdIsReplayed) {
  write("sized.json", R"({"herds": [{"agents": 30, "sizes": [0.6, 1.5, 1]}], "events": [
    {"at": 0.2, "agents": [0, 29], "speed": 0.5},
    {"at": 0.3, "teleport": [{"agent": 29, "position": [3, 4]}, {"agent": 0, "position": [-3, 4]}]}]})");
  for (const char* option : {"--edits", "--free-run"}) {
    const Result result =
        skitter({"validate", file("sized.json"), "--frames", "60", option, "--json", file("v.json")});
    EXPECT_EQ(result.code, 0) << result.out << result.err;
    for (const nlohmann::json& stage : json("v.json").at("stages"))
      if (stage.at("name") == "navigate") {
        EXPECT_EQ(stage.at("samples"), 30 * 60);
      }
  }
  EXPECT_GE(json("v.json").at("freeRunShare"), 0.75);
}

TEST_F(Validate, NothingToCompareIsAWrongInput) {
  expectRefusal(skitter({"validate", "--frames", "0"}), 2, {"--frames", "0", "1"});
  expectRefusal(skitter({"validate", "--agents", "0"}), 2, {"no agents", "at least one"});
  write("empty.json", R"({"herds": [{"agents": 0, "reserve": 4}]})");
  expectRefusal(skitter({"validate", file("empty.json"), "--agents", "0"}), 2, {"no agents", "at least one"});
}

// Foothold must leave the steps of legs that never step as they are.
TEST_F(Validate, ACrowdThatStandsIsCompared) {
  write("standing.json", R"({"herds": [{"rig": "spider", "agents": 4, "goal": {"kind": "none"}},
                                       {"rig": "spider", "agents": 0}]})");
  const Result result = skitter(
      {"validate", file("standing.json"), "--agents", "4", "--frames", "20", "--json", file("v.json")});
  EXPECT_EQ(result.code, 0) << result.out << result.err;
  const nlohmann::json written = json("v.json");
  nlohmann::json foothold;
  for (const nlohmann::json& stage : written.at("stages"))
    if (stage.at("name") == "foothold") foothold = stage;
  EXPECT_EQ(foothold.at("samples").get<int>() + foothold.at("kept").get<int>(), 4 * 8 * 20);
  EXPECT_GT(foothold.at("kept"), 4 * 8 * 10);
}

TEST_F(Validate, InterruptedIsNoPass) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    SCOPED_TRACE(signal);
    bool sent = false;
    const Result result = skitter({"validate", "--agents", "8", "--frames", "2000", "--json", file("v.json")},
                                  {}, [&](int child) {
                                    if (sent || !catches(child, signal)) return;
                                    kill(child, signal);
                                    sent = true;
                                  });
    ASSERT_TRUE(sent);
    EXPECT_EQ(result.code, 130) << result.out;
    const nlohmann::json validation = json("v.json");
    EXPECT_FALSE(validation.at("pass"));
    EXPECT_TRUE(validation.at("interrupted"));
    EXPECT_FALSE(validation.at("timedOut"));
    EXPECT_EQ(validation.at("ticksWanted"), 2000);
    const auto ticks = validation.at("ticks").get<uint64_t>();
    EXPECT_LT(ticks, 2000u);
    EXPECT_EQ(result.err, "skitter: interrupted after " + std::to_string(ticks) + " of 2000 ticks\n");
    // Before the first tick nothing was compared.
    for (const nlohmann::json& stage : validation.at("stages"))
      EXPECT_EQ(stage.at("why") == "no samples", stage.at("samples") == 0 && stage.at("kept") == 0);
  }
}

TEST_F(Validate, ComparesTheStagesThatAreAskedFor) {
  const Result result = skitter(
      {"validate", "--agents", "8", "--frames", "20", "--stages", "ik,foothold", "--json", file("v.json")});
  EXPECT_EQ(result.code, 0) << result.out << result.err;
  EXPECT_EQ(stagesThatAgree(json("v.json")), (std::vector<std::string>{"foothold", "ik"}));
  expectRefusal(skitter({"validate", "--stages", "trot"}), 2, {"--stages", "trot", "foothold"});
  expectRefusal(skitter({"validate", "--controller", "clip", "--stages", "swing,foothold"}), 2,
                {"--stages", "foothold", "no herd"});
}

TEST_F(Validate, ReportsToServersOfContinuousIntegration) {
  const Result result = skitter({"validate", "--device", "all", "--agents", "8", "--frames", "20", "--json",
                                 file("v.json"), "--junit", file("v.xml")});
  EXPECT_EQ(result.code, 0) << result.out << result.err;
  const nlohmann::json devices = json("v.json").at("devices");
  ASSERT_FALSE(devices.empty());
  std::ifstream in(file("v.xml"));
  const std::string xml(std::istreambuf_iterator<char>(in), {});
  for (const nlohmann::json& device : devices) {
    EXPECT_TRUE(device.at("pass"));
    const std::string suite =
        "<testsuite name=\"" + device.at("device").get<std::string>() + "\" tests=\"9\"";
    EXPECT_NE(xml.find(suite + " failures=\"0\" errors=\"0\""), std::string::npos) << xml;
  }
  EXPECT_NE(xml.find("<testcase classname=\"skitter.validate\" name=\"foothold\">"), std::string::npos)
      << xml;
  EXPECT_NE(xml.find("<property name=\"sceneHash\""), std::string::npos) << xml;
}

TEST_F(Validate, StopsWhenItsTimeIsOver) {
  const Result result = skitter({"validate", "--agents", "64", "--frames", "100000", "--timeout", "1.5",
                                 "--json", file("v.json"), "--junit", file("v.xml")});
  EXPECT_EQ(result.code, 1) << result.out;
  EXPECT_NE(result.err.find("skitter: timed out after "), std::string::npos) << result.err;
  const nlohmann::json validation = json("v.json");
  EXPECT_TRUE(validation.at("timedOut"));
  EXPECT_FALSE(validation.at("pass"));
  EXPECT_EQ(validation.at("ticksWanted"), 100000);
  std::ifstream in(file("v.xml"));
  const std::string xml(std::istreambuf_iterator<char>(in), {});
  EXPECT_NE(xml.find("<error message=\"timed out after "), std::string::npos) << xml;
  expectRefusal(skitter({"validate", "--timeout", "0"}), 2, {"--timeout", "0"});
}

TEST_F(Validate, HelpListsTheExitCodes) {
  const std::string help = runProgram({SKITTER_BINARY, "validate", "--help"}).out;
  for (const char* words :
       {"Exit codes: 0 ", "1 a check failed", "2 wrong usage", "3 no usable", "130 interr"})
    EXPECT_NE(help.find(words), std::string::npos) << words << help;
}

}  // namespace
}  // namespace skitter::test
