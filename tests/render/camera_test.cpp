#include "support/gpu_fixture.h"

#include <algorithm>
#include <cmath>

#include "skitter/records.h"
#include "skitter/renderer.h"

namespace skitter::test {
namespace {

class CameraTest : public GpuTest {};

TEST_F(CameraTest, followMovesWithTheHerdAboveTheGround) {
  Scene scene = builtinScene();
  const Heightfield terrain = scene.loadTerrain();
  const Crowd crowd(device(), terrain, scene);
  const float speed = scene.herds[0].goal.speed;
  const View start = viewOf(scene, crowd, 0), later = viewOf(scene, crowd, 5);
  EXPECT_NEAR(later.target.z - start.target.z, 5 * speed, 0.01f);
  EXPECT_NEAR(later.target.x, start.target.x, 0.01f);
  for (double seconds = 0; seconds < 1000; seconds += 3.7) {
    const View view = viewOf(scene, crowd, seconds);
    ASSERT_GT(view.eye.y, terrain.at(view.eye.x, view.eye.z) + 0.2f) << seconds;
    ASSERT_LE(std::abs(view.target.x), terrain.extentX() / 2);
    ASSERT_LE(std::abs(view.target.z), terrain.extentZ() / 2);
  }
}

TEST_F(CameraTest, fixedIsWhereTheSceneSays) {
  Scene scene = builtinScene();
  scene.herds[0].agents = 0;
  const Heightfield terrain = scene.loadTerrain();
  const Crowd crowd(device(), terrain, scene);
  EXPECT_NO_THROW(viewOf(scene, crowd, 3));
  scene.camera = {
      .kind = Camera::Kind::fixed, .position = {1, 2, 3}, .target = {4, 5, 6}, .fieldOfView = 0.5f};
  const View view = viewOf(scene, crowd, 3);
  EXPECT_EQ(view.eye, glm::vec3(1, 2, 3));
  EXPECT_EQ(view.target, glm::vec3(4, 5, 6));
  EXPECT_EQ(view.fieldOfView, 0.5f);
}

// Ground that rises by `slope` a metre towards -z.
Heightfield incline(float extent, float slope) {
  const float half = extent / 2;
  return {.name = "incline",
          .columns = 2,
          .rows = 2,
          .spacingX = extent,
          .spacingZ = extent,
          .heights = {slope * half, slope * half, -slope * half, -slope * half}};
}
// Cheap to make: who is followed does not depend on the controller.
Scene herdOf(uint32_t agents, const Spawn& spawn, const Goal& goal) {
  Scene scene;
  scene.herds[0].controller = Controller::clip;
  scene.herds[0].agents = agents;
  scene.herds[0].spawn = spawn;
  scene.herds[0].goal = goal;
  return scene;
}
Crowd crowdOf(Device& device, const Heightfield& terrain, const Scene& scene) {
  return {device, terrain, scene, {.pose = false, .measure = false}};
}

// docs/stages/pictures.md: 0.30 rad above the ground's horizon, 0.62 rad to the left of the line behind.
TEST_F(CameraTest, followLooksFromBehindLeftAndAbove) {
  const float heading = 2.1f;
  Scene scene = herdOf(1, {.kind = Spawn::Kind::grid, .centre = {3, -5}, .heading = heading},
                       {.kind = Goal::Kind::none});
  scene.camera.fieldOfView = 0.7f;
  const Crowd crowd = crowdOf(device(), incline(200, 0), scene);
  for (const double distance : {12.0, 40.0}) {
    scene.camera.distance = float(distance);
    const View view = viewOf(scene, crowd, 7);
    EXPECT_EQ(view.fieldOfView, 0.7f);
    EXPECT_LT(glm::distance(view.target, glm::vec3(3, 0.35f, -5)), 1e-5f);
    // Behind is where the heading comes from, turned by 0.62 rad to the creature's left.
    const double from = double(heading) + 3.14159265358979 - 0.62, flat = std::cos(0.30);
    const glm::dvec3 eye =
        glm::dvec3(view.target) +
        distance * glm::dvec3(flat * std::sin(from), std::sin(0.30), flat * std::cos(from));
    EXPECT_LT(glm::distance(glm::dvec3(view.eye), eye), 1e-5 * distance);
  }
}

// Its walker goes to the far side, turns, comes back beside its lane, and so on for ever.
TEST_F(CameraTest, followStaysWithItsWalkerLapAfterLap) {
  const Scene scene = herdOf(1, {.kind = Spawn::Kind::lanes}, {.kind = Goal::Kind::cross, .speed = 1.7f});
  const Crowd crowd = crowdOf(device(), incline(120, 0), scene);
  const HerdState state = crowd.download(0);
  const glm::dvec2 start(shared::tileX(state.body[3]) * shared::TILE_SIZE + state.body[0],
                         shared::tileZ(state.body[3]) * shared::TILE_SIZE + state.body[2]);
  const glm::dvec2 there(state.goal[0], state.goal[1]), back(state.goal[2], state.goal[3]);
  const double first = glm::distance(start, there), lap = glm::distance(there, back);
  ASSERT_GT(std::abs(there.x - back.x), 0.1);  // the way back is another one
  const auto at = [&](double metres) {
    const View view = viewOf(scene, crowd, metres / 1.7);
    return glm::dvec2(view.target.x, view.target.z);
  };
  EXPECT_LT(glm::distance(at(0.4 * first), glm::mix(start, there, 0.4)), 1e-3);
  for (const double share : {0.1, 0.5, 0.9}) {
    EXPECT_LT(glm::distance(at(first + share * lap), glm::mix(there, back, share)), 1e-3);
    EXPECT_LT(glm::distance(at(first + (1 + share) * lap), glm::mix(back, there, share)), 1e-3);
    EXPECT_LT(glm::distance(at(first + (6 + share) * lap), glm::mix(there, back, share)), 1e-3);
  }
}

TEST_F(CameraTest, followEndsWhereItsWalkerStops) {
  const Scene scene =
      herdOf(1, {.kind = Spawn::Kind::grid}, {.kind = Goal::Kind::point, .target = {30, 40}, .speed = 2});
  const Crowd crowd = crowdOf(device(), incline(200, 0), scene);
  EXPECT_LT(glm::distance(viewOf(scene, crowd, 10).target, glm::vec3(12, 0.35f, 16)), 1e-3f);
  EXPECT_LT(glm::distance(viewOf(scene, crowd, 1000).target, glm::vec3(30, 0.35f, 40)), 1e-3f);
}

// Three tenths of the herd walk behind the one that is followed, in the middle of its row; on ground that is
// too narrow for a square of agents too.
TEST_F(CameraTest, followIsInTheMiddleOfTheHerd) {
  for (const float width : {700.0f, 70.0f}) {
    const Scene scene = herdOf(2500, {.kind = Spawn::Kind::lanes}, {.kind = Goal::Kind::cross});
    Heightfield terrain = incline(2000, 0);
    terrain.spacingX = width;
    const Crowd crowd = crowdOf(device(), terrain, scene);
    const View view = viewOf(scene, crowd, 0);
    const HerdState state = crowd.download(0);
    size_t behind = 0, left = 0;
    for (size_t i = 0; i < state.agents; ++i) {
      const float* body = &state.body[i * shared::BODY_STRIDE * 4];
      const float x = shared::tileX(body[3]) * shared::TILE_SIZE + body[0];
      const float z = shared::tileZ(body[3]) * shared::TILE_SIZE + body[2];
      behind += z < view.target.z;
      left += x > view.target.x;
    }
    // Its own row of 50 or 24 begins 750 agents on; a lane is 50 or 105 agents.
    EXPECT_NEAR(double(behind), 775, 25) << width;
    EXPECT_NEAR(double(left), 1250, 105) << width;
  }
}

// Its place is drawn by the seed of its herd, which is another one for each number.
TEST_F(CameraTest, followIsOfTheFirstHerdThatHasAgents) {
  Scene scene = herdOf(1, {.kind = Spawn::Kind::lanes}, {.kind = Goal::Kind::none});
  scene.herds.push_back(scene.herds[0]);
  scene.herds[0].agents = 0;
  const Crowd crowd = crowdOf(device(), incline(200, 0), scene);
  const View view = viewOf(scene, crowd, 0);
  const HerdState state = crowd.download(1);
  const float* body = state.body.data();
  EXPECT_NEAR(view.target.x, shared::tileX(body[3]) * shared::TILE_SIZE + body[0], 1e-3f);
  EXPECT_NEAR(view.target.z, shared::tileZ(body[3]) * shared::TILE_SIZE + body[2], 1e-3f);
}

// Ground that rises behind the walker more steeply than the camera looks down lifts the camera: half a metre
// of air under the first two thirds of its line of sight, and no more.
TEST_F(CameraTest, followLooksOverGroundThatRises) {
  const Heightfield terrain = incline(400, 0.8f);
  const Scene scene = herdOf(1, {.kind = Spawn::Kind::grid}, {.kind = Goal::Kind::none});
  const Crowd crowd = crowdOf(device(), terrain, scene);
  const View view = viewOf(scene, crowd, 0);
  EXPECT_NEAR(view.target.y, 0.35f, 1e-4f);
  float least = 1e9f;
  for (float t = 0; t <= 2.0f / 3; t += 1.0f / 48) {
    const glm::vec3 at = glm::mix(view.eye, view.target, t);
    least = std::min(least, at.y - terrain.at(at.x, at.z));
  }
  EXPECT_NEAR(least, 0.5f, 1e-3f);
}

// In a valley whose sides rise by 0.5 the mean of 13 points within 3 m is 0.5 (4 sin 60 deg 3 m + 4 1.5 m)
// / 13.
TEST_F(CameraTest, followGlidesOverTheMeanOfTheGround) {
  Heightfield terrain;
  terrain.columns = 2;
  terrain.rows = 3;
  terrain.spacingX = 200;
  terrain.spacingZ = 100;
  terrain.heights = {50, 50, 0, 0, 50, 50};
  Scene scene = herdOf(1, {.kind = Spawn::Kind::grid}, {.kind = Goal::Kind::none});
  scene.camera.distance = 10;
  const Crowd crowd = crowdOf(device(), terrain, scene);
  const double mean = 0.5 * (4 * std::sqrt(0.75) * 3 + 4 * 1.5) / 13;
  EXPECT_NEAR(double(viewOf(scene, crowd, 0).target.y), mean + 0.35, 1e-4);
}

// Checkers of 2.5 m that are 30 m high or low.
Heightfield cliffs() {
  Heightfield terrain;
  terrain.columns = terrain.rows = 129;
  terrain.spacingX = terrain.spacingZ = 0.5f;
  for (uint32_t z = 0; z < 129; ++z)
    for (uint32_t x = 0; x < 129; ++x) terrain.heights.push_back(x / 5 % 2 == z / 5 % 2 ? 15.0f : -15.0f);
  return terrain;
}

// The mean height that the camera glides over says nothing of a cliff's edge.
TEST_F(CameraTest, followIsNeverInTheGround) {
  const Heightfield terrain = cliffs();
  const Scene scene = herdOf(1, {.kind = Spawn::Kind::lanes}, {.kind = Goal::Kind::cross});
  const Crowd crowd = crowdOf(device(), terrain, scene);
  for (double seconds = 0; seconds < 100; seconds += 0.1) {
    const View view = viewOf(scene, crowd, seconds);
    ASSERT_GT(view.eye.y, terrain.at(view.eye.x, view.eye.z) + 0.19f) << seconds;
  }
}

// A scene about one agent that stands at (3, -5), whose `orbit` camera is 12 m away, 0.4 rad up.
Scene orbitScene() {
  Scene scene = herdOf(1, {.kind = Spawn::Kind::grid, .centre = {3, -5}}, {.kind = Goal::Kind::none});
  scene.camera = {.kind = Camera::Kind::orbit,
                  .distance = 12,
                  .fieldOfView = 0.7f,
                  .elevation = 0.4f,
                  .azimuth = 0.3f,
                  .secondsATurn = 20};
  return scene;
}

TEST_F(CameraTest, orbitTurnsAboutTheMiddleOfTheCrowd) {
  Scene scene = orbitScene();
  const Crowd crowd = crowdOf(device(), incline(200, 0), scene);
  for (const float turn : {20.0f, -20.0f}) {
    scene.camera.secondsATurn = turn;
    for (const double seconds : {0.0, 5.0, 8.0, 27.0, -3.0}) {
      const View view = viewOf(scene, crowd, seconds);
      EXPECT_EQ(view.fieldOfView, 0.7f);
      EXPECT_LT(glm::distance(view.target, glm::vec3(3, 0.35f, -5)), 1e-5f);
      const double angle = 0.3 + 2 * 3.14159265358979 * seconds / double(turn), flat = std::cos(0.4);
      const glm::dvec3 eye = glm::dvec3(view.target) +
                             12.0 * glm::dvec3(flat * std::sin(angle), std::sin(0.4), flat * std::cos(angle));
      EXPECT_LT(glm::distance(glm::dvec3(view.eye), eye), 1e-4) << turn << " at " << seconds;
    }
  }
  scene.camera.secondsATurn = 0;
  EXPECT_EQ(viewOf(scene, crowd, 0).eye, viewOf(scene, crowd, 7).eye);
}

TEST_F(CameraTest, orbitTurnsAboutThePointThatTheSceneNames) {
  Scene scene = orbitScene();
  scene.camera.about = glm::vec3(-7, 4, 9);
  const Crowd crowd = crowdOf(device(), incline(200, 0), scene);
  const View view = viewOf(scene, crowd, 6);
  EXPECT_EQ(view.target, glm::vec3(-7, 4, 9));
  EXPECT_NEAR(glm::distance(view.eye, view.target), 12, 1e-4);
}

Scene pathScene() {
  Scene scene = orbitScene();
  scene.camera = {.kind = Camera::Kind::path,
                  .keys = {{.time = 1, .position = {0, 5, 0}, .target = {0, 0, 10}},
                           {.time = 3, .position = {10, 6, 0}, .target = {0, 1, 10}},
                           {.time = 4, .position = {10, 8, 20}, .target = {0, 0, 30}}}};
  return scene;
}

TEST_F(CameraTest, pathMeetsItsKeysAndStaysAtItsEnds) {
  const Scene scene = pathScene();
  const Crowd crowd = crowdOf(device(), incline(200, 0), scene);
  for (const CameraKey& key : scene.camera.keys) {
    const View view = viewOf(scene, crowd, key.time);
    EXPECT_LT(glm::distance(view.eye, key.position), 1e-5f) << key.time;
    EXPECT_LT(glm::distance(view.target, key.target), 1e-5f) << key.time;
  }
  // Through the middle key at the slope of the parabola through the three, P = (5, 1/2, 0) towards it over
  // 2 s and (0, 2, 20) away from it over 1 s: (1 (5, 1/2, 0) + 2 (0, 2, 20)) / 3.
  const glm::vec3 slope = (viewOf(scene, crowd, 3.01).eye - viewOf(scene, crowd, 2.99).eye) / 0.02f;
  EXPECT_LT(glm::distance(slope, glm::vec3(5.0f / 3, 4.5f / 3, 40.0f / 3)), 0.1f);
  EXPECT_EQ(viewOf(scene, crowd, 0).eye, scene.camera.keys.front().position);
  EXPECT_EQ(viewOf(scene, crowd, 1e6).eye, scene.camera.keys.back().position);
  EXPECT_EQ(viewOf(scene, crowd, 1e6).target, scene.camera.keys.back().target);
}

TEST_F(CameraTest, orbitAndPathAreNeverInTheGround) {
  const Heightfield terrain = cliffs();
  Scene below = orbitScene(), path = pathScene(), above = orbitScene();
  below.camera.about = glm::vec3(0, -40, 0);
  below.camera.elevation = -1.5f;
  const Crowd crowd = crowdOf(device(), terrain, above);
  for (const Scene* scene : {&below, &path, &above})
    for (double seconds = -5; seconds < 30; seconds += 0.05) {
      const View view = viewOf(*scene, crowd, seconds);
      ASSERT_GT(view.eye.y, terrain.seenAt(view.eye.x, view.eye.z) + 0.19f) << seconds;
    }
}

TEST_F(CameraTest, anyTimeHasAView) {
  const Heightfield terrain = cliffs();
  Scene scene = herdOf(1, {.kind = Spawn::Kind::lanes}, {.kind = Goal::Kind::cross});
  const Crowd crowd = crowdOf(device(), terrain, scene);
  const std::vector<CameraKey> keys = pathScene().camera.keys;
  for (const Camera::Kind kind : {Camera::Kind::follow, Camera::Kind::orbit, Camera::Kind::path})
    for (const double seconds : {-HUGE_VAL, -1e300, -1.0, 1e300, HUGE_VAL, std::nan("")}) {
      scene.camera = {.kind = kind, .keys = keys};
      const View view = viewOf(scene, crowd, seconds);
      ASSERT_TRUE(glm::all(glm::lessThan(glm::abs(view.eye), glm::vec3(1e4f)))) << seconds;
      ASSERT_TRUE(glm::all(glm::lessThan(glm::abs(view.target), glm::vec3(1e4f)))) << seconds;
      ASSERT_GT(view.eye.y, terrain.seenAt(view.eye.x, view.eye.z) + 0.19f) << seconds;
    }
}

}  // namespace
}  // namespace skitter::test
