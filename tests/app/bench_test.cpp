#include "process.h"

namespace skitter::test {
namespace {

using Bench = AppTest;

TEST_F(Bench, TimesAndChecksEveryContestant) {
  const Result result =
      skitter({"bench", "--quick", "--rounds", "1", "--agents", "1,33", "--json", file("b.json")});
  ASSERT_EQ(result.code, 0) << result.out << result.err;
  const nlohmann::json device = json("b.json").at("devices").at(0), manifest = json("b.json").at("manifest");
  for (const auto& [name, value] : manifest.items()) EXPECT_FALSE(value.is_null()) << name;
  // With what follows them, for the scalar ones begin as the others do.
  for (const std::string flags : {SKITTER_SIMD_FLAGS "; scalar ", SKITTER_SCALAR_FLAGS "; "}) {
    EXPECT_NE(device.at("cpuOpponentBuild").get<std::string>().find(flags), std::string::npos) << flags;
    EXPECT_NE(result.out.find(flags), std::string::npos) << result.out;
  }
  EXPECT_GT(device.at("copyBytesPerSecond"), 0);
  EXPECT_GT(device.at("operationsPerSecond"), 0);
  ASSERT_EQ(device.at("matches").size(), 4u);  // two controllers, two sizes
  for (const nlohmann::json& match : device.at("matches")) {
    SCOPED_TRACE(match.at("controller").get<std::string>());
    EXPECT_EQ(match.at("results").at(0).at("name"), "device");
    for (const nlohmann::json& contestant : match.at("results")) {
      EXPECT_GT(contestant.at("wallMilliseconds").at("median"), 0);
      for (const nlohmann::json& check : contestant.at("checks")) EXPECT_TRUE(check.at("pass")) << check;
      EXPECT_FALSE(contestant.at("stages").empty());
    }
    for (const nlohmann::json& demand : match.at("demands")) EXPECT_GE(demand.at("bytes"), 0);
  }
  const nlohmann::json& adaptive = device.at("matches").at(1);
  EXPECT_EQ(adaptive.at("controller"), "adaptive");
  EXPECT_EQ(adaptive.at("agents"), 33);
  EXPECT_GE(adaptive.at("results").size(), 3u);  // the device, and the CPU vectorised and scalar
}

TEST_F(Bench, RefusesWhatCannotBeTimed) {
  for (const std::vector<std::string>& wrong : {std::vector<std::string>{"--agents", "1.5"},
                                                {"--agents", "0"},
                                                {"--controllers", "magic"},
                                                {"--rounds", "0"}}) {
    std::vector<std::string> arguments = {"bench", "--quick"};
    arguments.insert(arguments.end(), wrong.begin(), wrong.end());
    const Result result = skitter(arguments);
    EXPECT_EQ(result.code, 2) << wrong[0] << ": " << result.out << result.err;
    EXPECT_NE(result.err.find(wrong[1]), std::string::npos) << result.err;
  }
}

TEST_F(Bench, RefusesToTimeUnderTheValidationLayer) {
  const Result result =
      skitter({"bench", "--quick"}, {{"VK_INSTANCE_LAYERS", "VK_LAYER_KHRONOS_validation"}});
  expectRefusal(result, 2, {"VK_INSTANCE_LAYERS", "validation"});
}

}  // namespace
}  // namespace skitter::test
