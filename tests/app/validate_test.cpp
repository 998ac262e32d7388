#include <map>

#include "process.h"

namespace skitter::test {
namespace {

using Validate = AppTest;

TEST_F(Validate, EveryStageAgreesWithTheReference) {
  const Result result =
      skitter({"validate", "--agents", "16", "--frames", "30", "--seed", "5", "--json", file("v.json")});
  EXPECT_EQ(result.code, 0) << result.out << result.err;
  EXPECT_NE(result.out.find("seed 5"), std::string::npos);
  const nlohmann::json validation = json("v.json");
  EXPECT_TRUE(validation.at("pass"));
  EXPECT_TRUE(validation.at("device").is_string());
  std::vector<std::string> names;
  for (const nlohmann::json& stage : validation.at("stages")) {
    names.push_back(stage.at("name"));
    EXPECT_TRUE(stage.at("pass"));
    EXPECT_GT(stage.at("samples"), 0) << names.back();
    EXPECT_LE(stage.at("maxError"), stage.at("tolerance")) << names.back();
    EXPECT_TRUE(stage.at("ties").is_number_unsigned());
  }
  EXPECT_EQ(names, (std::vector<std::string>{"navigate", "body", "gait", "foothold", "swing", "ik", "pose",
                                             "measure", "footfall"}));
}

std::vector<std::string> stagesThatAgree(const nlohmann::json& validation) {
  std::vector<std::string> names;
  for (const nlohmann::json& stage : validation.at("stages")) {
    names.push_back(stage.at("name"));
    EXPECT_TRUE(stage.at("pass")) << names.back();
    EXPECT_GT(stage.at("samples"), 0) << names.back();
  }
  return names;
}

TEST_F(Validate, EveryControllerHasItsStages) {
  const std::map<std::string, std::vector<std::string>> stages = {
      {"loop", {"navigate", "body", "gait", "swing", "ik", "pose", "measure", "footfall"}},
      {"clip", {"navigate", "body", "clip", "swing", "pose", "measure", "footfall"}},
      {"planted", {"navigate", "body", "clip", "swing", "ik", "pose", "measure", "footfall"}},
      {"pose", {"navigate", "body", "gait", "swing", "pose", "measure", "footfall"}}};
  for (const auto& [controller, names] : stages) {
    SCOPED_TRACE(controller);
    const Result result = skitter({"validate", "--controller", controller, "--agents", "8", "--frames", "20",
                                   "--json", file("v.json")});
    EXPECT_EQ(result.code, 0) << result.out << result.err;
    EXPECT_EQ(stagesThatAgree(json("v.json")), names);
  }
}

TEST_F(Validate, HerdsWithDifferentStagesAreOneTable) {
  write("mixed.json", R"({"terrain": {"kind": "noise"}, "herds": [
    {"rig": "spider", "controller": "clip", "agents": 4},
    {"rig": "spider", "controller": "adaptive", "agents": 4}]})");
  const Result result = skitter({"validate", file("mixed.json"), "--frames", "20", "--json", file("v.json")});
  EXPECT_EQ(result.code, 0) << result.out << result.err;
  EXPECT_EQ(stagesThatAgree(json("v.json")),
            (std::vector<std::string>{"navigate", "body", "clip", "gait", "foothold", "swing", "ik", "pose",
                                      "measure", "footfall"}));
}

TEST_F(Validate, AFreeRunStaysTogether) {
  const Result result =
      skitter({"validate", "--agents", "8", "--frames", "120", "--free-run", "--json", file("v.json")});
  EXPECT_EQ(result.code, 0) << result.out << result.err;
  EXPECT_NE(result.out.find("free run: "), std::string::npos) << result.out;
  EXPECT_GE(json("v.json").at("freeRunShare"), 0.75);
}

TEST_F(Validate, AFreeRunIsOfAdaptiveHerds) {
  const Result result = skitter({"validate", "--controller", "loop", "--frames", "2", "--free-run"});
  EXPECT_EQ(result.code, 2) << result.out;
  EXPECT_NE(result.err.find("adaptive"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace skitter::test
