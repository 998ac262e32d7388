#include <fmt/format.h>

#include <cstdio>
#include <fstream>
#include <set>
#include <utility>

#include "process.h"

namespace skitter::test {
namespace {

using Running = AppTest;

std::set<std::string> keysOf(const nlohmann::json& object) {
  std::set<std::string> keys;
  for (const auto& [key, value] : object.items()) keys.insert(key);
  return keys;
}

TEST_F(Running, CrowdingIsMeasuredWhereItIsAskedFor) {
  const auto crowdingOf = [&](const char* scene, const char* agents) {
    EXPECT_EQ(
        skitter({"run", std::string(SKITTER_ROOT "/assets/scenes/") + scene, "--headless", "--frames", "1200",
                 "--no-measure", "--crowding", "--json", file("run.json"), "--force", "--agents", agents})
            .code,
        0);
    return json("run.json").at("crowding");
  };
  const nlohmann::json avoiding = crowdingOf("head-on.json", "36");
  EXPECT_TRUE(avoiding.at("droppedNeighbours").is_number_unsigned());
  EXPECT_LT(avoiding.at("overlapMost"), 0.6);
  EXPECT_LT(avoiding.at("overlapMean"), 0.05);
  EXPECT_TRUE(avoiding.at("stuck").is_number_unsigned());
  EXPECT_EQ(avoiding.at("arrived"), 0) << "nobody goes to a place";
  EXPECT_GE(avoiding.at("legCrossings"), 0);
  EXPECT_LT(avoiding.at("legCrossings"), 1);
  EXPECT_LT(avoiding.at("jammed"), 0.5);
  EXPECT_GT(avoiding.at("pause"), 0);
  EXPECT_GT(avoiding.at("flow"), 0.1);
  const nlohmann::json jammed = crowdingOf("bottleneck.json", "150");
  EXPECT_GT(jammed.at("jammed"), 0.6);
  EXPECT_LT(jammed.at("legCrossings"), 0.01) << "legs have their room in a jam";
  EXPECT_LT(jammed.at("legCrossingsOutsideJams"), 0.005);
}

// Nobody comes to the second branch, at the edge.
TEST_F(Running, ForagersAreCounted) {
  std::ofstream(file("ants.json")) << R"({"terrain": {"columns": 65, "rows": 65, "amplitude": 0},
    "herds": [{"agents": 30, "goal": {"speed": 3}, "spawn": {"kind": "grid", "centre": [0, -3], "spacing": 0.5},
      "forage": {"nest": {"centre": [0, -3]}, "food": [{"centre": [0, 3], "radius": 3, "amount": 500}], "cell": 1,
                 "branches": [{"centre": [0, 0], "radius": 9}, {"centre": [15.8, 15.8], "radius": 0.1}], "rest": 0.2}}]})";
  ASSERT_EQ(skitter({"run", file("ants.json"), "--headless", "--frames", "900", "--no-measure", "--json",
                     file("run.json")})
                .code,
            0);
  const nlohmann::json herds = json("run.json").at("foraging");
  ASSERT_EQ(herds.size(), 1u);
  const nlohmann::json& ants = herds.at(0);
  EXPECT_EQ(keysOf(ants), (std::set<std::string>{"herd", "brought", "trips", "taken", "passed",
                                                 "shareOfFirst", "windows"}));
  EXPECT_GT(ants.at("brought"), 0);
  EXPECT_EQ(ants.at("shareOfFirst"), 1);
  // 15 seconds are a window and a half.
  ASSERT_EQ(ants.at("windows").size(), 2u);
  EXPECT_NEAR(ants.at("windows").at(0).at("until").get<double>(), 10, 0.05);
  EXPECT_NEAR(ants.at("windows").at(1).at("until").get<double>(), 15, 0.05);
  uint64_t brought = 0;
  for (const nlohmann::json& window : ants.at("windows")) brought += window.at("brought").get<uint64_t>();
  EXPECT_EQ(ants.at("brought"), brought);
}

