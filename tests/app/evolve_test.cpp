#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "process.h"

namespace skitter::test {
namespace {

// Searches so small that their gaits mean nothing.
struct Evolve : AppTest {
  Result evolve(const std::string& table, const std::string& evaluations, std::vector<std::string> more = {},
                const std::function<void(int)>& whileRunning = {}) const {
    std::vector<std::string> arguments = {"evolve",        "--out",     file(table),
                                          "--evaluations", evaluations, "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return skitter(arguments, {}, whileRunning);
  }
  std::string text(const std::string& name) const {
    std::ifstream in(file(name), std::ios::binary);
    std::stringstream all;
    all << in.rdbuf();
    return all.str();
  }
};
const std::vector<std::string> coarse = {"--batch", "128", "--dt", "0.05"};

TEST_F(Evolve, WritesATableAndAMapToTheSameBytes) {
  ASSERT_EQ(evolve("a.gaits.json", "200", coarse).code, 0);
  ASSERT_EQ(evolve("b.gaits.json", "256", coarse).code, 0);
  EXPECT_EQ(files(), (std::vector<std::string>{"a.gaits.json", "a.gaits.map.json", "b.gaits.json",
                                               "b.gaits.map.json"}));
  EXPECT_EQ(text("a.gaits.json"), text("b.gaits.json"));
  EXPECT_EQ(text("a.gaits.map.json"), text("b.gaits.map.json"));
  const nlohmann::json table = json("a.gaits.json");
  EXPECT_EQ(table.at("found").at("evaluations"), 256);
  EXPECT_EQ(table.at("found").at("patterns"), 114);
  EXPECT_GT(table.at("found").at("judged").at("speed"), 0.2);
}

TEST_F(Evolve, ATableHasTheGaitsThatAreWorthMoreThanTheRules) {
  const std::vector<std::string> more = {"--batch", "1024", "--dt", "0.05", "--json", file("figures.json")};
  ASSERT_EQ(evolve("a.gaits.json", "4096", more).code, 0);
  std::set<nlohmann::json> inTable, better;
  const nlohmann::json table = json("a.gaits.json");
  for (const nlohmann::json& gait : table.at("gaits")) inTable.insert(gait.at("without"));
  const auto worth = [](const nlohmann::json& judged) {
    return std::min(1.0, judged.at("speed").get<double>() / 1.5) * (1 - judged.at("unstable").get<double>());
  };
  const nlohmann::json candidates = json("figures.json").at("candidates");
  const auto isNoLessStable = [](const nlohmann::json& found, const nlohmann::json& byRule) {
    return found.at("unstable").get<double>() <= byRule.at("unstable").get<double>();
  };
  for (const nlohmann::json& each : candidates)
    if (isNoLessStable(each.at("found"), each.at("byRule")) &&
        worth(each.at("found")) >= worth(each.at("byRule")) + 0.01)
      better.insert(each.at("without"));
  EXPECT_EQ(inTable, better);
  EXPECT_GT(inTable.size(), 0u);
  EXPECT_LT(inTable.size(), candidates.size());
}

TEST_F(Evolve, TheTableOfARigIsJudgedForEachPattern) {
  for (const char* name : {"quadruped.glb", "quadruped.rig.json"})
    std::filesystem::copy_file(std::filesystem::path(SKITTER_ROOT) / "assets" / name, file(name));
  const std::vector<std::string> rig = {"--rig", file("quadruped.glb"), "--dt", "0.05"};
  std::vector<std::string> more = rig;
  more.insert(more.end(), {"--batch", "512"});
  ASSERT_EQ(evolve("quadruped.gaits.json", "1024", more).code, 0);
  std::set<nlohmann::json> searched;
  const nlohmann::json table = json("quadruped.gaits.json");
  for (const nlohmann::json& gait : table.at("gaits")) searched.insert(gait.at("without"));
  ASSERT_FALSE(searched.empty());
  std::vector<std::string> arguments = {"evolve", "--judge", "--json", file("judged.json")};
  arguments.insert(arguments.end(), rig.begin(), rig.end());
  const Result judged = skitter(arguments);
  ASSERT_EQ(judged.code, 0) << judged.err;
  EXPECT_NE(judged.out.find("without 1      4 patterns"), std::string::npos) << judged.out;
  EXPECT_NE(judged.out.find("; unadapted "), std::string::npos) << judged.out;
  const nlohmann::json figures = json("judged.json");
  const double intact = figures.at("intact").at("speed");
  EXPECT_GT(intact, 1);
  size_t inTable = 0;
  for (const nlohmann::json& each : figures.at("judgedPatterns")) {
    EXPECT_NEAR(each.at("byTable").at("speedKept"), each.at("byTable").at("speed").get<double>() / intact,
                1e-12);
    if (!each.at("inTable").get<bool>()) {
      EXPECT_EQ(each.at("byTable"), each.at("byRule"));
    }
    inTable += each.at("inTable").get<bool>();
    EXPECT_EQ(each.at("unadapted").size(), each.at("byRule").size());
  }
  EXPECT_EQ(figures.at("judgedPatterns").size(), 4u);
  EXPECT_EQ(inTable, 2 * searched.size()) << "each with its mirror image";
  expectRefusal(skitter({"evolve", "--judge", "--seed", "3"}), 2, {"--judge", "--seed"});
}

TEST_F(Evolve, GoesOnToTheSameBytes) {
  ASSERT_EQ(evolve("whole.gaits.json", "384", coarse).code, 0);
  ASSERT_EQ(evolve("parts.gaits.json", "128", coarse).code, 0);
  EXPECT_NE(text("whole.gaits.map.json"), text("parts.gaits.map.json"));
  const Result again = evolve("parts.gaits.json", "384", coarse);
  expectRefusal(again, 2, {"parts.gaits.map.json", "--resume", "--force"});
  expectRefusal(evolve("parts.gaits.json", "384", {"--resume", "--seed", "3"}), 2, {"--seed", "--resume"});
  ASSERT_EQ(evolve("parts.gaits.json", "384", {"--resume"}).code, 0);
  EXPECT_EQ(text("whole.gaits.json"), text("parts.gaits.json"));
  EXPECT_EQ(text("whole.gaits.map.json"), text("parts.gaits.map.json"));
  ASSERT_EQ(
      evolve("parts.gaits.json", "128", {"--force", "--batch", "128", "--dt", "0.05", "--seed", "3"}).code,
      0);
  EXPECT_NE(text("whole.gaits.json"), text("parts.gaits.json"));
}

TEST_F(Evolve, ItsFiguresAreJson) {
  std::vector<std::string> more = coarse;
  more.insert(more.end(), {"--json", file("figures.json")});
  ASSERT_EQ(evolve("a.gaits.json", "128", more).code, 0);
  const nlohmann::json figures = json("figures.json");
  EXPECT_EQ(figures.at("evaluationsNow"), 128);
  EXPECT_GT(figures.at("seconds"), 0);
  EXPECT_EQ(figures.at("cells"), 114 * 64);
  EXPECT_TRUE(figures.contains("manifest"));
}

TEST_F(Evolve, AnInterruptedSearchLeavesItsMap) {
  bool sent = false;
  const Result stopped = evolve("a.gaits.json", "100000000", coarse, [&](int process) {
    if (sent || !catches(process, SIGINT)) return;
    sent = kill(process, SIGINT) == 0;
  });
  EXPECT_EQ(stopped.code, 130);
  EXPECT_NE(stopped.err.find("of 100000000 evaluations"), std::string::npos) << stopped.err;
  for (const std::string& name : files()) EXPECT_EQ(name.find(".part"), std::string::npos) << name;
}

TEST_F(Evolve, RefusesWhatCannotBe) {
  expectRefusal(evolve("a.txt", "10"), 2, {"--out", ".gaits.json"});
  expectRefusal(evolve("a.gaits.json", "10", {"--resume"}), 2, {"a.gaits.map.json"});
  expectRefusal(evolve("a.gaits.json", "10", {"--rig", file("none.glb")}), 2, {"none.glb"});
  write("a.gaits.map.json", "{}");
  expectRefusal(evolve("a.gaits.json", "10", {"--resume"}), 2, {"a.gaits.map.json", "version is missing"});
}

}  // namespace
}  // namespace skitter::test
