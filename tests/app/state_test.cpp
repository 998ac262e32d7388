// Runs that are saved and go on: as one that never stopped, and refused where something does not fit.
#include <signal.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "process.h"
#include "skitter/controller.h"

namespace skitter::test {
namespace {

struct States : AppTest {
  using Arguments = std::vector<std::string>;

  Result run(Arguments more) const {
    Arguments arguments = {"run", "--headless", "--json", file("run.json")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return skitter(arguments);
  }
  nlohmann::json done(const Arguments& more) const {
    const Result result = run(more);
    EXPECT_EQ(result.code, 0) << result.err;
    return result.code == 0 ? json("run.json") : nlohmann::json{{"stateHash", "none"}};
  }
  std::string bytesOf(const std::string& name) const {
    std::ifstream in(file(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  // The hash after 60 frames at once, and after 25 and the rest.
  void expectSameWhole(const Arguments& options, const Arguments& later = {}) const {
    Arguments whole = options, part = options, rest = later;
    whole.insert(whole.end(), {"--frames", "60"});
    part.insert(part.end(), {"--frames", "25", "--save", file("walk.state")});
    rest.insert(rest.end(), {"--frames", "60", "--resume", file("walk.state")});
    const auto expected = done(whole);
    EXPECT_NE(done(part).at("stateHash"), expected.at("stateHash"));
    const auto resumed = done(rest);
    EXPECT_EQ(resumed.at("stateHash"), expected.at("stateHash"));
    EXPECT_EQ(resumed.at("fidelity").at("agentTicks"), expected.at("fidelity").at("agentTicks"));
    EXPECT_EQ(resumed.at("fidelity").at("stances"), expected.at("fidelity").at("stances"));
    EXPECT_EQ(resumed.at("manifest").at("sceneHash"), expected.at("manifest").at("sceneHash"));
    EXPECT_EQ(resumed.at("manifest").at("seed"), expected.at("manifest").at("seed"));
    EXPECT_EQ(resumed.at("manifest").at("dt"), expected.at("manifest").at("dt"));
    EXPECT_EQ(resumed.at("ticks"), expected.at("ticks"));
  }
  // A state of 12 agents at frame 10.
  void save(Arguments more = {}) const {
    Arguments arguments = {"--agents", "12", "--frames", "10", "--save", file("walk.state")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    ASSERT_EQ(run(arguments).code, 0);
  }
};

TEST_F(States, GoOnAsOneRun) {
  for (const Controller controller : allControllers) {
    SCOPED_TRACE(nameOf(controller));
    expectSameWhole({"--agents", "20", "--controller", nameOf(controller), "--seed", "5"});
  }
}

TEST_F(States, GoOnWithEveryOptionOfTheRun) {
  expectSameWhole({"--agents", "20", "--dt", "0.02", "--ticks-per-frame", "3", "--sleep", "--obstacle",
                   "--watch-every", "3", "--stepping", "reach", "--terrain", "noise:amplitude=2,seed=3"});
  expectSameWhole({"--agents", "20", "--no-measure", "--obstacle", "--solver", "fabrik"},
                  {"--page-agents", "7"});
  expectSameWhole({"--agents", "20", "--page-agents", "7"});
}

TEST_F(States, GoOnWithLevelsOfRate) {
  std::ofstream(file("near.json")) << R"({"distances": [6, 10, 14], "most": [8, 8, 8]})";
  for (const Arguments& later :
       {Arguments{}, Arguments{"--levels", file("near.json"), "--page-agents", "16"}})
    expectSameWhole({"--agents", "60", "--levels", file("near.json")}, later);
  const auto levels = json("run.json").at("levels");
  uint64_t ticks = 0;
  for (const auto& level : levels) ticks += level.at("agentTicks").get<uint64_t>();
  EXPECT_EQ(levels.size(), 4u);
  EXPECT_LT(ticks, 60u * 60);
  for (const auto& [saved, said] : {std::pair{file("near.json"), " other"}, {std::string(), "out"}}) {
    save(saved.empty() ? Arguments{} : Arguments{"--levels", saved});
    const Result refused = run({"--resume", file("walk.state"), "--frames", "20", "--levels", "default"});
    EXPECT_EQ(refused.code, 2);
    EXPECT_NE(refused.err.find(std::string("was saved with") + said + " levels"), std::string::npos)
        << refused.err;
  }
}

TEST_F(States, GoOnWithAnotherRigAndSeveralHerds) {
  expectSameWhole({"--agents", "9", "--rig", SKITTER_ROOT "/assets/quadruped.glb"});
  expectSameWhole({SKITTER_ROOT "/assets/scenes/three_herds.json", "--agents", "9", "--obstacle"});
  // It has an event before, one at the frame that is saved, and some after.
  write("scene.json", R"({"herds": [{"agents": 9, "reserve": 2}], "events": [
    {"at": 0.2, "add": [{"position": [1, 2]}]}, {"at": 0.416666667, "remove": [3]},
    {"at": 0.6, "teleport": [{"agent": 9, "position": [5, 5]}]}, {"at": 0.6, "speed": 2}]})");
  expectSameWhole({file("scene.json")});
}

// Of the file that the run began with it knows, whatever herds there are when it is saved.
TEST_F(States, GoOnWhereHerdsComeAndGo) {
  write("scene.json", R"({"herds": [{"agents": 9}, {"agents": 4, "controller": "loop"}], "events": [
    {"at": 0.2, "addHerd": {"agents": 5, "reserve": 1, "sizes": [1, 0.5]}},
    {"at": 0.3, "mound": {"radius": 4}}, {"at": 0.3, "removeHerd": 1},
    {"at": 0.416666667, "herd": 2, "add": [{"position": [1, 2]}]},
    {"at": 0.6, "removeHerd": 2}, {"at": 0.6, "addHerd": {"agents": 3, "controller": "planted"}}]})");
  expectSameWhole({file("scene.json")});
  const nlohmann::json herds = json("run.json").at("herds");
  ASSERT_EQ(herds.size(), 2u);
  EXPECT_EQ(herds[1].at("number"), 1);
  EXPECT_EQ(herds[1].at("agents"), 3);
  expectSameWhole({file("scene.json")}, {file("scene.json")});
  write("other.json", R"({"herds": [{"agents": 9}, {"agents": 4, "controller": "loop"}]})");
  expectRefusal(run({"--resume", file("walk.state"), file("other.json")}), 2,
                {"SCENE", "other.json", "events"});
}

TEST_F(States, NeedNothingBesideThem) {
  std::filesystem::copy(SKITTER_ROOT "/assets/terrain/everest_513x513.png", file("hills.png"));
  write("scene.json", R"({"terrain": {"kind": "file", "file": "hills.png", "scale": 0.01},
                          "herds": [{"agents": 12}]})");
  const auto whole = done({file("scene.json"), "--frames", "20"});
  done({file("scene.json"), "--frames", "10", "--save", file("walk.state")});
  std::filesystem::remove(file("scene.json"));
  std::filesystem::remove(file("hills.png"));
  EXPECT_EQ(done({"--resume", file("walk.state"), "--frames", "20"}).at("stateHash"), whole.at("stateHash"));
}

// With what only looks at the crowd: it may begin with the second half.
TEST_F(States, GoOnWithOtherOutputs) {
  save({"--no-measure"});
  const auto whole = done({"--agents", "12", "--no-measure", "--frames", "20"});
  const auto resumed =
      done({"--resume", file("walk.state"), "--frames", "20", "--out", file("walk.png"), "--size", "64x48",
            "--trace", file("trace"), "--footfalls", file("feet.csv"), "--timings"});
  EXPECT_EQ(resumed.at("stateHash"), whole.at("stateHash"));
  EXPECT_EQ(resumed.at("resumedAt"), 10);
  EXPECT_EQ(json("trace/trace.json").at("ticks"), 10);
  EXPECT_EQ(json("trace/trace.json").at("firstTick"), 11);
  EXPECT_TRUE(std::filesystem::exists(file("walk.png")));
  // Nothing is left to do but to draw.
  EXPECT_EQ(
      done({"--resume", file("walk.state"), "--frames", "10", "--out", file("still.png"), "--size", "64x48"})
          .at("ticks"),
      10);
}

TEST_F(States, AreSavedOnTheWayAndAtTheEnd) {
  done({"--agents", "12", "--frames", "25", "--save", file("walk.state"), "--save-every", "10"});
  EXPECT_EQ(done({"--resume", file("walk.state")}).at("ticks"), 25) << "as many as it wanted";
  // Over itself, further and further.
  for (const char* frames : {"30", "40"})
    EXPECT_EQ(
        done({"--resume", file("walk.state"), "--save", file("walk.state"), "--frames", frames}).at("ticks"),
        std::stoi(frames));
  EXPECT_EQ(done({"--resume", file("walk.state")}).at("stateHash"),
            done({"--agents", "12", "--frames", "40"}).at("stateHash"));
}

TEST_F(States, OfAnInterruptedRunGoOn) {
  bool stopped = false;
  const Result result =
      skitter({"run", "--headless", "--agents", "12", "--frames", "1000000", "--save", file("walk.state"),
               "--save-every", "5", "--json", file("run.json"), "--quiet"},
              {}, [&](int process) {
                if (stopped || !std::filesystem::exists(file("walk.state"))) return;
                kill(process, SIGINT);
                stopped = true;
              });
  EXPECT_EQ(result.code, 130) << result.err;
  const uint64_t ticks = json("run.json").at("ticks");
  const std::string frames = std::to_string(ticks + 10);
  const auto resumed = done({"--resume", file("walk.state"), "--frames", frames});
  EXPECT_EQ(resumed.at("resumedAt"), ticks) << "the state of the end, not of the last fifth frame";
  EXPECT_EQ(resumed.at("stateHash"), done({"--agents", "12", "--frames", frames}).at("stateHash"));
}

TEST_F(States, RefuseWhatContradictsThem) {
  save({"--seed", "4", "--heights", "0,3", "--spacing", "0.5", "--terrain",
        SKITTER_ROOT "/assets/terrain/everest_513x513.png"});
  write("other.json", R"({"herds": [{"agents": 13}]})");
  const std::vector<std::pair<Arguments, Arguments>> cases = {
      {{"--agents", "13"}, {"--agents 13", "herds/0/agents 12, not 13"}},
      {{"--seed", "5"}, {"--seed 5", "seed 4, not 5"}},
      {{"--controller", "loop"}, {"--controller loop", "\"adaptive\", not \"loop\""}},
      {{"--solver", "ccd"}, {"--solver ccd", "\"active-set\""}},
      {{"--stepping", "reach"}, {"--stepping reach", "\"gait\""}},
      {{"--rig", SKITTER_ROOT "/assets/quadruped.glb"}, {"--rig", "\"spider\""}},
      {{"--terrain", "noise"}, {"--terrain noise"}},
      {{"--spacing", "0.25"}, {"--spacing", "spacingX"}},
      {{"--heights", "0,4"}, {"--heights", "maxHeight 3"}},
      {{"--dt", "0.02"}, {"--dt", "0.01666"}},
      {{"--ticks-per-frame", "2"}, {"--ticks-per-frame", "1"}},
      {{"--watch-every", "2"}, {"--watch-every", "1"}},
      {{"--sleep"}, {"--sleep", "without"}},
      {{"--obstacle"}, {"--obstacle", "without"}},
      {{"--no-measure"}, {"--no-measure", "without"}},
      {{file("other.json")}, {"SCENE", "other.json"}},
      {{"--frames", "9"}, {"--frames 9", "frame 10"}},
  };
  for (const auto& [options, words] : cases) {
    Arguments arguments = {"run", "--headless", "--resume", file("walk.state")};
    arguments.insert(arguments.end(), options.begin(), options.end());
    Arguments expected = words;
    expected.push_back("walk.state");
    expectRefusal(skitter(arguments), 2, expected);
  }
  // What says the same is none.
  EXPECT_EQ(run({"--resume", file("walk.state"), "--frames", "11", "--agents", "12", "--seed", "4",
                 "--heights", "0,3", "--terrain", SKITTER_ROOT "/assets/terrain/everest_513x513.png",
                 "--controller", "adaptive", "--watch-every", "1"})
                .code,
            0);
}

TEST_F(States, RefuseChangedRigs) {
  std::filesystem::copy(SKITTER_ROOT "/assets/quadruped.glb", file("beast.glb"));
  std::ostringstream text;
  text << std::ifstream(SKITTER_ROOT "/assets/quadruped.rig.json").rdbuf();
  std::string sidecar = text.str();
  const auto replace = [&](const std::string& from, const std::string& to) {
    ASSERT_NE(sidecar.find(from), std::string::npos);
    sidecar.replace(sidecar.find(from), from.size(), to);
    write("beast.rig.json", sidecar);
  };
  replace("quadruped.glb", "beast.glb");
  save({"--rig", file("beast.glb")});
  replace("\"bodyHeight\": 0.45", "\"bodyHeight\": 0.46");
  expectRefusal(skitter({"run", "--headless", "--resume", file("walk.state"), "--frames", "20"}), 2,
                {"walk.state", "rig beast", "other legs"});
  std::filesystem::remove(file("beast.glb"));
  expectRefusal(skitter({"run", "--headless", "--resume", file("walk.state"), "--frames", "20"}), 2,
                {"beast.glb", "no such file"});
}

TEST_F(States, DamagedOrForeignAreRefusedAndNothingChanges) {
  save();
  const std::string whole = bytesOf("walk.state");
  write("run.json", "old");
  const auto refused = [&](const std::string& bytes, const std::vector<std::string>& words) {
    write("bad.state", bytes);
    Result result = run({"--resume", file("bad.state"), "--save", file("bad.state"), "--frames", "20"});
    expectRefusal(result, 2, words);
    EXPECT_EQ(bytesOf("bad.state"), bytes);
    EXPECT_EQ(bytesOf("run.json"), "old");
  };
  for (size_t at = 5; at < whole.size(); at += whole.size() / 12) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 1);
    refused(damaged, {"bad.state"});
  }
  for (const size_t size : {size_t{1}, size_t{30}, whole.size() / 2, whole.size() - 1})
    refused(whole.substr(0, size), {"bad.state"});
  refused(whole + "x", {"bad.state", "expected"});
  refused("{\"herds\": []}", {"bad.state", "is no state"});
  expectRefusal(run({"--resume", file("none.state"), "--frames", "20"}), 2, {"none.state", "no such file"});
  expectRefusal(run({"--resume", SKITTER_ROOT "/assets/spider.glb", "--frames", "20"}), 2, {"is no state"});
  expectRefusal(run({"--save-every", "2"}), 2, {"--save-every", "--save"});
}