// The first are through the gap and at their goal, and nobody is half in another.
TEST_F(Running, ABottleneckIsPassed) {
  const Result result =
      skitter({"run", SKITTER_ROOT "/assets/scenes/bottleneck.json", "--headless", "--frames", "1500",
               "--no-measure", "--crowding", "--json", file("run.json")});
  ASSERT_EQ(result.code, 0) << result.err;
  const nlohmann::json crowding = json("run.json").at("crowding");
  EXPECT_LT(crowding.at("overlapMost"), 0.5);
  EXPECT_GT(crowding.at("arrived"), 0);
  EXPECT_GT(crowding.at("flow"), 0.5);
}

TEST_F(Running, WhoCannotReachAGoalIsToldOnce) {
  struct Heard {
    std::string said;
    int counted = 0;  // in the JSON
  };
  const auto heard = [&](const std::string& obstacles, const std::string& events) {
    write("way.json", R"({"terrain": {"columns": 65, "rows": 65, "amplitude": 0}, "obstacles": [)" +
                          obstacles + R"(], "herds": [{"agents": 4, "ways": {},
      "spawn": {"kind": "grid", "centre": [0, -5]}, "goal": {"kind": "point", "target": [0, 5]}}],
      "events": [)" + events +
                          "]}");
    const Result result =
        skitter({"run", file("way.json"), "--headless", "--frames", "3", "--json", file("run.json")});
    EXPECT_EQ(result.code, 0) << result.err;
    return Heard{result.err, json("run.json").at("herds").at(0).at("cannotReach").get<int>()};
  };
  const std::string told = "herd 0: no way leads 4 of 4 agents to their goals";
  const std::string wall = R"({"capsule": {"from": [-16, 0], "to": [16, 0]}})",
                    beside = R"({"capsule": {"from": [-16, 9], "to": [16, 9]}})",
                    away = R"({"at": 0, "goal": {"kind": "point", "target": [0, 12]}})";
  // From the beginning, and by what happens to them.
  for (const Heard& each : {heard(wall, ""), heard(beside, away)}) {
    EXPECT_NE(each.said.find(told), std::string::npos) << each.said;
    EXPECT_EQ(each.said.find(told), each.said.rfind(told));
    EXPECT_EQ(each.counted, 4);
  }
  for (const Heard& each : {heard("", ""), heard("", away)}) {
    EXPECT_EQ(each.said.find("no way"), std::string::npos) << each.said;
    EXPECT_EQ(each.counted, 0);
  }
}

