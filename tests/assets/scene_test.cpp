#include "skitter/scene.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "files.h"
#include "skitter/error.h"

namespace skitter {
namespace {

using test::inputFault;

TEST(Scene, BuiltinIsTheCrossing) {
  const Scene scene = builtinScene();
  EXPECT_EQ(scene.name, "crossing");
  EXPECT_EQ(scene.agentCount(), 1000u);
  ASSERT_EQ(scene.herds.size(), 1u);
  EXPECT_EQ(scene.herds[0].rig, "spider");
  EXPECT_EQ(scene.herds[0].goal.kind, Goal::Kind::cross);
  ASSERT_TRUE(std::holds_alternative<TerrainNoise>(scene.terrain));
  EXPECT_EQ(scene.loadTerrain().heights, generateHeightfield({}).heights);
}

TEST(Scene, BuiltinIsTheFileInTheTree) {
  const Scene file = loadScene(SKITTER_ROOT "/assets/scenes/crossing.json");
  EXPECT_EQ(file.name, builtinScene().name);
  EXPECT_EQ(file.herds[0].agents, builtinScene().herds[0].agents);
}

TEST(Scene, MayHaveComments) {
  const Scene scene = loadScene(SKITTER_ROOT "/assets/scenes/three_herds.json");
  ASSERT_EQ(scene.herds.size(), 3u);
  EXPECT_EQ(scene.herds[1].goal.kind, Goal::Kind::point);
  EXPECT_EQ(parseScene("{/* none */ \"seed\": 3 // three\n}", "a.json", "").seed, 3u);
  EXPECT_THAT(inputFault([] { parseScene("{} /* for ever", "a.json", ""); }), testing::HasSubstr("a.json"));
}

TEST(Scene, EmptyObjectIsAllDefaults) {
  const Scene scene = parseScene("{}", "plain.json", "");
  EXPECT_EQ(scene.name, "plain");
  EXPECT_EQ(scene.agentCount(), 1000u);
  EXPECT_EQ(scene.camera.kind, Camera::Kind::follow);
}

TEST(Scene, EveryKey) {
  const Scene scene = parseScene(R"({
    "name": "all", "seed": 18446744073709551615,
    "terrain": {"kind": "file", "file": "hill.png", "spacingX": 1, "spacingZ": 2, "minHeight": -3, "maxHeight": 4.5,
                "scale": 0.5, "exaggeration": 2, "columns": 3, "rows": 4, "voidValue": -9999},
    "herds": [{"rig": "crab.glb", "controller": "loop", "agents": 7, "keys": 6,
               "spawn": {"kind": "grid", "spacing": 3, "centre": [1, -2], "heading": 1.5},
               "goal": {"kind": "point", "target": [5, 6], "speed": 0}},
              {"agents": 0, "reserve": 9, "goal": {"kind": "none"}},
              {"agents": 0, "avoid": true, "goal": {"kind": "velocity", "velocity": [0.5, -1]}}],
    "camera": {"kind": "fixed", "position": [1, 2, 3], "target": [4, 5, 6], "distance": 2, "fieldOfView": 1}
  })",
                                 "all.json", "folder");
  EXPECT_EQ(scene.seed, UINT64_MAX);
  const auto& terrain = std::get<TerrainFile>(scene.terrain);
  EXPECT_EQ(terrain.file, std::filesystem::path("folder/hill.png"));
  EXPECT_EQ(terrain.units.spacingX, 1.0f);
  EXPECT_EQ(terrain.units.spacingZ, 2.0f);
  EXPECT_EQ(terrain.units.minHeight, -3.0f);
  EXPECT_EQ(terrain.units.maxHeight, 4.5f);
  EXPECT_EQ(terrain.units.scale, 0.5f);
  EXPECT_EQ(terrain.units.exaggeration, 2.0f);
  EXPECT_EQ(terrain.units.columns, 3u);
  EXPECT_EQ(terrain.units.rows, 4u);
  EXPECT_EQ(terrain.units.voidValue, -9999.0);
  ASSERT_EQ(scene.herds.size(), 3u);
  const Herd& herd = scene.herds[0];
  EXPECT_EQ(std::filesystem::path(herd.rig), std::filesystem::path("folder/crab.glb"));
  EXPECT_EQ(herd.controller, Controller::loop);
  EXPECT_EQ(herd.agents, 7u);
  EXPECT_EQ(herd.keys, 6u);
  EXPECT_EQ(herd.spawn.kind, Spawn::Kind::grid);
  EXPECT_EQ(herd.spawn.centre, glm::vec2(1, -2));
  EXPECT_EQ(herd.spawn.heading, 1.5f);
  EXPECT_EQ(herd.goal.kind, Goal::Kind::point);
  EXPECT_EQ(herd.goal.target, glm::vec2(5, 6));
  EXPECT_EQ(herd.goal.speed, 0);
  EXPECT_EQ(scene.herds[1].reserve, 9u);
  EXPECT_EQ(scene.capacity(), 16u);
  EXPECT_EQ(scene.herds[2].goal.kind, Goal::Kind::velocity);
  EXPECT_EQ(scene.herds[2].goal.velocity, glm::vec2(0.5f, -1));
  EXPECT_TRUE(scene.herds[2].avoid);
  EXPECT_FALSE(scene.herds[1].avoid);
  EXPECT_EQ(scene.herds[1].goal.kind, Goal::Kind::none);
  EXPECT_EQ(scene.camera.kind, Camera::Kind::fixed);
  EXPECT_EQ(scene.camera.target, glm::vec3(4, 5, 6));
  EXPECT_EQ(scene.camera.fieldOfView, 1);
  EXPECT_EQ(scene.agentCount(), 7u);
}

