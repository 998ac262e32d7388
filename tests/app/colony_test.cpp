#include <set>

#include "process.h"

// The command that judges the paths of scouts.
namespace skitter::test {
namespace {

struct ColonyCommand : AppTest {
  // `skitter colony ...` with figures in c.json, which are returned.
  nlohmann::json search(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "colony");
    arguments.insert(arguments.end(), {"--json", file("c.json")});
    const Result result = skitter(arguments);
    EXPECT_EQ(result.code, 0) << result.err;
    return result.code == 0 ? json("c.json") : nlohmann::json();
  }
  void expectError(std::vector<std::string> arguments, const std::vector<std::string>& words) const {
    SCOPED_TRACE(::testing::PrintToString(arguments));
    arguments.insert(arguments.begin(), "colony");
    expectRefusal(skitter(arguments), 2, words);
    EXPECT_EQ(files(), std::vector<std::string>{});
  }
};

TEST_F(ColonyCommand, HoldsPathsAgainstTheShortest) {
  const nlohmann::json found = search({"--seeds", "3", "--side", "32", "--iterations", "20", "--quiet"});
  EXPECT_EQ(found.at("runs"), 3);
  EXPECT_EQ(found.at("runsWanted"), 3);
  EXPECT_FALSE(found.at("interrupted"));
  EXPECT_EQ(found.at("rule"), "mmas");
  EXPECT_EQ(found.at("ants"), 64);
  EXPECT_EQ(found.at("iterations"), 20);
  EXPECT_EQ(found.at("side"), 32);
  EXPECT_EQ(found.at("manifest").at("seed"), 1);
  ASSERT_EQ(found.at("each").size(), 3u);
  std::set<int> maps;
  double worst = 0;
  for (const nlohmann::json& run : found.at("each")) {
    maps.insert(run.at("map").get<int>());
    EXPECT_EQ(run.at("seed"), 1);
    // 28 cells apart, of which each costs 1 at least.
    EXPECT_GE(run.at("shortest"), 28 * 512);
    EXPECT_GE(run.at("length"), run.at("shortest"));
    const double ratio = run.at("length").get<double>() / run.at("shortest").get<double>();
    EXPECT_NEAR(run.at("ratio").get<double>(), ratio, 1e-12);
    worst = std::max(worst, ratio);
    EXPECT_GE(run.at("iteration"), 1);
    EXPECT_LE(run.at("iteration"), 20);
    EXPECT_GT(run.at("searchMilliseconds"), 0);
  }
  EXPECT_EQ(maps, (std::set<int>{1, 2, 3}));
  EXPECT_NEAR(found.at("ratio").at("max").get<double>(), worst, 1e-12);
  EXPECT_LE(found.at("ratio").at("median"), worst);
  EXPECT_LE(found.at("asShort"), 3);
  EXPECT_EQ(found.at("notArrived"), 0);
  EXPECT_EQ(found.at("withoutWay"), 0);
  for (const char* time : {"makeMilliseconds", "searchMilliseconds"}) {
    EXPECT_GT(found.at(time).at("min"), 0) << time;
    EXPECT_LE(found.at(time).at("median"), found.at(time).at("max")) << time;
  }
}

TEST_F(ColonyCommand, TriesOneMapBySeveralSeeds) {
  const std::vector<std::string> arguments = {"--map",        "5", "--seeds", "2",   "--side", "32",
                                              "--iterations", "3", "--rule",  "acs", "--ants", "5",
                                              "--passes",     "0", "--least", "0.01"};
  const nlohmann::json found = search(arguments), again = search(arguments);
  EXPECT_EQ(found.at("rule"), "acs");
  EXPECT_TRUE(found.at("manifest").at("seed").is_null());
  for (int n = 0; n < 2; ++n) {
    const nlohmann::json &run = found.at("each").at(n), &same = again.at("each").at(n);
    EXPECT_EQ(run.at("map"), 5);
    EXPECT_EQ(run.at("seed"), n + 1);
    EXPECT_EQ(run.at("length"), same.at("length"));
    EXPECT_EQ(run.at("shortest"), found.at("each").at(0).at("shortest"));
  }
}

// One scout that goes once does not find the way around map 3, of 206 cells in place of 115.
TEST_F(ColonyCommand, FailsWherePathsAreTooLong) {
  const std::vector<std::string> once = {"colony", "--map",  "3", "--seeds",  "1", "--iterations",
                                         "1",      "--ants", "1", "--passes", "0", "--fail-above"};
  const auto codeFor = [&](const char* limit) {
    std::vector<std::string> arguments = once;
    arguments.emplace_back(limit);
    const Result result = skitter(arguments);
    EXPECT_EQ(result.code == 1, result.err.find("longer than the shortest") != std::string::npos)
        << result.err;
    return result.code;
  };
  EXPECT_EQ(codeFor("0"), 1);
  EXPECT_EQ(codeFor("1000000,0"), 1);
}

TEST_F(ColonyCommand, RefusesWhatCannotBe) {
  expectError({"--seeds", "0"}, {"--seeds", "0"});
  expectError({"--side", "15"}, {"--side", "15"});
  expectError({"--ants", "4097"}, {"--ants", "4097"});
  expectError({"--rule", "ants"}, {"--rule", "ants", "mmas"});
  expectError({"--least", "1"}, {"--least"});
  expectError({"--fail-above", "-1"}, {"--fail-above"});
  expectError({"--json", file("none/c.json")}, {"--json", "none"});
}

}  // namespace
}  // namespace skitter::test
