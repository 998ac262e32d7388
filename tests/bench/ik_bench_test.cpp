#include "app/process.h"

// The program as its users run it; nothing here depends on how fast it is.
namespace skitter::test {
namespace {

struct IkBench : AppTest {
  Result bench(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), SKITTER_BINARY);
    if (const char* device = std::getenv("SKITTER_TEST_DEVICE")) {
      arguments.insert(arguments.end(), {"--device", device});
    }
    return runProgram(arguments);
  }
};

#if defined(SKITTER_DEBUG_BUILD)

TEST_F(IkBench, RefusesADebugBuild) {
  const Result result = bench({"--quick"});
  EXPECT_EQ(result.code, 2);
  EXPECT_NE(result.err.find("debug build"), std::string::npos) << result.err;
}

#else

void expectShare(const nlohmann::json& value) {
  EXPECT_GE(value.get<double>(), 0);
  EXPECT_LE(value.get<double>(), 1);
}

void expectContestant(const nlohmann::json& of) {
  EXPECT_GT(of.at("solvesPerCoreSecond").get<double>(), 0);
  EXPECT_GT(of.at("solvesPerWallSecond").get<double>(), 0);
  EXPECT_GE(of.at("p99Iterations").get<double>() + 1, of.at("meanIterations").get<double>());
  expectShare(of.at("solvedShare"));
  double stops = 0;
  for (const auto& [name, share] : of.at("stops").items()) stops += share.get<double>();
  EXPECT_NEAR(stops, 1, 1e-9);
}

TEST_F(IkBench, QuickRunTellsAllInItsJson) {
  const Result result = bench({"--quick", "--chains", "256", "--repetitions", "1", "--rows",
                               "tracking/cone60", "--json", file("figures.json")});
  ASSERT_EQ(result.code, 0) << result.out << result.err;
  const nlohmann::json figures = json("figures.json");
  for (const char* key : {"device", "driver", "cpu", "engineBuild", "cpuOpponentBuild"}) {
    EXPECT_NE(figures.at(key).get<std::string>(), "") << key;
  }
  EXPECT_EQ(figures.at("chains"), 256);
  bool compared = false;
  for (const nlohmann::json& row : figures.at("rows")) {
    SCOPED_TRACE(row.at("row").get<std::string>());
    expectContestant(row.at("device"));
    if (!row.contains("scalar")) continue;
    compared = true;
    expectContestant(row.at("scalar"));
    expectContestant(row.at("simd"));
    EXPECT_GT(row.at("deviceOverScalar").get<double>(), 0);
    EXPECT_GT(row.at("deviceOverSimd").get<double>(), 0);
    // The same targets and the same solver: the same share is solved.
    EXPECT_NEAR(row.at("device").at("solvedShare").get<double>(), row.at("scalar").at("solvedShare"), 0.05);
  }
  EXPECT_TRUE(compared);
}

TEST_F(IkBench, Table1HasEverySolver) {
  const Result result = bench({"--quick", "--table1", "--json", file("table1.json")});
  ASSERT_EQ(result.code, 0) << result.out << result.err;
  const nlohmann::json table = json("table1.json");
  EXPECT_EQ(table.at("table1").size(), 7u);
  for (const nlohmann::json& row : table.at("table1")) {
    SCOPED_TRACE(row.at("solver").get<std::string>());
    EXPECT_EQ(row.at("reachable").at("withinToleranceShare"), 1);
    EXPECT_EQ(row.at("unreachable").at("meanIterations"), 1);  // the reach test
  }
  EXPECT_EQ(table.at("caliko").size(), 2u);
}

TEST_F(IkBench, FiguresAreWrittenInBothReadings) {
  const Result result = bench({"--quick", "--figures", file("figures")});
  ASSERT_EQ(result.code, 0) << result.out << result.err;
  const std::vector<std::string> expected = {"figures/accuracy-factors.csv", "figures/accuracy-steps.csv",
                                             "figures/both-factors.csv",     "figures/both-steps.csv",
                                             "figures/instances.csv",        "figures/iterations-factors.csv",
                                             "figures/iterations-steps.csv"};
  EXPECT_EQ(files(), expected);
}

TEST_F(IkBench, RefusesWhatItCannotDo) {
  EXPECT_EQ(bench({"--rows", "no-such-row"}).code, 2);
  EXPECT_EQ(bench({"--chains", "-5"}).code, 2);
  EXPECT_EQ(bench({"--walk"}).code, 2);
  EXPECT_EQ(bench({"--quick", "--json", file("none/figures.json")}).code, 2);
  EXPECT_EQ(bench({"--help"}).code, 0);
}

#endif

}  // namespace
}  // namespace skitter::test
