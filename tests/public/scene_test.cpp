#include "skitter/scene.h"

#include <limits>

#include "public/public.h"

namespace skitter::test {
namespace {

TEST(PublicScene, TheBuiltInOneIsThatOfItsFile) {
  const Scene scene = builtinScene();
  EXPECT_EQ(scene.agentCount(), 1000u);
  EXPECT_EQ(scene.herds.at(0).goal.kind, Goal::Kind::cross);
  EXPECT_EQ(loadScene(assetFile("scenes/crossing.json")).herds, scene.herds);
}

TEST(PublicScene, CountsItsAgentsAndTheirReserves) {
  Scene scene = standingScene(5, 3);
  scene.herds.push_back(scene.herds[0]);
  scene.herds[1].agents = 0;
  EXPECT_EQ(scene.agentCount(), 5u);
  EXPECT_EQ(scene.capacity(), 11u);
}

TEST(PublicScene, IsReadBackAsItIsWritten) {
  Scene scene = standingScene(5, 3);
  scene.herds[0].sizes = {0.5f, 2};
  scene.events = {{.at = 1, .what = Mound{.centre = {3, 4}, .radius = 2, .height = -1}}};
  scene.camera.kind = Camera::Kind::orbit;
  const Scene again = parseScene(sceneJson(scene), "again", "/");
  EXPECT_EQ(again.herds, scene.herds);
  EXPECT_EQ(again.events, scene.events);
  EXPECT_EQ(again.camera, scene.camera);
  EXPECT_EQ(again.terrain, scene.terrain);
  EXPECT_EQ(again.seed, scene.seed);
}

TEST(PublicScene, RefusesToBeWrittenWithWhatNoFileMayHave) {
  Scene scene = standingScene(5);
  scene.herds[0].spawn.spacing = std::numeric_limits<float>::quiet_NaN();
  expectRefused("spacing", [&] { sceneJson(scene); });
}

TEST(PublicScene, RefusalsNameTheFileAndTheKey) {
  const OwnFolder folder;
  expectRefused("nowhere.json", [&] { loadScene(folder / "nowhere.json"); });
  expectRefused("own.json", [&] { loadScene(folder.with("own.json", "{]")); });
  expectRefused("mine: herds[0].agents", [] { parseScene(R"({"herds": [{"agents": -1}]})", "mine", "."); });
  expectRefused("did you mean agents?", [] { parseScene(R"({"herds": [{"agent": 1}]})", "mine", "."); });
}

TEST(PublicScene, LoadsItsTerrain) {
  Scene scene;
  scene.terrain = TerrainNoise{.columns = 33, .rows = 17};
  EXPECT_EQ(scene.loadTerrain().heights, generateHeightfield({.columns = 33, .rows = 17}).heights);
  scene.terrain = TerrainFile{assetFile("terrain/jacksboro_403x344.png"), {}};
  EXPECT_EQ(scene.loadTerrain().columns, 403u);
  scene.terrain = TerrainFile{"nowhere.png", {}};
  expectRefused("nowhere.png", [&] { scene.loadTerrain(); });
}

}  // namespace
}  // namespace skitter::test