TEST(Scene, LightIsANameOrAnObject) {
  const auto lightOf = [](const std::string& json) { return parseScene(json, "lit.json", "").light; };
  EXPECT_EQ(lightOf("{}"), Light{});
  EXPECT_EQ(lightOf(R"({"light": {}})"), Light{});
  for (const Sky each : allSkies)
    EXPECT_EQ(lightOf(fmt::format(R"({{"light": "{}"}})", nameOf(each))), Light{.sky = each});
  const Light all{.sky = Sky::evening, .sun = glm::vec2(-2, 0.25f), .exposure = 1.5f, .fog = 60};
  EXPECT_EQ(lightOf(R"({"light": {"sky": "evening", "sun": [-2, 0.25], "exposure": 1.5, "fog": 60}})"), all);
  const Scene plain;
  EXPECT_EQ(sceneJson(plain).find("light"), std::string::npos);
}

TEST(Scene, CamerasThatOrbitAndGoAlongPaths) {
  const Scene orbit = parseScene(R"({"camera": {"kind": "orbit", "distance": 20, "elevation": -0.5,
                                                "azimuth": 1, "secondsATurn": -7}})",
                                 "orbit.json", "");
  EXPECT_EQ(orbit.camera.kind, Camera::Kind::orbit);
  EXPECT_EQ(orbit.camera.distance, 20);
  EXPECT_EQ(orbit.camera.elevation, -0.5f);
  EXPECT_EQ(orbit.camera.azimuth, 1);
  EXPECT_EQ(orbit.camera.secondsATurn, -7);
  EXPECT_FALSE(orbit.camera.about);
  const Scene about = parseScene(R"({"camera": {"kind": "orbit", "about": [1, 2, 3]}})", "about.json", "");
  EXPECT_EQ(about.camera.about, glm::vec3(1, 2, 3));
  const Scene path = parseScene(R"({"camera": {"kind": "path", "keys": [
                                      {"time": 0.5, "position": [1, 2, 3], "target": [4, 5, 6]},
                                      {"time": 2, "position": [7, 8, 9], "target": [0, 0, 0]}]}})",
                                "path.json", "");
  const std::vector<CameraKey> keys{{.time = 0.5f, .position = {1, 2, 3}, .target = {4, 5, 6}},
                                    {.time = 2, .position = {7, 8, 9}}};
  EXPECT_EQ(path.camera.kind, Camera::Kind::path);
  EXPECT_EQ(path.camera.keys, keys);
}