TEST_F(Running, JsonHasTheDocumentedFields) {
  const Result result = skitter({"run", "--headless", "--agents", "20", "--frames", "30", "--seed", "7",
                                 "--json", file("run.json"), "--timings"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(files(), std::vector<std::string>{"run.json"});
  const nlohmann::json run = json("run.json");
  EXPECT_EQ(keysOf(run), (std::set<std::string>{"device",
                                                "agents",
                                                "ticks",
                                                "seed",
                                                "tickMilliseconds",
                                                "cpuMicrosecondsPerAgentTick",
                                                "watchEvery",
                                                "fidelity",
                                                "crowding",
                                                "foraging",
                                                "damage",
                                                "reactions",
                                                "searches",
                                                "herds",
                                                "levels",
                                                "warnings",
                                                "sleeping",
                                                "stateHash",
                                                "ticksWanted",
                                                "interrupted",
                                                "manifest",
                                                "resumedAt"}));
  EXPECT_TRUE(run.at("foraging").empty()) << "nobody does";
  EXPECT_TRUE(run.at("damage").is_null()) << "nobody is hurt";
  EXPECT_TRUE(run.at("sleeping").is_null()) << "nobody may";
  EXPECT_TRUE(run.at("resumedAt").is_null()) << "it began at the start";
  EXPECT_EQ(keysOf(run.at("crowding")),
            (std::set<std::string>{"overlapMost", "overlapMean", "stuck", "arrived", "legCrossings",
                                   "legCrossingsOutsideJams", "jammed", "flow", "pause", "pairs",
                                   "droppedNeighbours"}));
  for (const nlohmann::json& figure : run.at("crowding")) EXPECT_TRUE(figure.is_null()) << "not asked for";
  EXPECT_EQ(run.at("agents"), 20);
  EXPECT_EQ(run.at("ticks"), 30);
  EXPECT_EQ(run.at("ticksWanted"), 30);
  EXPECT_FALSE(run.at("interrupted"));
  EXPECT_EQ(run.at("seed"), 7);
  const nlohmann::json& tick = run.at("tickMilliseconds");
  EXPECT_EQ(keysOf(tick), (std::set<std::string>{"min", "median", "max"}));
  EXPECT_GT(tick.at("min"), 0);
  EXPECT_LE(tick.at("min"), tick.at("median"));
  EXPECT_LE(tick.at("median"), tick.at("max"));
  EXPECT_GT(run.at("cpuMicrosecondsPerAgentTick"), 0);
  EXPECT_EQ(keysOf(run.at("fidelity")), (std::set<std::string>{"agentTicks",
                                                               "stances",
                                                               "slip",
                                                               "skating",
                                                               "penetration",
                                                               "penetrationBeyond",
                                                               "float",
                                                               "floatBeyond",
                                                               "segmentPenetration",
                                                               "segmentPenetrationMost",
                                                               "crossing",
                                                               "reachErrorP99",
                                                               "reachErrorMost",
                                                               "limitViolation",
                                                               "limitViolations",
                                                               "footJerk",
                                                               "bodyJerk",
                                                               "margin",
                                                               "marginLeast",
                                                               "unstable",
                                                               "lastResorts",
                                                               "notFinite"}));
  EXPECT_EQ(run.at("watchEvery"), 1);
  EXPECT_EQ(run.at("fidelity").at("agentTicks"), 20 * 30);
  ASSERT_EQ(run.at("herds").size(), 1u);
  EXPECT_EQ(keysOf(run.at("herds")[0]),
            (std::set<std::string>{"number", "rig", "agents", "cannotReach", "fidelity"}));
  EXPECT_EQ(run.at("herds")[0].at("agents"), 20);
  EXPECT_EQ(run.at("herds")[0].at("cannotReach"), 0);
  EXPECT_EQ(run.at("herds")[0].at("fidelity"), run.at("fidelity"));
  EXPECT_EQ(run.at("stateHash").get<std::string>().size(), 16u);
  for (const char* word : {"device", "agents", "median", "state hash", "slip"}) {
    EXPECT_NE(result.out.find(word), std::string::npos) << word;
  }
}

TEST_F(Running, ListsTheHerdsThatAreThere) {
  write("scene.json", R"({"herds": [{"agents": 3}, {"agents": 2, "controller": "loop"}], "events": [
    {"at": 0.1, "removeHerd": 0}, {"at": 0.2, "addHerd": {"agents": 4}},
    {"at": 0.3, "addHerd": {"agents": 5, "controller": "loop"}}, {"at": 0.4, "removeHerd": 1}]})");
  const auto herdsAfter = [&](const char* frames) {
    const Result result =
        skitter({"run", file("scene.json"), "--headless", "--frames", frames, "--json", file("run.json"),
                 "--footfalls", file("feet.csv"), "--out", file("run.png"), "--size", "64x48"});
    EXPECT_EQ(result.code, 0) << result.err;
    std::vector<std::pair<int, int>> herds;
    if (result.code != 0) return herds;
    const nlohmann::json written = json("run.json");
    for (const nlohmann::json& herd : written.at("herds")) {
      herds.emplace_back(herd.at("number").get<int>(), herd.at("agents").get<int>());
      EXPECT_NE(result.out.find(fmt::format("herd {}: ", herds.back().first)), std::string::npos);
    }
    return herds;
  };
  using Herds = std::vector<std::pair<int, int>>;
  EXPECT_EQ(herdsAfter("20"), (Herds{{0, 4}, {1, 2}, {2, 5}}));
  EXPECT_EQ(herdsAfter("30"), (Herds{{0, 4}, {2, 5}}));
  expectRefusal(skitter({"run", file("scene.json"), "--headless", "--frames", "2", "--trace", file("trace")}),
                2, {"--trace", "events[0] of scene adds or removes a herd"});
}

