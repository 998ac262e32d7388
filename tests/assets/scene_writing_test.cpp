#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <limits>

#include "files.h"
#include "random_scenes.h"
#include "skitter/error.h"
#include "skitter/scene.h"

namespace skitter {
namespace {

using test::inputFault;
using test::RandomScenes;

TEST(SceneWriting, IsReadBackAsItIsWritten) {
  RandomScenes random(1);
  for (int i = 0; i < 200; ++i) {
    const Scene scene = random.scene();
    const std::string json = sceneJson(scene);
    EXPECT_TRUE(parseScene(json, "a.json", "elsewhere") == scene) << json;
  }
  EXPECT_TRUE(parseScene(sceneJson(builtinScene()), "a.json", "") == builtinScene());
}

TEST(SceneWriting, IsWrittenWithAbsoluteNamesAndShortNumbers) {
  Scene scene;
  scene.herds[0].rig = "models/../beast.glb";
  scene.herds[0].spawn.spacing = 0.1f;
  const Scene read = parseScene(sceneJson(scene), "a.json", "elsewhere");
  EXPECT_EQ(read.herds[0].rig, (std::filesystem::current_path() / "beast.glb").string());
  EXPECT_THAT(sceneJson(scene), testing::HasSubstr("\"spacing\": 0.1,"));
}

TEST(SceneWriting, IsNotWrittenWhereItCouldNotBeRead) {
  const auto faultOf = [](const std::function<void(Scene&)>& spoil) {
    Scene scene;
    spoil(scene);
    return inputFault([&] { sceneJson(scene); });
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(faultOf([&](Scene& scene) { scene.herds[0].goal.speed = nan; }),
            "built-in: herds[0].goal.speed is nan, expected a number from 0 to 1000");
  EXPECT_EQ(faultOf([](Scene& scene) { scene.herds[0].keys = 9; }),
            "built-in: herds[0].keys is 9, expected a whole number from 2 to 8");
  EXPECT_EQ(faultOf([](Scene& scene) { scene.herds[0].rig = "beast\xff.glb"; }).substr(0, 24),
            "built-in: herds[0].rig i");
  EXPECT_EQ(faultOf([](Scene& scene) { scene.terrain = TerrainFile{}; }),
            "built-in: terrain.file is missing, kind \"file\" needs it");
  EXPECT_EQ(faultOf([](Scene& scene) {
              scene.herds[0].cuts.push_back({"walk", "", 0, 1});
            }),
            "built-in: herds[0].cuts[0].name is missing");
  const auto faultOfEvent = [&](const decltype(Event::what)& what) {
    return faultOf([&](Scene& scene) { scene.events.push_back({0, what}); });
  };
  EXPECT_EQ(faultOfEvent(Teleport{}), "built-in: events[0].teleport is empty, expected at least one agent");
  EXPECT_EQ(faultOfEvent(Addition{}), "built-in: events[0].add is empty, expected at least one agent");
  EXPECT_EQ(faultOfEvent(Removal{}), "built-in: events[0].remove is empty, expected at least one agent");
  EXPECT_EQ(
      faultOfEvent(Teleport{.moves = {{}}}),
      "built-in: events[0].teleport[0].agent is 4294967295, expected a whole number from 0 to 16777215");
  EXPECT_EQ(faultOfEvent(SpeedChange{.herd = 1024}),
            "built-in: events[0].herd is 1024, expected a whole number from 0 to 1023");
  HerdAddition spoilt;
  spoilt.herd.keys = 9;
  EXPECT_EQ(faultOfEvent(spoilt),
            "built-in: events[0].addHerd.keys is 9, expected a whole number from 2 to 8");
  EXPECT_EQ(faultOfEvent(LegChange{}), "built-in: events[0].leg is missing");
  EXPECT_EQ(faultOfEvent(LegChange{.leg = "R2", .bone = 15}),
            "built-in: events[0].bone is 15, expected a whole number from 0 to 14");
  EXPECT_EQ(faultOfEvent(LegChange{.agents = {1}, .share = 0.5f, .leg = "R2"}),
            "built-in: events[0] has agents and a share, expected one of them");
  EXPECT_EQ(faultOfEvent(HerdRemoval{1024}),
            "built-in: events[0].removeHerd is 1024, expected a whole number from 0 to 1023");
  const std::vector<uint32_t> many(Event::maxAgents + 1);
  EXPECT_EQ(faultOfEvent(GoalChange{.agents = many}),
            "built-in: events[0].agents are 65537, expected at most 65536");
  EXPECT_EQ(faultOfEvent(Addition{.arrivals = std::vector<Addition::Arrival>(Event::maxAgents + 1)}),
            "built-in: events[0].add are 65537, expected at most 65536");
}

}  // namespace
}  // namespace skitter
