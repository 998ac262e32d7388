#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "process.h"

namespace skitter::test {
namespace {

class JudgedRun : public AppTest {
 protected:
  // Four agents on flat ground, so far apart.
  void writeStanding(const std::string& spacing) const {
    write("standing.json", R"({"terrain": {"columns": 65, "rows": 65, "amplitude": 0}, "herds": [{"agents": 4,
      "spawn": {"kind": "grid", "spacing": )" +
                               spacing + R"(}, "goal": {"kind": "none"}}]})");
  }
  Result run(std::vector<std::string> more) const {
    std::vector<std::string> command = {
        "run", file("standing.json"), "--headless", "--frames", "100", "--quiet", "--json", file("run.json")};
    command.insert(command.end(), more.begin(), more.end());
    return skitter(command);
  }
};

TEST_F(JudgedRun, TellsInWordsWhatPeopleSeeThatIsWrong) {
  writeStanding("0.1");
  const std::string text = "herd 0 (spider): 4 of 4 agents are in each other, the first at tick 30; apart ";
  const Result told = run({});
  EXPECT_EQ(told.code, 0) << told.err;
  EXPECT_EQ(told.err.find("warning: " + text), 0u) << told.err;
  const nlohmann::json warnings = json("run.json").at("warnings");
  ASSERT_EQ(warnings.size(), 1u) << warnings;
  const nlohmann::json& warning = warnings.at(0);
  EXPECT_EQ(warning.size(), 6u) << warning;
  EXPECT_EQ(warning.at("law"), "apart");
  EXPECT_EQ(warning.at("herd"), 0);
  EXPECT_EQ(warning.at("agents"), 4);
  EXPECT_EQ(warning.at("firstTick"), 30);
  EXPECT_GT(warning.at("worst"), 0.05);
  EXPECT_EQ(warning.at("text").get<std::string>().find(text), 0u) << warning;

  const Result strict = run({"--strict"});
  EXPECT_EQ(strict.code, 1);
  EXPECT_NE(strict.err.find("skitter: laws of the visible world are broken: apart\n"), std::string::npos)
      << strict.err;
  EXPECT_FALSE(json("run.json").at("warnings").empty());
}

TEST_F(JudgedRun, IsQuietWhereNothingIsWrong) {
  writeStanding("2");
  const Result result = run({"--strict"});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  EXPECT_TRUE(json("run.json").at("warnings").empty());
}

TEST_F(JudgedRun, IsTheSameRunUnjudged) {
  writeStanding("0.1");
  EXPECT_EQ(run({}).code, 0);
  const nlohmann::json judged = json("run.json");
  const Result result = run({"--no-laws"});
  EXPECT_EQ(result.code, 0);
  EXPECT_EQ(result.err, "");
  EXPECT_TRUE(json("run.json").at("warnings").is_null());
  EXPECT_EQ(json("run.json").at("stateHash"), judged.at("stateHash"));
  EXPECT_EQ(json("run.json").at("fidelity"), judged.at("fidelity"));
  expectRefusal(run({"--no-laws", "--strict"}), 2, {"--strict", "--no-laws"});
}

TEST_F(JudgedRun, IsValidatedBesideTheStages) {
  writeStanding("0.1");
  const std::vector<std::string> command = {
      "validate", file("standing.json"), "--frames", "60",         "--stages", "ik",
      "--json",   file("v.json"),        "--junit",  file("v.xml")};
  const Result result = skitter(command);
  EXPECT_EQ(result.code, 0) << result.out << result.err;
  const nlohmann::json validation = json("v.json");
  EXPECT_TRUE(validation.at("pass"));
  bool isBroken = false;
  for (const nlohmann::json& law : validation.at("laws")) {
    EXPECT_EQ(law.at("pass"), law.at("name") != "apart") << law;
    isBroken |= law.at("name") == "apart";
  }
  EXPECT_TRUE(isBroken);
  std::ifstream in(file("v.xml"));
  const std::string xml(std::istreambuf_iterator<char>(in), {});
  EXPECT_NE(xml.find(": laws of the visible world\""), std::string::npos) << xml;
  EXPECT_NE(xml.find("<testcase classname=\"skitter.laws\" name=\"apart of herd 0\">\n            <failure "
                     "message=\"herd 0"),
            std::string::npos)
      << xml;
  std::vector<std::string> strict = command;
  strict.push_back("--strict");
  EXPECT_EQ(skitter(strict).code, 1);
}

}  // namespace
}  // namespace skitter::test
