#include <csignal>
#include <fstream>
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
  EXPECT_GT(table.at("gaits").size(), 57u);
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