// Those that stand sleep, those that walk do not.
TEST_F(Running, SleepersAreReported) {
  write("some.json",
        R"({"herds": [{"agents": 3}, {"agents": 5, "controller": "loop", "goal": {"kind": "none"}}]})");
  const Result result = skitter({"run", file("some.json"), "--headless", "--sleep", "--frames", "240",
                                 "--json", file("some-run.json")});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(json("some-run.json").at("sleeping"), 5);
  EXPECT_NE(result.out.find("5 agents at the end"), std::string::npos) << result.out;
}

// A clip's poses are not made within the rig's limits.
TEST_F(Running, JudgesNoLimitsOfClips) {
  const Result result = skitter({"run", "--headless", "--agents", "2", "--frames", "2", "--controller",
                                 "clip", "--json", file("run.json")});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_NE(result.out.find("limits      not judged"), std::string::npos) << result.out;
  EXPECT_TRUE(json("run.json").at("fidelity").at("limitViolation").is_null());
  EXPECT_TRUE(json("run.json").at("fidelity").at("limitViolations").is_null());
}

TEST_F(Running, WritesEveryFootfall) {
  const Result result = skitter({"run", "--headless", "--agents", "3", "--frames", "90", "--watch-every", "2",
                                 "--footfalls", file("feet.csv"), "--json", file("run.json")});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(json("run.json").at("watchEvery"), 2);
  std::ifstream lines(file("feet.csv"));
  std::string line;
  std::getline(lines, line);
  const std::string manifest = "# manifest: ";
  ASSERT_EQ(line.substr(0, manifest.size()), manifest);
  EXPECT_EQ(nlohmann::json::parse(line.substr(manifest.size())), json("run.json").at("manifest"));
  std::getline(lines, line);
  EXPECT_EQ(line, "herd,agent,leg,tick,seconds,x,y,z,speed");
  int count = 0, last = 0;
  for (; std::getline(lines, line); ++count) {
    int herd = -1, agent = -1, leg = -1, tick = -1;
    ASSERT_EQ(std::sscanf(line.c_str(), "%d,%d,%d,%d", &herd, &agent, &leg, &tick), 4) << line;
    EXPECT_EQ(herd, 0);
    EXPECT_LT(agent, 3);
    EXPECT_LT(leg, 8);
    EXPECT_GE(tick, last);
    last = tick;
  }
  EXPECT_GT(count, 3 * 8);
}

TEST_F(Running, QuietAndShortRunsSayNothingOnStderr) {
  const Result result = skitter({"run", "--headless", "--agents", "1", "--frames", "2", "--quiet"});
  EXPECT_EQ(result.code, 0);
  EXPECT_EQ(result.err, "");
}

TEST_F(Running, NoAgentsAndNoFramesAreLegal) {
  ASSERT_EQ(
      skitter({"run", "--headless", "--agents", "0", "--frames", "5", "--json", file("agents.json")}).code,
      0);
  EXPECT_EQ(json("agents.json").at("agents"), 0);
  EXPECT_EQ(json("agents.json").at("fidelity").at("limitViolation"), 0)
      << "limits are kept, though by nobody";
  EXPECT_EQ(json("agents.json").at("ticks"), 5);
  EXPECT_TRUE(json("agents.json").at("cpuMicrosecondsPerAgentTick").is_null());

  ASSERT_EQ(
      skitter({"run", "--headless", "--agents", "3", "--frames", "0", "--json", file("frames.json")}).code,
      0);
  EXPECT_EQ(json("frames.json").at("ticks"), 0);
  EXPECT_TRUE(json("frames.json").at("tickMilliseconds").at("median").is_null());
}

TEST_F(Running, AgentsScalesEveryHerd) {
  write("two.json", R"({"herds": [{"agents": 10}, {"agents": 20}]})");
  ASSERT_EQ(skitter({"run", file("two.json"), "--headless", "--agents", "5", "--frames", "1", "--json",
                     file("run.json")})
                .code,
            0);
  EXPECT_EQ(json("run.json").at("agents"), 15);
}

TEST_F(Running, TicksPerFrame) {
  ASSERT_EQ(skitter({"run", "--headless", "--agents", "1", "--frames", "3", "--ticks-per-frame", "4",
                     "--json", file("run.json")})
                .code,
            0);
  EXPECT_EQ(json("run.json").at("ticks"), 12);
}

}  // namespace
}  // namespace skitter::test
