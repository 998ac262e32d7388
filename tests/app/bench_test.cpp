#include <fstream>
#include <iterator>

#include "process.h"

namespace skitter::test {
namespace {

using Bench = AppTest;

std::string documentOf(const std::string& name) {
  std::ifstream in(std::string(SKITTER_ROOT "/docs/") + name);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

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

TEST_F(Bench, TimesGridAndAvoidByThemselves) {
  const Result result = skitter(
      {"bench", "--avoid", "--quick", "--rounds", "1", "--agents", "64,300", "--json", file("a.json")});
  ASSERT_EQ(result.code, 0) << result.out << result.err;
  const nlohmann::json device = json("a.json").at("devices").at(0);
  EXPECT_TRUE(device.at("matches").empty());
  ASSERT_EQ(device.at("avoidMatches").size(), 2u);
  for (const nlohmann::json& match : device.at("avoidMatches")) {
    SCOPED_TRACE(match.at("agents").get<int>());
    EXPECT_GT(match.at("inReach"), 4);
    EXPECT_GT(match.at("inReach"), match.at("keptClear"));
    EXPECT_GT(match.at("density"), 0.1);
    EXPECT_EQ(match.at("results").at(0).at("name"), "device");
    for (const nlohmann::json& contestant : match.at("results")) {
      EXPECT_GT(contestant.at("cpuMilliseconds").at("median"), 0);
      ASSERT_FALSE(contestant.at("checks").empty());
      for (const nlohmann::json& check : contestant.at("checks")) EXPECT_TRUE(check.at("pass")) << check;
      EXPECT_NE(result.out.find(contestant.at("name").get<std::string>()), std::string::npos);
    }
  }
  EXPECT_NE(result.out.find("in reach of an agent"), std::string::npos) << result.out;
  const std::string keys = documentOf("json.md"), rows = documentOf("performance.md");
  for (const nlohmann::json& object : {device.at("avoidMatches").at(0), device.at("growth").at(0)})
    for (const auto& [key, value] : object.items()) {
      // `key` or `key[i].another`
      EXPECT_TRUE(keys.find("`" + key + "`") != keys.npos || keys.find("`" + key + "[") != keys.npos) << key;
    }
  for (const nlohmann::json& contestant : device.at("avoidMatches").at(0).at("results")) {
    const std::string name = contestant.at("name");
    EXPECT_NE(rows.find("\n| " + name.substr(0, name.find(','))), rows.npos) << name;
  }
  const nlohmann::json& growth = device.at("growth");
  ASSERT_EQ(growth.size(), device.at("avoidMatches").at(0).at("results").size());
  EXPECT_EQ(growth.at(0).at("from"), 64);
  EXPECT_EQ(growth.at(0).at("to"), 300);
  EXPECT_GT(growth.at(0).at("ratio"), 0);
}

TEST_F(Bench, RefusesWhatIsNotOfAvoid) {
  write("scene.json", "{}");
  for (const std::vector<std::string>& wrong : {std::vector<std::string>{"--controllers", "clip"},
                                                {"--poses"},
                                                {"--solver", "fabrik"},
                                                {"--terrain", "noise"},
                                                {file("scene.json")}}) {
    std::vector<std::string> arguments = {"bench", "--quick", "--avoid"};
    arguments.insert(arguments.end(), wrong.begin(), wrong.end());
    const std::string named = wrong.front()[0] == '-' ? wrong.front() : "a scene";
    expectRefusal(skitter(arguments), 2, {"--avoid", named});
  }
  write("avoids.json", R"({"herds": [{"avoid": true}]})");
  expectRefusal(skitter({"bench", "--quick", file("avoids.json")}), 2, {"herds[0].avoid", "--avoid"});
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

TEST_F(Bench, DrawTellsWhatFramesCost) {
  const Result result =
      skitter({"bench", "--draw", "--quick", "--agents", "0,3", "--size", "64x36", "--render-scale", "0.5",
               "--levels", "default", "--occlusion", "on", "--json", file("d.json")});
  ASSERT_EQ(result.code, 0) << result.out << result.err;
  EXPECT_NE(result.out.find("64 x 36 pixels, render scale 0.5"), std::string::npos) << result.out;
  const nlohmann::json all = json("d.json");
  EXPECT_EQ(
      all.at("picture"),
      (nlohmann::json{
          {"width", 64}, {"height", 36}, {"renderScale", 0.5}, {"levels", "default"}, {"occlusion", true}}));
  EXPECT_FALSE(all.at("interrupted"));
  ASSERT_EQ(all.at("draw").size(), 2u);
  const nlohmann::json &none = all.at("draw").at(0), &three = all.at("draw").at(1);
  for (const nlohmann::json& row : {none, three}) {
    EXPECT_GT(row.at("framesPerSecond"), 0);
    EXPECT_GT(row.at("cpuMilliseconds"), 0);
    EXPECT_EQ(row.at("device"), all.at("devices").at(0).at("device"));
    for (const char* part : {"simulation", "readback"}) EXPECT_GT(row.at("milliseconds").at(part), 0) << part;
    EXPECT_FALSE(row.at("milliseconds").contains("encode"));
  }
  EXPECT_EQ(none.at("agents"), 0);
  EXPECT_EQ(none.at("inView"), 0);
  EXPECT_EQ(none.at("hidden"), 0);
  EXPECT_GT(none.at("triangles"), 100);
  EXPECT_EQ(three.at("agents"), 3);
  EXPECT_GE(three.at("inView"), 1);
  EXPECT_LE(three.at("inView"), 3);
  // The camera stands elsewhere, so the ground has another number of them.
  EXPECT_GT(three.at("triangles"), 1000);
}

TEST_F(Bench, DrawRefusesWhatIsOfMatches) {
  for (const std::vector<std::string>& wrong :
       {std::vector<std::string>{"--rounds", "2"}, {"--poses"}, {"--controllers", "clip"}}) {
    std::vector<std::string> arguments = {"bench", "--draw", "--quick"};
    arguments.insert(arguments.end(), wrong.begin(), wrong.end());
    expectRefusal(skitter(arguments), 2, {wrong[0], "--draw"});
  }
  expectRefusal(skitter({"bench", "--quick", "--size", "64x36"}), 2, {"--size", "--draw"});
  expectRefusal(skitter({"bench", "--quick", "--render-scale", "0.5"}), 2, {"--render-scale", "--draw"});
  expectRefusal(skitter({"bench", "--quick", "--occlusion", "on"}), 2, {"--occlusion", "--draw"});
}

// The device's tick took `factor` times as long as in the first match of the file.
void scaleTimes(nlohmann::json& figures, double factor) {
  nlohmann::json& result = figures["devices"][0]["matches"][0]["results"][0];
  for (const char* clock : {"cpuMilliseconds", "wallMilliseconds"})
    result[clock]["median"] = factor * result[clock]["median"].get<double>();
}

TEST_F(Bench, FailsWhereATickTakesTooMuchLongerThanTheBaselines) {
  const std::vector<std::string> bench = {"bench",    "--quick", "--rounds",      "1",
                                          "--agents", "16",      "--controllers", "adaptive"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), bench.begin(), bench.end());
    return skitter(more);
  };
  ASSERT_EQ(with({"--json", file("then.json")}).code, 0);
  nlohmann::json slow = json("then.json"), quick = slow;
  scaleTimes(slow, 100);
  scaleTimes(quick, 0.01);
  write("slow.json", slow.dump());
  write("quick.json", quick.dump());

  const Result passes = with({"--baseline", file("slow.json"), "--fail-above", "0"});
  EXPECT_EQ(passes.code, 0) << passes.err;
  const Result fails =
      with({"--baseline", file("quick.json"), "--fail-above", "50", "--json", file("now.json")});
  EXPECT_EQ(fails.code, 1) << fails.out;
  EXPECT_NE(fails.err.find("adaptive, 16 agents: +"), std::string::npos) << fails.err;
  EXPECT_GT(json("now.json").at("devices")[0].at("matches")[0].at("slowdownPercent").at("low"), 50);

  const Result other = with({"--baseline", file("quick.json"), "--poses"});
  EXPECT_EQ(other.code, 2) << other.err;
  EXPECT_NE(other.err.find("none of these matches"), std::string::npos) << other.err;
}

TEST_F(Bench, RefusesABaselineThatIsNone) {
  write("text.json", "no figures");
  write("empty.json", "{}");
  for (const char* name : {"text.json", "empty.json", "missing.json"})
    expectRefusal(skitter({"bench", "--quick", "--baseline", file(name)}), 2, {"--baseline", name});
  expectRefusal(skitter({"bench", "--quick", "--fail-above", "5"}), 2, {"--fail-above", "--baseline"});
}

TEST_F(Bench, RefusesToTimeUnderTheValidationLayer) {
  const Result result =
      skitter({"bench", "--quick"}, {{"VK_INSTANCE_LAYERS", "VK_LAYER_KHRONOS_validation"}});
  expectRefusal(result, 2, {"VK_INSTANCE_LAYERS", "validation"});
}

}  // namespace
}  // namespace skitter::test