TEST(Scene, EventsOfEveryKind) {
  const Scene scene = parseScene(R"({"events": [
    {"mound": {"radius": 2}},
    {"at": 1, "goal": {"kind": "none"}},
    {"at": 1, "herd": 2, "agents": [3, 1], "goal": {"kind": "point", "target": [5, 6]}},
    {"at": 2, "herd": 1, "agents": [9], "speed": 0.5},
    {"at": 3, "herd": 1, "teleport": [{"agent": 4, "position": [1, -2], "heading": 1.5}, {"agent": 0}]},
    {"at": 4, "herd": 1, "add": [{"position": [7, 8], "heading": -1}, {"goal": {"kind": "none"}}]},
    {"at": 5, "remove": [2, 7]},
    {"at": 6, "addHerd": {"agents": 5, "reserve": 1, "rig": "crab.glb", "goal": {"kind": "none"}}},
    {"at": 7, "removeHerd": 3},
    {"at": 8, "herd": 1, "agents": [2], "leg": "L3"},
    {"at": 9, "share": 0.25, "leg": "R2", "state": "lame"},
    {"at": 9, "leg": "R1", "state": "lost", "bone": 3},
    {"at": 10, "herd": 1, "agents": [2], "push": [1, -2]},
    {"at": 11, "share": 0.5, "push": [0, 3]},
    {"at": 12, "herd": 1, "agents": [2], "load": {"mass": 0.5, "offset": [0, 0.1, -0.2]}},
    {"at": 13, "share": 0.5, "load": {}}
  ]})",
                                 "events.json", "folder");
  const Goal none{.kind = Goal::Kind::none}, point{.kind = Goal::Kind::point, .target = {5, 6}};
  Herd crabs;
  crabs.rig = "folder/crab.glb";
  crabs.agents = 5;
  crabs.reserve = 1;
  crabs.goal = none;
  const std::vector<Event> expected{
      {0, Mound{.radius = 2}},
      {1, GoalChange{.goal = none}},
      {1, GoalChange{.herd = 2, .agents = {3, 1}, .goal = point}},
      {2, SpeedChange{.herd = 1, .agents = {9}, .speed = 0.5f}},
      {3, Teleport{.herd = 1, .moves = {{4, {{1, -2}, 1.5f}}, {0, {}}}}},
      {4, Addition{.herd = 1, .arrivals = {{.place = {{7, 8}, -1}}, {.goal = none}}}},
      {5, Removal{.agents = {2, 7}}},
      {6, HerdAddition{crabs}},
      {7, HerdRemoval{3}},
      {8, LegChange{.herd = 1, .agents = {2}, .leg = "L3"}},
      {9, LegChange{.share = 0.25f, .leg = "R2", .state = LegState::lame}},
      {9, LegChange{.leg = "R1", .bone = 3}},
      {10, Push{.herd = 1, .agents = {2}, .velocity = {1, -2}}},
      {11, Push{.share = 0.5f, .velocity = {0, 3}}},
      {12, LoadChange{.herd = 1, .agents = {2}, .load = {.mass = 0.5f, .offset = {0, 0.1f, -0.2f}}}},
      {13, LoadChange{.share = 0.5f}},
  };
  ASSERT_EQ(scene.events.size(), expected.size());
  for (size_t e = 0; e < expected.size(); ++e) EXPECT_TRUE(scene.events[e] == expected[e]) << e;
}

TEST(Scene, ObstaclesOfEveryShape) {
  const Scene scene = parseScene(R"({
    "obstacles": [{"disc": {"centre": [1, -2], "radius": 3}},
                  {"capsule": {"from": [0, 1], "to": [4, 5], "radius": 0.5}},
                  {"polygon": {"corners": [[0, 0], [0, 2], [2, 2], [2, 0]]}}],
    "herds": [{"ways": {}}, {"ways": {"climb": 0, "steepest": 2, "step": 0.1}}, {}]
  })",
                                 "walls.json", "");
  const std::vector<Obstacle> expected{
      {Disc{.centre = {1, -2}, .radius = 3}},
      {Capsule{.from = {0, 1}, .to = {4, 5}, .radius = 0.5f}},
      {ConvexPolygon{.corners = {{0, 0}, {0, 2}, {2, 2}, {2, 0}}}},
  };
  EXPECT_EQ(scene.obstacles, expected);
  EXPECT_EQ(scene.herds[0].ways, Ways{});
  EXPECT_EQ(scene.herds[1].ways, (Ways{.climb = 0, .steepest = 2, .step = 0.1f}));
  EXPECT_FALSE(scene.herds[2].ways);
}

TEST(Scene, ForagersOfAHerd) {
  const Scene scene = parseScene(R"({"herds": [{"forage": {}}, {"forage": {
    "nest": {"centre": [1, -2], "radius": 3}, "food": [{"centre": [5, 6], "amount": 7}, {"radius": 4}],
    "branches": [{"radius": 2}], "cell": 1, "threshold": 15, "power": 3, "layHome": 4, "layOut": 0.5, "life": 30,
    "patience": 9, "rest": 0}}, {}]})",
                                 "ants.json", "");
  const Forage expected{.nest = {.centre = {1, -2}, .radius = 3},
                        .food = {{.centre = {5, 6}, .amount = 7}, {.radius = 4}},
                        .branches = {{.radius = 2}},
                        .cell = 1,
                        .threshold = 15,
                        .power = 3,
                        .layHome = 4,
                        .layOut = 0.5f,
                        .life = 30,
                        .patience = 9,
                        .rest = 0};
  EXPECT_EQ(scene.herds[0].forage, Forage{});
  EXPECT_EQ(scene.herds[1].forage, expected);
  EXPECT_FALSE(scene.herds[2].forage);
}

