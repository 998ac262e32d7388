#include "skitter/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <type_traits>

#include "assets/files/file.h"
#include "assets/files/json.h"
#include "assets/heights/heightfield_limits.h"
#include "assets/scenes/obstacles.h"
#include "assets/scenes/scene_reader.h"
#include "assets/scenes/scene_writer.h"
#include "embedded/crossing_json.h"
#include "skitter/error.h"
#include "skitter/rig.h"

namespace skitter::scenes {

constexpr double cameraLimit = 1e5;  // metres
constexpr double maxAzimuth = 1000;  // radians
constexpr size_t maxCuts = 64;
constexpr double maxVoidValue = std::numeric_limits<double>::max();

// keysOf(fields, object) lists the keys of each object of a scene, once for both directions: a Reader sets
// the members, a Writer writes them. Bindings name all members, so that a new one does not compile until it
// is looked at here. checkKeys(object, where) refuses what no single key shows.
template <class Fields>
void keysOf(Fields& fields, TerrainNoise& noise) {
  auto& [columns, rows, spacing, amplitude, wavelength, octaves, gain, seed] = noise;
  fields.integer("columns", columns, minSamples, maxSamples);
  fields.integer("rows", rows, minSamples, maxSamples);
  fields.key("spacing", spacing, minSpacing, maxSpacing);
  fields.key("amplitude", amplitude, 0, Scene::maxCoordinate);
  fields.key("wavelength", wavelength, minSpacing, maxHeightMagnitude);
  fields.integer("octaves", octaves, 1, TerrainNoise::maxOctaves);
  fields.key("gain", gain, 0, 1);
  fields.integer("seed", seed, 0, UINT64_MAX);
}

template <class Fields>
void keysOf(Fields& fields, TerrainFile& terrain) {
  auto& [file, units] = terrain;
  auto& [spacingX, spacingZ, minHeight, maxHeight, scale, exaggeration, columns, rows, voidValue] = units;
  fields.file("file", file);
  fields.key("spacingX", spacingX, minSpacing, maxSpacing);
  fields.key("spacingZ", spacingZ, minSpacing, maxSpacing);
  fields.key("minHeight", minHeight, -maxHeightMagnitude, maxHeightMagnitude);
  fields.key("maxHeight", maxHeight, -maxHeightMagnitude, maxHeightMagnitude);
  fields.key("scale", scale, minScale, maxScale);
  fields.key("exaggeration", exaggeration, 0, maxExaggeration);
  fields.key("voidValue", voidValue, -maxVoidValue, maxVoidValue);
  fields.integer("columns", columns, minSamples, maxSamples);
  fields.integer("rows", rows, minSamples, maxSamples);
}

template <class Fields>
void keysOf(Fields& fields, decltype(Scene::terrain)& terrain) {
  size_t kind = terrain.index();
  fields.kind("kind", kind, {"noise", "file"});
  if (kind != terrain.index()) terrain = TerrainFile{};
  std::visit([&](auto& each) { keysOf(fields, each); }, terrain);
}
void checkKeys(const decltype(Scene::terrain)& terrain, const std::string& file, const std::string& path) {
  const auto* named = std::get_if<TerrainFile>(&terrain);
  if (named && named->file.empty())
    throw inputError(fmt::format("{}: {}.file is missing, kind \"file\" needs it", file, path));
}

template <class Fields>
void keysOf(Fields& fields, ClipCut& cut) {
  auto& [clip, name, from, to] = cut;
  fields.key("clip", clip);
  fields.key("name", name);
  fields.key("from", from, 0, Clip::maxSeconds);
  fields.key("to", to, 0, Clip::maxSeconds);
}
void checkKeys(const ClipCut& cut, const std::string& file, const std::string& path) {
  if (cut.name.empty()) throw inputError(fmt::format("{}: {}.name is missing", file, path));
  if (!(cut.from < cut.to))
    throw inputError(
        fmt::format("{}: {}.to is {}, expected more than from, {}", file, path, cut.to, cut.from));
}

template <class Fields>
void keysOf(Fields& fields, Tuning& tuning) {
  for (const TuningInfo& info : allTunings) fields.key(info, tuning);
}
void checkKeys(const Tuning& tuning, const std::string& file, const std::string& path) {
  checkTuning(tuning, fmt::format("{}: {}", file, path));
}

template <class Fields>
void keysOf(Fields& fields, Spawn& spawn) {
  auto& [kind, spacing, centre, heading] = spawn;
  fields.kind("kind", kind, {"lanes", "grid"});
  fields.key("spacing", spacing, 0.01, Scene::maxCoordinate);
  fields.key("centre", centre, Scene::maxCoordinate);
  fields.key("heading", heading, -1000, 1000);
}

template <class Fields>
void keysOf(Fields& fields, Goal& goal) {
  auto& [kind, target, speed, velocity, places, loop, radius, leader, agent] = goal;
  fields.kind("kind", kind, {"cross", "point", "none", "velocity", "route", "roam", "follow", "flee"});
  fields.key("target", target, Scene::maxCoordinate);
  fields.key("speed", speed, 0, double{Goal::maxSpeed});
  fields.key("velocity", velocity, double{Goal::maxSpeed});
  fields.places("places", places, Goal::maxPlaces, Scene::maxCoordinate);
  fields.key("loop", loop);
  fields.key("radius", radius, Disc::minRadius, Scene::maxCoordinate);
  fields.integer("herd", leader, 0, Scene::maxHerds - 1);
  fields.integer("agent", agent, 0, Scene::maxAgents - 1);
}
void checkKeys(const Goal& goal, const std::string& file, const std::string& path) {
  if (goal.kind == Goal::Kind::route && goal.places.empty())
    throw inputError(
        fmt::format("{}: {}.places is empty, kind \"route\" needs 1 to {}", file, path, Goal::maxPlaces));
  if (glm::length(goal.velocity) > Goal::maxSpeed)
    throw inputError(fmt::format("{}: {}.velocity is {:.6g} m/s long, expected at most {:.6g}", file, path,
                                 glm::length(goal.velocity), Goal::maxSpeed));
}

template <class Fields>
void keysOf(Fields& fields, Ways& ways) {
  auto& [climb, steepest, step] = ways;
  fields.key("climb", climb, 0, Ways::maxClimb);
  fields.key("steepest", steepest, Ways::minLimit, Ways::maxLimit);
  fields.key("step", step, Ways::minLimit, Ways::maxLimit);
}

template <class Fields>
void keysOf(Fields& fields, Disc& disc) {
  auto& [centre, radius] = disc;
  fields.key("centre", centre, Scene::maxCoordinate);
  fields.key("radius", radius, Disc::minRadius, Scene::maxCoordinate);
}
template <class Fields>
void keysOf(Fields& fields, Capsule& capsule) {
  auto& [from, to, radius] = capsule;
  fields.key("from", from, Scene::maxCoordinate);
  fields.key("to", to, Scene::maxCoordinate);
  fields.key("radius", radius, 0, Scene::maxCoordinate);
}
template <class Fields>
void keysOf(Fields& fields, ConvexPolygon& polygon) {
  auto& [corners] = polygon;
  fields.places("corners", corners, ConvexPolygon::maxCorners, Scene::maxCoordinate);
}
template <class Fields>
void keysOf(Fields& fields, FoodSource& source) {
  auto& [centre, radius, amount] = source;
  fields.key("centre", centre, Scene::maxCoordinate);
  fields.key("radius", radius, Disc::minRadius, Scene::maxCoordinate);
  fields.integer("amount", amount, 0, FoodSource::maxAmount);
}
template <class Fields>
void keysOf(Fields& fields, Load& load) {
  auto& [mass, offset] = load;
  fields.key("mass", mass, 0, double{Load::maxMass});
  fields.key("offset", offset, double{Load::maxOffset});
}
template <class Fields>
void keysOf(Fields& fields, Forage& forage) {
  auto& [nest, food, branches, cell, threshold, power, layHome, layOut, life, patience, rest, load] = forage;
  fields.object("nest", nest);
  fields.objects("food", food, Forage::maxSources, "sources");
  fields.objects("branches", branches, Forage::maxBranches, "discs");
  fields.key("cell", cell, Forage::minCell, Forage::maxCell);
  fields.key("threshold", threshold, 0, Forage::maxThreshold);
  fields.integer("power", power, 1, Forage::maxPower);
  fields.key("layHome", layHome, 0, Forage::maxLaid);
  fields.key("layOut", layOut, 0, Forage::maxLaid);
  fields.key("life", life, Forage::minLife, Forage::maxLife);
  fields.integer("patience", patience, 1, Forage::maxPatience);
  fields.key("rest", rest, 0, Forage::maxRest);
  fields.object("load", load);
}
// The keys of an obstacle, of which `key` says what it is.
template <class Fields, class Shape>
requires std::is_same_v<Shape, Disc> || std::is_same_v<Shape, Capsule> || std::is_same_v<Shape, ConvexPolygon>
void keysOf(Fields& fields, const char* key, Shape& shape) { fields.object(key, shape); }
template <class Fields>
void keysOf(Fields& fields, Threat& threat) {
  auto& [centre, radius] = threat;
  fields.key("centre", centre, Scene::maxCoordinate);
  fields.key("radius", radius, 0, Scene::maxCoordinate);
}
template <class Fields>
void keysOf(Fields& fields, ThreatChange& change) {
  auto& [number, threat] = change;
  fields.integer("number", number, 0, Scene::maxThreats - 1);
  keysOf(fields, threat);
}

template <class Fields>
void keysOf(Fields& fields, Obstacle& obstacle) {
  auto& [shape] = obstacle;
  fields.oneOf({"disc", "capsule", "polygon"}, shape);
}
void checkKeys(const Obstacle& obstacle, const std::string& file, const std::string& path) {
  checkObstacle(obstacle, fmt::format("{}: {}", file, path));
}

template <class Fields>
void keysOf(Fields& fields, Herd& herd) {
  auto& [rig, controller, clips, cuts, keys, solver, stepping, tuning, agents, reserve, spawn, goal, sizes,
         avoid, ways, threat, forage, phase, colour, tint, hurt, reactions, adapts] = herd;
  fields.file("rig", rig, "spider");
  fields.named("controller", controller, allControllers);
  fields.key("clips", clips);
  fields.objects("cuts", cuts, maxCuts, "objects");
  fields.integer("keys", keys, Herd::minKeys, Herd::maxKeys);
  fields.named("solver", solver, herdSolvers);
  fields.named("stepping", stepping, allSteppings);
  fields.object("tuning", tuning);
  fields.integer("agents", agents, 0, Scene::maxAgents);
  fields.integer("reserve", reserve, 0, Scene::maxAgents);
  fields.object("spawn", spawn);
  fields.object("goal", goal);
  fields.key("sizes", sizes, Herd::maxSizes, Herd::minSize, Herd::maxSize);
  fields.key("avoid", avoid);
  fields.object("ways", ways);
  fields.key("threat", threat, 0, Scene::maxCoordinate);
  fields.object("forage", forage);
  fields.phase("phase", phase);
  fields.colour("colour", colour);
  fields.key("tint", tint, 0, 1);
  fields.flag("hurt", hurt);
  fields.flag("reactions", reactions);
  fields.flag("adapts", adapts);
}

template <class Fields>
void keysOf(Fields& fields, CameraKey& key) {
  auto& [time, position, target] = key;
  fields.key("time", time, 0, Camera::maxPathTime);
  fields.key("position", position, cameraLimit);
  fields.key("target", target, cameraLimit);
}
void checkKeys(const CameraKey& key, const std::string& file, const std::string& path) {
  if (key.position == key.target)
    throw inputError(
        fmt::format("{}: {}.position equals {}.target, a camera needs a direction", file, path, path));
}

template <class Fields>
void keysOf(Fields& fields, Camera& camera) {
  auto& [kind, position, target, distance, fieldOfView, about, elevation, azimuth, secondsATurn, keys] =
      camera;
  fields.kind("kind", kind, {"follow", "fixed", "orbit", "path"});
  fields.key("position", position, cameraLimit);
  fields.key("target", target, cameraLimit);
  fields.key("distance", distance, 0.01, cameraLimit);
  fields.key("fieldOfView", fieldOfView, 0.01, 3.1);
  fields.key("about", about, cameraLimit);
  fields.key("elevation", elevation, -1.5, 1.5);
  fields.key("azimuth", azimuth, -1000, 1000);
  fields.key("secondsATurn", secondsATurn, -Camera::maxPathTime, Camera::maxPathTime);
  fields.objects("keys", keys, Camera::maxPathKeys, "objects");
}
void checkKeys(const Camera& camera, const std::string& file, const std::string& path) {
  if (camera.kind == Camera::Kind::fixed && camera.position == camera.target)
    throw inputError(
        fmt::format("{}: {}.position equals {}.target, a fixed camera needs a direction", file, path, path));
  if (camera.kind == Camera::Kind::path && camera.keys.size() < Camera::minPathKeys)
    throw inputError(fmt::format("{}: {}.keys has {}, expected at least {} for a path", file, path,
                                 camera.keys.size(), Camera::minPathKeys));
  for (size_t k = 1; k < camera.keys.size(); ++k) {
    const float least = camera.keys[k - 1].time + Camera::minPathStep;
    if (camera.keys[k].time < least)
      throw inputError(
          fmt::format("{}: {}.keys[{}].time is {}, expected at least {}, {} s after the key before", file,
                      path, k, camera.keys[k].time, least, Camera::minPathStep));
  }
}

template <class Fields>
void keysOf(Fields& fields, Light& light) {
  auto& [sky, sun, exposure, fog] = light;
  fields.named("sky", sky, allSkies);
  fields.key("sun", sun, maxAzimuth);
  fields.key("exposure", exposure, Light::minExposure, Light::maxExposure);
  fields.key("fog", fog, Light::minFog, Light::maxFog);
}
void checkKeys(const Light& light, const std::string& file, const std::string& path) {
  if (light.sun && !isWithin(light.sun->y, Light::minElevation, Light::maxElevation))
    throw inputError(fmt::format("{}: {}.sun[1] is {}, expected an elevation from {:.3g} to {:.5g} radians",
                                 file, path, light.sun->y, Light::minElevation, Light::maxElevation));
}

template <class Fields>
void keysOf(Fields& fields, Mound& mound) {
  auto& [centre, radius, height] = mound;
  fields.key("centre", centre, Scene::maxCoordinate);
  fields.key("radius", radius, 0.01, Scene::maxCoordinate);
  fields.key("height", height, -maxHeightMagnitude, maxHeightMagnitude);
}

template <class Fields>
void keysOf(Fields& fields, HeightSamples& samples) {
  auto& [x, z, columns, rows, heights] = samples;
  fields.integer("x", x, 0, maxSamples - 1);
  fields.integer("z", z, 0, maxSamples - 1);
  fields.integer("columns", columns, 1, maxSamples);
  fields.integer("rows", rows, 1, maxSamples);
  fields.key("heights", heights, Event::maxSamples, -maxHeightMagnitude, maxHeightMagnitude);
}
void checkKeys(const HeightSamples& samples, const std::string& file, const std::string& path) {
  const uint64_t expected = uint64_t{samples.columns} * samples.rows;
  if (samples.heights.size() != expected)
    throw inputError(fmt::format("{}: {}.heights has {} numbers, expected {}, columns times rows", file, path,
                                 samples.heights.size(), expected));
}

template <class Fields>
void keysOf(Fields& fields, Place& place) {
  auto& [position, heading] = place;
  fields.key("position", position, Scene::maxCoordinate);
  fields.key("heading", heading, -1000, 1000);
}

template <class Fields>
void keysOf(Fields& fields, Teleport::Move& move) {
  auto& [agent, place] = move;
  fields.integer("agent", agent, 0, Scene::maxAgents - 1);
  keysOf(fields, place);
}
void checkKeys(const Teleport::Move& move, const std::string& file, const std::string& path) {
  if (move.agent == Teleport::Move{}.agent)
    throw inputError(fmt::format("{}: {}.agent is missing", file, path));
}

template <class Fields>
void keysOf(Fields& fields, Addition::Arrival& arrival) {
  auto& [place, goal] = arrival;
  keysOf(fields, place);
  fields.object("goal", goal);
}

// The keys of what an event does, of which `key` says that it does that.
template <class Fields>
void keysOf(Fields& fields, const char* key, Mound& mound) {
  fields.object(key, mound);
}
template <class Fields>
void keysOf(Fields& fields, const char* key, HeightSamples& samples) {
  fields.object(key, samples);
}

// The keys that say whom an event is about.
template <class Fields>
void keysOfWhom(Fields& fields, uint32_t& herd, std::vector<uint32_t>& agents) {
  fields.integer("herd", herd, 0, Scene::maxHerds - 1);
  fields.integers("agents", agents, Event::maxAgents, Scene::maxAgents - 1);
}
template <class Fields>
void keysOfWhom(Fields& fields, uint32_t& herd, std::vector<uint32_t>& agents, std::optional<float>& share) {
  keysOfWhom(fields, herd, agents);
  fields.key("share", share, 0, 1);
}

template <class Fields>
void keysOf(Fields& fields, const char* key, GoalChange& change) {
  auto& [herd, agents, goal] = change;
  keysOfWhom(fields, herd, agents);
  fields.object(key, goal);
}
template <class Fields>
void keysOf(Fields& fields, const char* key, SpeedChange& change) {
  auto& [herd, agents, speed] = change;
  keysOfWhom(fields, herd, agents);
  fields.key(key, speed, 0, double{Goal::maxSpeed});
}
template <class Fields>
void keysOf(Fields& fields, const char* key, Teleport& teleport) {
  auto& [herd, moves] = teleport;
  fields.integer("herd", herd, 0, Scene::maxHerds - 1);
  fields.objects(key, moves, Event::maxAgents, "agents");
}
template <class Fields>
void keysOf(Fields& fields, const char* key, Addition& addition) {
  auto& [herd, arrivals] = addition;
  fields.integer("herd", herd, 0, Scene::maxHerds - 1);
  fields.objects(key, arrivals, Event::maxAgents, "agents");
}
template <class Fields>
void keysOf(Fields& fields, const char* key, Removal& removal) {
  auto& [herd, agents] = removal;
  fields.integer("herd", herd, 0, Scene::maxHerds - 1);
  fields.integers(key, agents, Event::maxAgents, Scene::maxAgents - 1);
}
template <class Fields>
void keysOf(Fields& fields, const char* key, HerdAddition& addition) {
  auto& [herd] = addition;
  fields.object(key, herd);
}
template <class Fields>
void keysOf(Fields& fields, const char* key, HerdRemoval& removal) {
  auto& [herd] = removal;
  fields.integer(key, herd, 0, Scene::maxHerds - 1);
}
template <class Fields>
void keysOf(Fields& fields, const char* key, ThreatChange& change) {
  fields.object(key, change);
}

template <class Fields>
void keysOf(Fields& fields, const char* key, LegChange& change) {
  auto& [herd, agents, share, leg, state, bone] = change;
  keysOfWhom(fields, herd, agents, share);
  fields.key(key, leg);
  fields.named("state", state, allLegStates);
  fields.integer("bone", bone, 0, Leg::maxBones - 1);
}

template <class Fields>
void keysOf(Fields& fields, const char* key, Push& push) {
  auto& [herd, agents, share, velocity] = push;
  keysOfWhom(fields, herd, agents, share);
  fields.key(key, velocity, double{Push::most});
}

template <class Fields>
void keysOf(Fields& fields, const char* key, LoadChange& change) {
  auto& [herd, agents, share, load] = change;
  keysOfWhom(fields, herd, agents, share);
  fields.object(key, load);
}

template <class Fields>
void keysOf(Fields& fields, Event& event) {
  auto& [at, what] = event;
  fields.key("at", at, 0, Event::maxTime);
  fields.oneOf({"mound", "edit", "goal", "speed", "teleport", "add", "remove", "addHerd", "removeHerd",
                "threat", "leg", "push", "load"},
               what);
}
void checkKeys(const Event& event, const std::string& file, const std::string& path) {
  const auto expectSome = [&](const char* key, const auto& list) {
    if (list.empty())
      throw inputError(fmt::format("{}: {}.{} is empty, expected at least one agent", file, path, key));
  };
  if (const auto* teleport = std::get_if<Teleport>(&event.what)) expectSome("teleport", teleport->moves);
  if (const auto* addition = std::get_if<Addition>(&event.what)) expectSome("add", addition->arrivals);
  if (const auto* removal = std::get_if<Removal>(&event.what)) expectSome("remove", removal->agents);
  const auto* leg = std::get_if<LegChange>(&event.what);
  if (leg && leg->leg.empty()) throw inputError(fmt::format("{}: {}.leg is missing", file, path));
  const auto expectOne = [&](const auto* change) {
    if (change && change->share && !change->agents.empty())
      throw inputError(fmt::format("{}: {} has agents and a share, expected one of them", file, path));
  };
  expectOne(leg);
  expectOne(std::get_if<Push>(&event.what));
  expectOne(std::get_if<LoadChange>(&event.what));
}

template <class Fields>
void keysOf(Fields& fields, Levels& levels) {
  auto& [distances, most] = levels;
  fields.key("distances", distances, 0, Levels::farthest);
  fields.integers("most", most, Scene::maxAgents);
}
void checkKeys(const Levels& levels, const std::string& file, const std::string& path) {
  for (size_t k = 1; k < levels.distances.size(); ++k)
    if (levels.distances[k] < levels.distances[k - 1])
      throw inputError(fmt::format("{}: {}distances[{}] is {}, expected at least {}, as the one before it",
                                   file, path.empty() ? "" : path + ".", k, levels.distances[k],
                                   levels.distances[k - 1]));
}

template <class Fields>
void keysOf(Fields& fields, Scene& scene) {
  auto& [name, terrain, herds, camera, events, obstacles, threats, levels, light, seed] = scene;
  fields.key("name", name);
  fields.integer("seed", seed, 0, UINT64_MAX);
  fields.object("terrain", terrain);
  fields.objects("herds", herds, Scene::maxHerds, "herds");
  fields.object("camera", camera);
  fields.nameOrObject("light", light, &Light::sky, allSkies);
  fields.objects("events", events, Scene::maxEvents, "events");
  fields.objects("obstacles", obstacles, Scene::maxObstacles, "obstacles");
  fields.objects("threats", threats, Scene::maxThreats, "threats");
  fields.object("levels", levels);
}
void checkKeys(const Scene& scene, const std::string& file, const std::string&) {
  for (size_t e = 1; e < scene.events.size(); ++e)
    if (scene.events[e].at < scene.events[e - 1].at)
      throw inputError(fmt::format("{}: events[{}].at is {}, expected {} or later, as the event before it",
                                   file, e, scene.events[e].at, scene.events[e - 1].at));
  if (scene.capacity() > Scene::maxAgents)
    throw inputError(fmt::format("{}: herds have {} agents in all, expected at most {}", file,
                                 scene.capacity(), Scene::maxAgents));
}

template <class Object>
void checkKeys(const Object&, const std::string&, const std::string&) {}

template <typename Object>
void readObject(const nlohmann::json& json, const Source& source, const std::string& path, Object& value) {
  Reader fields(json, source, path);
  keysOf(fields, value);
  fields.finish();
  checkKeys(value, source.file, path);
}

template <typename Object>
nlohmann::ordered_json writtenObject(const std::string& file, const std::string& path, Object& value) {
  Writer fields(file, path);
  keysOf(fields, value);
  checkKeys(value, file, path);
  return fields.json();
}

}  // namespace skitter::scenes