TEST_F(States, AreInspected) {
  save({"--obstacle"});
  const Result result = skitter({"inspect", file("walk.state"), "--json", file("state.json")});
  EXPECT_EQ(result.code, 0) << result.err;
  for (const char* word : {"tick 10", "12 spider", "adaptive", "--resume"})
    EXPECT_NE(result.out.find(word), std::string::npos) << word << "\n" << result.out;
  const nlohmann::json state = json("state.json");
  EXPECT_EQ(state.at("tick"), 10);
  EXPECT_EQ(state.at("scene").at("herds").at(0).at("agents"), 12);
  EXPECT_EQ(state.at("saved").at("scene"), "crossing");
  EXPECT_EQ(state.at("saved").at("sceneHash").get<std::string>().size(), 16u);
}

TEST_F(States, TheManifestCanBeReadWithoutTheProgram) {
  save();
  const std::string bytes = bytesOf("walk.state");
  uint64_t head = 0;
  std::copy_n(bytes.data() + 16, sizeof head, reinterpret_cast<char*>(&head));
  const auto json = nlohmann::json::parse(bytes.substr(24, head));
  EXPECT_EQ(json.at("note").at("manifest").at("scene"), "crossing");
  EXPECT_TRUE(json.at("note").at("manifest").at("command").is_string());
  EXPECT_EQ(json.at("terrain").at("hash").get<std::string>().size(), 8u);
}

}  // namespace
}  // namespace skitter::test