TEST(Scene, LooksOfAHerd) {
  const auto herd = [](const char* keys) {
    return parseScene(fmt::format(R"({{"herds": [{{{}}}]}})", keys), "looks.json", "").herds.at(0);
  };
  EXPECT_TRUE(herd("").sizes.empty());
  EXPECT_EQ(herd(R"("sizes": [0.6, 1, 0.05, 20])").sizes, (std::vector<float>{0.6f, 1, 0.05f, 20}));
  EXPECT_FALSE(herd(R"("phase": "random")").phase);
  EXPECT_EQ(herd(R"("phase": "together")").phase, 0);
  EXPECT_EQ(herd(R"("phase": 0.25)").phase, 0.25f);
  EXPECT_EQ(herd(R"("tint": 1)").tint, 1);
  EXPECT_EQ(herd(R"("colour": [0.1, 0.2, 1])").colour, glm::vec3(0.1f, 0.2f, 1));
  // sRGB: 0x80 is 0.2158605, 0x0a is below the straight part's end: 10 / 255 / 12.92.
  const glm::vec3 hex = herd(R"("colour": "#80FF0a")").colour.value();
  EXPECT_LT(glm::distance(hex, glm::vec3(0.2158605f, 1, 10 / 255.0f / 12.92f)), 1e-6f);
}

TEST(Scene, WholeNumbersHoweverTheyAreWritten) {
  const std::pair<const char*, uint64_t> cases[] = {{"-0", 0}, {"-0.0", 0}, {"7.0", 7}, {"1e3", 1000}};
  for (const auto& [number, expected] : cases) {
    const Scene scene =
        parseScene(fmt::format(R"({{"herds": [{{"agents": {}}}]}})", number), "whole.json", "");
    EXPECT_EQ(scene.agentCount(), expected) << number;
  }
}

TEST(Scene, FaultsNameFileAndField) {
  const std::pair<const char*, const char*> cases[] = {
      {R"([])", "the scene"},
      {R"({"sed": 1})", "sed is no known key"},
      {R"({"seed": -1})", "seed is -1"},
      {R"({"seed": 1e308})", "seed is 1e+308, expected a whole number from 0 to 18446744073709551615"},
      {R"({"seed": 1.5})", "seed is 1.5"},
      {R"({"name": 5})", "name is 5"},
      {R"({"herds": {}})", "herds is an object"},
      {R"({"herds": [5]})", "herds[0] is 5"},
      {R"({"herds": [{}, {"agents": "many"}]})", "herds[1].agents is \"many\""},
      {R"({"herds": [{"agents": -1}]})", "herds[0].agents is -1"},
      {R"({"herds": [{"agents": 16777217}]})", "herds[0].agents is 16777217"},
      {R"({"herds": [{"agents": 16777216}, {"agents": 1}]})", "16777217 agents in all"},
      {R"({"herds": [{"controller": "magic"}]})", "herds[0].controller is \"magic\""},
      {R"({"herds": [{"spawn": {"spacing": 0}}]})", "herds[0].spawn.spacing is 0"},
      {R"({"herds": [{"spawn": {"spacing": 1e400}}]})", "number overflow"},
      {R"({"herds": [{"spawn": {"spacing": null}}]})", "herds[0].spawn.spacing is null"},
      {R"({"herds": [{"spawn": {"kind": "ring"}}]})", "herds[0].spawn.kind is \"ring\""},
      {R"({"herds": [{"spawn": {"centre": [1]}}]})", "herds[0].spawn.centre is an array of 1"},
      {R"({"herds": [{"spawn": {"centre": [1, 4097]}}]})", "herds[0].spawn.centre[1] is 4097"},
      {R"({"herds": [{"spawn": {"center": [1, 2]}}]})", "herds[0].spawn.center is no known key"},
      {R"({"herds": [{"goal": {"speed": -0.5}}]})", "herds[0].goal.speed is -0.5"},
      {R"({"herds": [{"goal": {"velocity": [800, 800]}}]})", "herds[0].goal.velocity is 1131.37 m/s long"},
      {R"({"herds": [{"agents": 9, "reserve": 16777210}]})", "16777219 agents in all"},
      {R"({"terrain": {"columns": 1}})", "terrain.columns is 1"},
      {R"({"terrain": {"rows": 16385}})", "terrain.rows is 16385"},
      {R"({"terrain": {"octaves": 0}})", "terrain.octaves is 0"},
      {R"({"terrain": {"file": "a.png"}})", "terrain.file is no known key"},
      {R"({"terrain": {"kind": "file"}})", "terrain.file is missing"},
      {R"({"terrain": {"kind": "file", "file": "a.png", "scale": -1}})", "terrain.scale is -1"},
      {R"({"terrain": {"kind": "file", "file": "a.png", "exaggeration": 1001}})",
       "terrain.exaggeration is 1001"},
      {R"({"terrain": {"kind": "file", "file": "a.r16", "columns": 1}})", "terrain.columns is 1"},
      {R"({"terrain": {"kind": "file", "file": "a.r16", "rows": 2.5}})", "terrain.rows is 2.5"},
      {R"({"terrain": {"kind": "file", "file": "a.r16", "voidValue": "0"}})", "terrain.voidValue is \"0\""},
      {R"({"camera": {"fieldOfView": 7}})", "camera.fieldOfView is 7"},
      {R"({"camera": {"kind": "fixed"}})", "camera.position equals camera.target"},
      {R"({"herds": [{"phase": "togeter"}]})",
       "\"togeter\"; did you mean together? Expected one of \"random\""},
      {R"({"herds": [{"avoid": 1}]})", "herds[0].avoid is 1, expected true or false"},
      {R"({"herds": [{"phase": 1.5}]})", "herds[0].phase is 1.5, expected a number from 0 to 1"},
      {R"({"herds": [{"sizes": 2}]})", "herds[0].sizes is 2, expected an array of at most 16 numbers"},
      {R"({"herds": [{"sizes": [1, 0.04]}]})",
       "herds[0].sizes[1] is 0.04, expected a number from 0.05 to 20"},
      {R"({"herds": [{"sizes": [20.1]}]})", "herds[0].sizes[0] is 20.1"},
      {R"({"herds": [{"sizes": [1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1]}]})", "herds[0].sizes is an array of 17"},
      {R"({"herds": [{"tint": -1}]})", "herds[0].tint is -1"},
      {R"({"herds": [{"colour": "red"}]})", "herds[0].colour is \"red\", expected \"#rrggbb\""},
      {R"({"herds": [{"colour": "#12345g"}]})", "herds[0].colour is \"#12345g\""},
      {R"({"herds": [{"colour": [0, 1]}]})", "herds[0].colour is an array of 2"},
      {R"({"herds": [{"colour": [0, 1, 2]}]})", "herds[0].colour[2] is 2, expected a number from 0 to 1"},
      {R"({"camera": {"kind": "path"}})", "camera.keys has 0, expected at least 2"},
      {R"({"camera": {"kind": "path", "keys": [{"position": [0, 1, 0]}]}})", "camera.keys has 1"},
      {R"({"camera": {"keys": [{"position": [0, 1, 0], "target": [0, 1, 0]}]}})",
       "camera.keys[0].position equals camera.keys[0].target"},
      {R"({"camera": {"keys": [{"time": 2, "position": [0, 1, 0]}, {"time": 2, "position": [0, 1, 0]}]}})",
       "camera.keys[1].time is 2, expected at least 2.015625"},
      {R"({"camera": {"keys": [{"time": -1, "position": [0, 1, 0]}]}})", "camera.keys[0].time is -1"},
      {R"({"camera": {"elevation": 1.6}})", "camera.elevation is 1.6"},
      {R"({"camera": {"about": [0, 1]}})", "camera.about is an array of 2"},
      {R"({"light": "nigth"})", "light is \"nigth\"; did you mean night? Expected one of \"day\""},
      {R"({"light": 3})", "light is 3, expected an object"},
      {R"({"light": {"sky": "blue"}})", "light.sky is \"blue\", expected one of \"day\""},
      {R"({"light": {"fgo": 9}})", "light.fgo is no known key; did you mean fog?"},
      {R"({"light": {"sun": 1}})", "light.sun is 1, expected an array of 2 numbers"},
      {R"({"light": {"sun": [0, 0.05]}})",
       "light.sun[1] is 0.05, expected an elevation from 0.1 to 1.5708 radians"},
      {R"({"light": {"exposure": 0}})", "light.exposure is 0, expected a number from 0.05"},
      {R"({"light": {"fog": 4}})", "light.fog is 4, expected a number from 5 to 100000"},
      {R"({"events": {}})", "events is an object, expected an array of at most 4096 events"},
      {R"({"events": [{"at": -1, "mound": {}}]})", "events[0].at is -1"},
      {R"({"events": [{"at": 1}]})",
       "events[0] has 0 of mound, edit, goal, speed, teleport, add, remove, addHerd, removeHerd, threat, "
       "leg, push, load, expected one"},
      {R"({"events": [{"mound": {}, "edit": {"columns": 1, "rows": 1, "heights": [0]}}]})",
       "events[0] has 2 of mound, edit"},
      {R"({"events": [{"mond": {}, "mound": {}}]})", "events[0].mond is no known key; did you mean mound?"},
      {R"({"events": [{"at": 2, "mound": {}}, {"at": 1, "mound": {}}]})",
       "events[1].at is 1, expected 2 or later"},
      {R"({"events": [{"mound": {"radius": 0}}]})", "events[0].mound.radius is 0"},
      {R"({"events": [{"edit": {"columns": 2, "rows": 2, "heights": [0, 1, 2]}}]})",
       "events[0].edit.heights has 3 numbers, expected 4"},
      {R"({"events": [{"edit": {"x": 16384, "columns": 1, "rows": 1, "heights": [0]}}]})",
       "events[0].edit.x is 16384"},
      {R"({"events": [{"herd": 0, "gaol": {}}]})", "events[0].gaol is no known key; did you mean goal?"},
      {R"({"events": [{"herd": 0, "mound": {}}]})", "events[0].herd is no known key"},
      {R"({"events": [{"herd": 0, "goal": {}, "speed": 1}]})", "events[0] has 2 of mound, edit, goal, speed"},
      {R"({"events": [{"herd": 1024, "speed": 1}]})",
       "events[0].herd is 1024, expected a whole number from 0 to 1023"},
      {R"({"events": [{"agents": 3, "speed": 1}]})",
       "events[0].agents is 3, expected an array of 1 to 65536"},
      {R"({"events": [{"agents": [], "speed": 1}]})", "events[0].agents is an array of 0"},
      {R"({"events": [{"agents": [0, 1.5], "speed": 1}]})",
       "events[0].agents[1] is 1.5, expected a whole number from 0 to 16777215"},
      {R"({"events": [{"speed": 1001}]})", "events[0].speed is 1001, expected a number from 0 to 1000"},
      {R"({"events": [{"goal": {"knd": "none"}}]})",
       "events[0].goal.knd is no known key; did you mean kind?"},
      {R"({"events": [{"goal": {"velocity": [800, 800]}}]})", "events[0].goal.velocity is 1131.37 m/s long"},
      {R"({"events": [{"teleport": []}]})", "events[0].teleport is empty, expected at least one agent"},
      {R"({"events": [{"teleport": [{"position": [1, 2]}]}]})", "events[0].teleport[0].agent is missing"},
      {R"({"events": [{"teleport": [{"agent": 1, "positon": [1, 2]}]}]})",
       "events[0].teleport[0].positon is no known key; did you mean position?"},
      {R"({"events": [{"teleport": [{"agent": 1, "position": [1, 4097]}]}]})",
       "events[0].teleport[0].position[1] is 4097"},
      {R"({"events": [{"agents": [1], "teleport": [{"agent": 1}]}]})", "events[0].agents is no known key"},
      {R"({"events": [{"leg": ""}]})", "events[0].leg is \"\", expected a string that is not empty"},
      {R"({"events": [{"leg": "R2", "state": "lots"}]})",
       "events[0].state is \"lots\"; did you mean lost? Expected one of \"whole\""},
      {R"({"events": [{"leg": "R2", "share": 2}]})", "events[0].share is 2, expected a number from 0 to 1"},
      {R"({"events": [{"leg": "R2", "share": 1, "agents": [2]}]})", "events[0] has agents and a share"},
      {R"({"events": [{"load": {"mass": 5}}]})", "events[0].load.mass is 5, expected a number from 0 to 4"},
      {R"({"events": [{"load": {"mass": -1}}]})", "events[0].load.mass is -1, expected a number from 0 to 4"},
      {R"({"herds": [{"forage": {"load": {"mass": 5}}}]})", "herds[0].forage.load.mass is 5"},
      {R"({"events": [{"load": 1}]})", "events[0].load is 1, expected an object"},
      {R"({"events": [{"load": {"mass": 1, "offset": [0, 3, 0]}}]})", "events[0].load.offset[1] is 3"},
      {R"({"events": [{"load": {"weight": 1}}]})", "events[0].load.weight is no known key"},
      {R"({"events": [{"load": {}, "share": 1, "agents": [2]}]})", "events[0] has agents and a share"},
      {R"({"herds": [{"hurt": 1}]})", "herds[0].hurt is 1, expected true or false"},
      {R"({"events": [{"add": {}}]})",
       "events[0].add is an object, expected an array of at most 65536 agents"},
      {R"({"events": [{"add": []}]})", "events[0].add is empty, expected at least one agent"},
      {R"({"events": [{"add": [{"heading": 1001}]}]})", "events[0].add[0].heading is 1001"},
      {R"({"events": [{"add": [{"goal": {"speed": -1}}]}]})", "events[0].add[0].goal.speed is -1"},
      {R"({"events": [{"remove": []}]})", "events[0].remove is an array of 0"},
      {R"({"events": [{"remove": [0, -1]}]})", "events[0].remove[1] is -1"},
      {R"({"events": [{"addHerd": 3}]})", "events[0].addHerd is 3, expected an object"},
      {R"({"events": [{"addHerd": {"agent": 3}}]})",
       "events[0].addHerd.agent is no known key; did you mean agents?"},
      {R"({"events": [{"addHerd": {"goal": {"speed": -1}}}]})", "events[0].addHerd.goal.speed is -1"},
      {R"({"events": [{"herd": 1, "addHerd": {}}]})", "events[0].herd is no known key"},
      {R"({"events": [{"removeHerd": 1024}]})",
       "events[0].removeHerd is 1024, expected a whole number from 0 to 1023"},
      {R"({"events": [{"removeHerd": 1, "addHerd": {}}]})", "events[0] has 2 of mound, edit, goal"},
      {R"({"herds": [{"ways": true}]})", "herds[0].ways is true, expected an object"},
      {R"({"herds": [{"ways": {"climb": -1}}]})",
       "herds[0].ways.climb is -1, expected a number from 0 to 100"},
      {R"({"herds": [{"ways": {"steepest": 0}}]})", "herds[0].ways.steepest is 0"},
      {R"({"herds": [{"forage": {"power": 5}}]})",
       "herds[0].forage.power is 5, expected a whole number from 1 to 4"},
      {R"({"herds": [{"forage": {"food": [{"amont": 1}]}}]})",
       "herds[0].forage.food[0].amont is no known key; did you mean amount?"},
      {R"({"herds": [{"ways": {"stp": 1}}]})", "herds[0].ways.stp is no known key; did you mean step?"},
      {R"({"obstacles": {}})", "obstacles is an object, expected an array of at most 4096 obstacles"},
      {R"({"obstacles": [{}]})", "obstacles[0] has 0 of disc, capsule, polygon, expected one"},
      {R"({"obstacles": [{"disc": {"radius": 0}}]})",
       "obstacles[0].disc.radius is 0, expected a number from 0.01 to 4096"},
      {R"({"obstacles": [{"disc": {"centre": [0, 4097]}}]})", "obstacles[0].disc.centre[1] is 4097"},
      {R"({"obstacles": [{"capsule": {"radius": -1}}]})", "obstacles[0].capsule.radius is -1"},
      {R"({"obstacles": [{"capsule": {"form": [0, 1]}}]})",
       "obstacles[0].capsule.form is no known key; did you mean from?"},
      {R"({"obstacles": [{"polygon": {}}]})", "obstacles[0].polygon.corners has 0, expected 3 to 64"},
      {R"({"obstacles": [{"polygon": {"corners": [[0, 0], [1, 0, 2]]}}]})",
       "obstacles[0].polygon.corners[1] is an array of 3, expected an array of 2 numbers"},
      {R"({"obstacles": [{"polygon": {"corners": [[0, 0], [1, 0], [2, 0]]}}]})",
       "obstacles[0].polygon.corners is not convex: [2] is on the wrong side of the edge from [0] to [1]"},
      {R"({"obstacles": [{"disc": {}}, {"polygon": {"corners": [[0, 0], [4, 0], [1, 1], [0, 4]]}}]})",
       "obstacles[1].polygon.corners is not convex: [3] is on the wrong side of the edge from [1] to [2]"},
      // A star turns one way at every corner.
      {R"({"obstacles": [{"polygon": {"corners": [[0, 10], [6, -8], [-9, 3], [9, 3], [-6, -8]]}}]})",
       "obstacles[0].polygon.corners is not convex"},
      {R"({"levels": {"distances": [1, 2]}})",
       "levels.distances is an array of 2, expected an array of 3 numbers"},
      {R"({"levels": {"distances": [1, 3, 2]}})", "levels.distances[2] is 2, expected at least 3"},
      {R"({"levels": {"most": [1, 2, -3]}})", "levels.most[2] is -3, expected a whole number from 0 to"},
      {R"({"levels": {"rates": [1]}})", "levels.rates is no known key, expected one of distances, most"},
      {R"({"threats": [{"radius": -1}]})", "threats[0].radius is -1, expected a number from 0 to 4096"},
      {R"({"herds": [{"threat": -1}]})", "herds[0].threat is -1, expected a number from 0 to 4096"},
      {R"({"events": [{"threat": {"number": 64}}]})",
       "events[0].threat.number is 64, expected a whole number from 0 to 63"},
      {R"({"events": [{"threat": {"raduis": 2}}]})",
       "events[0].threat.raduis is no known key; did you mean radius?"},
      {R"({"herds": [{"goal": {"kind": "route"}}]})",
       "herds[0].goal.places is empty, kind \"route\" needs 1 to 16"},
      {R"({"herds": [{"goal": {"places": [[0, 5000]]}}]})", "herds[0].goal.places[0][1] is 5000"},
      {R"({"herds": [{"goal": {"radius": 0}}]})", "herds[0].goal.radius is 0"},
      {R"({"herds": [{"goal": {"kind": "point", "target": [NaN, 0]}}]})", "line 1"},
      {R"({"herds": [{"goal": {"kind": "point", "target": [null, 0]}}]})",
       "herds[0].goal.target[0] is null, expected a number from -4096 to 4096"},
      {R"({"herds": [{"goal": {"kind": "route", "places": [[0, 1], [0, 1e999]]}}]})", "number overflow"},
      {R"({"herds": [{"goal": {"velocity": ["nan", 0]}}]})", "herds[0].goal.velocity[0] is \"nan\""},
      {R"({"seed": 1, "seed": 2})", "\"seed\" appears twice"},
      {R"({"seed": NaN})", "line 1"},
      {"", "not valid JSON"},
      {"{\"a\n\": 1}", "not valid JSON"},
  };
  for (const auto& [json, expected] : cases) {
    const std::string what = inputFault([&, text = json] { parseScene(text, "bad.json", ""); });
    EXPECT_NE(what.find("bad.json: "), std::string::npos) << what;
    EXPECT_NE(what.find(expected), std::string::npos) << what << "\nexpected: " << expected;
  }
  const std::string deep = std::string(100000, '[') + std::string(100000, ']');
  EXPECT_NE(inputFault([&] { parseScene(deep, "deep.json", ""); }).find("nested"), std::string::npos);
}

TEST(Scene, FilesAreRefusedByName) {
  test::TemporaryFolder folder;
  EXPECT_NE(inputFault([&] { loadScene(folder / "none.json"); }).find("none.json: no such file"),
            std::string::npos);
  EXPECT_NE(inputFault([&] { loadScene(folder.path()); }).find("is a directory"), std::string::npos);
  test::writeText(folder / "scene.json", R"({"terrain": {"kind": "file", "file": "none.png"}})");
  const Scene scene = loadScene(folder / "scene.json");
  EXPECT_NE(inputFault([&] { scene.loadTerrain(); }).find((folder / "none.png").string()), std::string::npos);
}

TEST(Scene, TerrainFileIsRelativeToTheScene) {
  test::TemporaryFolder folder;
  test::writePng(folder / "flat.png", 4, 3, 8, std::vector<uint16_t>(12, 9));
  test::writeText(folder / "scene.json", R"({"terrain": {"kind": "file", "file": "flat.png"}})");
  EXPECT_EQ(loadScene(folder / "scene.json").loadTerrain().columns, 4u);
}

Herd herdWith(const char* key, const std::string& value) {
  return parseScene(fmt::format(R"({{"herds": [{{"{}": "{}"}}]}})", key, value), "names", {}).herds.at(0);
}

TEST(Scene, knowsEveryNameOfAHerdsChoices) {
  for (const Controller each : allControllers) {
    EXPECT_EQ(controllerNamed(nameOf(each)), each);
    EXPECT_EQ(herdWith("controller", nameOf(each)).controller, each);
  }
  EXPECT_EQ(herdWith("controller", "pose").controller, Controller::keyPoses);  // its earlier name
  for (const Stepping each : allSteppings) {
    EXPECT_EQ(steppingNamed(nameOf(each)), each);
    EXPECT_EQ(herdWith("stepping", nameOf(each)).stepping, each);
  }
  for (const Solver each : herdSolvers) EXPECT_EQ(herdWith("solver", nameOf(each)).solver, each);
  for (const Solver each : allSolvers) {
    EXPECT_EQ(solverNamed(nameOf(each)), each);
    if (std::find(herdSolvers.begin(), herdSolvers.end(), each) == herdSolvers.end()) {
      EXPECT_THROW(herdWith("solver", nameOf(each)), Error) << nameOf(each);
    }
  }
  EXPECT_FALSE(controllerNamed("magic"));
  EXPECT_FALSE(controllerNamed(""));
  EXPECT_EQ(namesOf(allSteppings), "gait, reach");
}

}  // namespace
}  // namespace skitter
