#include <fstream>
#include <regex>

#include "process.h"

namespace skitter::test {
namespace {

struct ManifestTest : AppTest {
  // The manifest of the file `name` that the command writes.
  nlohmann::json manifestOf(const std::vector<std::string>& command, const std::string& name = "a.json") {
    const Result result = skitter(command);
    EXPECT_EQ(result.code, 0) << result.err;
    if (result.code != 0) return {};
    nlohmann::json manifest = json(name).at("manifest");
    EXPECT_EQ(manifest.size(), 11u);
    EXPECT_EQ(manifest.at("version"), "0.1.0");
    EXPECT_TRUE(std::regex_match(manifest.at("commit").get<std::string>(),
                                 std::regex("unknown|[0-9a-f]{40}(-dirty)?")))
        << manifest.at("commit");
    EXPECT_GT(manifest.at("build").get<std::string>().size(), 5u);
    return manifest;
  }
  std::string hashOf(std::vector<std::string> more) {
    std::vector<std::string> command = {"run", "--headless", "--json", file("a.json")};
    for (const auto& [option, value] : {std::pair{"--frames", "1"}, {"--agents", "2"}})
      if (more.empty() || more.front() != option) command.insert(command.end(), {option, value});
    command.insert(command.end(), more.begin(), more.end());
    const nlohmann::json manifest = manifestOf(command);
    return manifest.is_null() ? "" : manifest.at("sceneHash").get<std::string>();
  }
};

// Which of scene, terrain, seed, dt and device there are.
std::string known(const nlohmann::json& manifest) {
  std::string names;
  for (const char* name : {"scene", "sceneHash", "terrain", "seed", "dt", "device", "driver"})
    if (!manifest.at(name).is_null()) names += std::string(names.empty() ? "" : " ") + name;
  return names;
}

TEST_F(ManifestTest, EveryFileOfFiguresHasIt) {
  const std::string all = "scene sceneHash terrain seed dt device driver";
  const auto with = [&](std::vector<std::string> command) {
    command.insert(command.end(), {"--json", file("a.json")});
    return known(manifestOf(command));
  };
  EXPECT_EQ(with({"run", "--headless", "--agents", "2", "--frames", "2", "--trace", file("trace")}), all);
  EXPECT_EQ(json("trace/trace.json").at("manifest"), json("a.json").at("manifest"));
  EXPECT_EQ(with({"validate", "--agents", "2", "--frames", "2"}), all);
  EXPECT_EQ(with({"ik", "--joints", "3", "--chains", "4"}), "seed device driver");
  EXPECT_EQ(with({"ik", "--joints", "3", "--chains", "4", "--device", "cpu"}), "seed device");
  EXPECT_EQ(with({"info"}), "device driver");
  EXPECT_EQ(with({"inspect", SKITTER_ROOT "/assets/quadruped.glb"}), "");
}

// Names with a space, quotes and a dollar, and with a byte that is no UTF-8.
TEST_F(ManifestTest, ItsCommandMakesTheFileAgain) {
  const std::string name = "a 'b' $HOME.json";
  const nlohmann::json manifest = manifestOf(
      {"run", "--headless", "--agents", "3", "--frames", "4", "--seed", "9", "--json", file(name)}, name);
  const std::string hash = json(name).at("stateHash");
  std::filesystem::remove(file(name));
  const Result again = runProgram({"sh", "-c", manifest.at("command")});
  ASSERT_EQ(again.code, 0) << again.err;
  EXPECT_EQ(json(name).at("stateHash"), hash);
  EXPECT_EQ(
      manifestOf({"inspect", SKITTER_ROOT "/assets/quadruped.glb", "--json", file("\xff.json")}, "\xff.json")
          .at("scene"),
      nullptr);
}

TEST_F(ManifestTest, TheHashIsOfWhatIsSimulated) {
  const std::string hash = hashOf({});
  EXPECT_EQ(hash.size(), 16u);
  for (const std::vector<std::string>& same : std::vector<std::vector<std::string>>{
           {"--frames", "2"}, {"--dt", "0.02"}, {"--view", "far"}, {"--poses"}})
    EXPECT_EQ(hashOf(same), hash) << same.front();
  for (const std::vector<std::string>& other :
       std::vector<std::vector<std::string>>{{"--seed", "2"},
                                             {"--agents", "3"},
                                             {"--controller", "loop"},
                                             {"--solver", "ccd"},
                                             {"--stepping", "reach"},
                                             {"--terrain", "noise:seed=2"}})
    EXPECT_NE(hashOf(other), hash) << other.front();
  const auto tuned = [&](const char* tuning) {
    std::ofstream(file("tuned.json")) << R"({"herds": [{"tuning": )" << tuning << "}]}";
    return hashOf({file("tuned.json")});
  };
  const std::string usual = tuned("{}");
  EXPECT_EQ(tuned(R"({"stepHeight": 0.12})"), usual);
  const std::set<std::string> hashes = {usual, tuned(R"({"stepHeight": 0.2})"),
                                        tuned(R"({"stepHeight": 0.3})"), tuned(R"({"leanMost": 0.2})")};
  EXPECT_EQ(hashes.size(), 4u);
}

TEST_F(ManifestTest, TheHashIsOfWhatHappens) {
  const std::vector<const char*> events = {
      R"("mound": {})",
      R"("goal": {"kind": "none"})",
      R"("agents": [1], "goal": {"kind": "none"})",
      R"("speed": 2)",
      R"("speed": 3)",
      R"("teleport": [{"agent": 1}])",
      R"("teleport": [{"agent": 1, "heading": 1}])",
      R"("add": [{}])",
      R"("add": [{"goal": {"kind": "none"}}])",
      R"("remove": [1])",
      R"("addHerd": {})",
      R"("addHerd": {"agents": 5})",
      R"("removeHerd": 0)",
  };
  std::set<std::string> hashes;
  for (const char* event : events) {
    std::ofstream(file("scene.json"))
        << R"({"herds": [{"reserve": 2}], "events": [{"at": 1, )" << event << "}]}";
    hashes.insert(hashOf({file("scene.json")}));
  }
  EXPECT_EQ(hashes.size(), events.size());
}

TEST_F(ManifestTest, TheHashIsOfTheFilesOfRigs) {
  for (const char* name : {"quadruped.glb", "quadruped.rig.json"})
    std::filesystem::copy_file(std::string(SKITTER_ROOT "/assets/") + name, file(name));
  const std::string hash = hashOf({"--rig", file("quadruped.glb")});
  std::ofstream(file("quadruped.rig.json"), std::ios::app) << "\n";
  EXPECT_NE(hashOf({"--rig", file("quadruped.glb")}), hash);
}

TEST_F(ManifestTest, TheHashIsOfTheTablesOfHerdsThatCanBeHurt) {
  for (const char* name : {"quadruped.glb", "quadruped.rig.json"})
    std::filesystem::copy_file(std::string(SKITTER_ROOT "/assets/") + name, file(name));
  const auto hashWith = [&](const char* hurt, const char* groups) {
    std::ofstream(file("quadruped.gaits.json"))
        << R"({"version": 1, "legs": ["L1", "R1", "L2", "R2"], "gaits": [{"without": ["L1"], "groups": )"
        << groups << R"(, "wait": "all", "shift": [0, 0, 0], "speed": 1, "fitness": 1,
               "turns": {"R1": [0, 1], "L2": [0.3, 1], "R2": [0.6, 1]}}]})";
    std::ofstream(file("scene.json"))
        << R"({"herds": [{"agents": 2, "rig": "quadruped.glb", "hurt": )" << hurt << "}]}";
    return hashOf({file("scene.json")});
  };
  EXPECT_NE(hashWith("true", "3"), hashWith("true", "2"));
  EXPECT_EQ(hashWith("false", "3"), hashWith("false", "2"));
}

}  // namespace
}  // namespace skitter::test