namespace skitter {

Heightfield Scene::loadTerrain() const {
  if (const auto* noise = std::get_if<TerrainNoise>(&terrain)) return generateHeightfield(*noise);
  const auto& file = std::get<TerrainFile>(terrain);
  return loadHeightfield(file.file, file.units);
}

uint64_t Scene::agentCount() const {
  uint64_t count = 0;
  for (const Herd& herd : herds) count += herd.agents;
  return count;
}

uint64_t Scene::capacity() const {
  uint64_t count = agentCount();
  for (const Herd& herd : herds) count += herd.reserve;
  return count;
}

Scene builtinScene() {
  const auto bytes = embedded::crossing_json();
  return parseScene({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, "crossing.json", {});
}

Scene loadScene(const std::filesystem::path& file) {
  const std::vector<uint8_t> bytes = readFile(file);
  return parseScene({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, file.string(),
                    file.parent_path());
}

Scene parseScene(const std::string& json, const std::string& name, const std::filesystem::path& folder) {
  Scene scene;
  scene.name = std::filesystem::path(name).stem().string();
  scenes::readObject(parseJson(json, name, true), {name, folder}, "", scene);
  return scene;
}

Levels parseLevels(std::string_view json, const std::string& name) {
  Levels levels;
  scenes::readObject(parseJson(json, name, true), {name, {}}, "", levels);
  return levels;
}

Levels loadLevels(const std::filesystem::path& fileOrDefault) {
  if (fileOrDefault == "default") return {};
  const std::vector<uint8_t> bytes = readFile(fileOrDefault);
  return parseLevels({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, fileOrDefault.string());
}

std::string sceneJson(const Scene& scene) {
  const std::string name = scene.name.empty() ? "the scene" : scene.name;
  Scene copy = scene;  // a list of keys is for both directions, so it cannot take what is const
  return scenes::writtenObject(name, "", copy).dump(2) + "\n";
}

}  // namespace skitter
