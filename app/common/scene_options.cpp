#include "app/common/scene_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "app/common/noise_option.h"
#include "skitter/device.h"
#include "skitter/error.h"
#include "skitter/rig_setup.h"

namespace skitter::app {
namespace {

constexpr uint64_t maxAgents = UINT32_MAX;  // whether a device has room for them is the crowd's to say
constexpr double maxMetres = 1e5;           // a sample, as in a scene file
constexpr double minMetres = 1e-4;
constexpr double maxHeight = 1e6;  // metres
constexpr double minScale = 1e-6, maxScale = 1e6, maxExaggeration = 1000;
constexpr double maxVoidValue = std::numeric_limits<double>::max();
// Steps are timed in whole ticks of at least three a swing, so ticks far from a display's rate animate
// nothing.
constexpr double minTick = 1e-3, maxTick = 0.15;

void scaleHerds(Scene& scene, uint64_t agents) {
  if (scene.herds.empty()) throw inputError(fmt::format("--agents: {} has no herds", scene.name));
  const uint32_t first = scene.herds.front().agents;
  uint64_t sum = 0;
  for (size_t h = 0; h < scene.herds.size(); ++h) {
    uint32_t& count = scene.herds[h].agents;
    double scaled = static_cast<double>(agents);
    if (h > 0 && first > 0) scaled *= static_cast<double>(count) / first;
    if (h > 0 && first == 0) scaled = count;
    sum += static_cast<uint64_t>(std::llround(std::min(scaled, 1e12)));
    if (sum > maxAgents) {
      throw inputError(fmt::format("--agents {}: {}'s herds would have over {} agents in all", agents,
                                   scene.name, maxAgents));
    }
    count = static_cast<uint32_t>(std::llround(scaled));
  }
}

}  // namespace

void SceneOptions::addTo(CLI::App& command, const char* agentsHelp) {
  command.add_option("scene", scene, "a scene file (JSON, docs/scene.md); without one, the built-in scene")
      ->type_name("SCENE");
  if (agentsHelp != nullptr) addCountTo(command, agentsHelp);
  command
      .add_option(
          "--rig", rig,
          "the first herd's rig: spider, a model with its sidecar beside it, or a sidecar (docs/rig.md)")
      ->type_name("FILE");
  command
      .add_option_function<std::string>(
          "--solver", [this](const std::string& text) { solver = parseNamed("--solver", text, herdSolvers); },
          fmt::format("every herd's inverse kinematics: {} [the scene's]", namesOf(herdSolvers)))
      ->type_name("NAME");
  command
      .add_option_function<std::string>(
          "--stepping",
          [this](const std::string& text) { stepping = parseNamed("--stepping", text, allSteppings); },
          "every herd's: gait, in a rhythm, or reach, each leg by itself [the scene's]")
      ->type_name("NAME");
  addTerrainTo(command);
  command
      .add_option_function<std::string>(
          "--dt", [this](const std::string& text) { dt = parseNumber("--dt", text, minTick, maxTick); },
          "seconds a tick [1/60]")
      ->type_name("S");
  command
      .add_option_function<std::string>(
          "--seed", [this](const std::string& text) { seed = parseWhole("--seed", text, 0, UINT64_MAX); },
          "what all randomness is drawn from [the scene's]")
      ->type_name("N");
  command
      .add_option_function<std::string>(
          "--device", [this](const std::string& text) { device = text; },
          "number or part of the name of the device (skitter info) [the best suitable]")
      ->type_name("NAME|INDEX");
}

void SceneOptions::addCountTo(CLI::App& command, const char* agentsHelp) {
  command
      .add_option_function<std::string>(
          "--agents",
          [this](const std::string& text) { agents = parseWhole("--agents", text, 0, maxAgents); },
          fmt::format("agents of the first herd; other herds keep their proportion to it [{}]", agentsHelp))
      ->type_name("N");
  command
      .add_option_function<std::string>(
          "--controller",
          [this](const std::string& text) { controller = parseNamed("--controller", text, allControllers); },
          fmt::format("how every herd's legs move: {} (docs/scene.md) [the scene's]",
                      namesOf(allControllers)))
      ->type_name("NAME");
}

void SceneOptions::addTerrainTo(CLI::App& command) {
  command
      .add_option("--terrain", terrain,
                  "heights instead of the scene's terrain: .png, .r16, .r32f, .hgt, .npy (docs/terrain.md), "
                  "or noise:amplitude=A,wavelength=W,seed=N,... to generate them")
      ->type_name("FILE|noise[:KEY=VALUE,...]");
  command
      .add_option_function<std::string>(
          "--terrain-size",
          [this](const std::string& text) { terrainSize = parseSize("--terrain-size", text, 2); },
          "samples of a raw terrain file [its NAME.json, its name NAME_WxH, else a square]")
      ->type_name("WxH");
  command
      .add_option_function<std::string>(
          "--spacing",
          [this](const std::string& text) {
            spacing = parsePair("--spacing", text, minMetres, maxMetres, true);
          },
          "metres a sample of the terrain file [its NAME.json, a .hgt its latitude, else 0.5]")
      ->type_name("X[,Z]");
  command
      .add_option_function<std::string>(
          "--heights",
          [this](const std::string& text) {
            heights = parsePair("--heights", text, -maxHeight, maxHeight, false);
            if (heights->first > heights->second) {
              throw inputError(
                  fmt::format("--heights is {}, expected MIN,MAX with MIN no higher than MAX", text));
            }
          },
          "metres of the terrain file's lowest and highest code [its NAME.json, else 0,10]; a file of "
          "metres is rescaled to them")
      ->type_name("MIN,MAX");
  command
      .add_option_function<std::string>(
          "--scale",
          [this](const std::string& text) { scale = parseNumber("--scale", text, minScale, maxScale); },
          "multiplies the terrain file's spacing and heights alike [1]")
      ->type_name("S");
  command
      .add_option_function<std::string>(
          "--exaggeration",
          [this](const std::string& text) {
            exaggeration = parseNumber("--exaggeration", text, 0, maxExaggeration);
          },
          "multiplies the terrain file's heights alone [1]")
      ->type_name("E");
  command
      .add_option_function<std::string>(
          "--void-value",
          [this](const std::string& text) {
            voidValue = parseNumber("--void-value", text, -maxVoidValue, maxVoidValue);
          },
          "a sample of this value, as stored, has no height and is filled in from around")
      ->type_name("V");
}

void SceneOptions::applyTerrain(Scene& result) const {
  if (!terrain.empty()) {
    if (isNoise(terrain)) {
      result.terrain = parseNoise("--terrain", terrain);
    } else {
      result.terrain = TerrainFile{terrain, {}};
    }
  }
  const std::pair<const char*, bool> given[] = {
      {"--terrain-size", terrainSize.has_value()},  {"--spacing", spacing.has_value()},
      {"--heights", heights.has_value()},           {"--scale", scale.has_value()},
      {"--exaggeration", exaggeration.has_value()}, {"--void-value", voidValue.has_value()}};
  const auto first =
      std::find_if(std::begin(given), std::end(given), [](const auto& flag) { return flag.second; });
  if (first == std::end(given)) return;

  auto* file = std::get_if<TerrainFile>(&result.terrain);
  if (!file) {
    throw inputError(fmt::format("{}: {} generates its terrain, so this needs --terrain FILE", first->first,
                                 terrain.empty() ? result.name : terrain));
  }
  HeightfieldUnits& units = file->units;
  if (terrainSize) {
    units.columns = terrainSize->width;
    units.rows = terrainSize->height;
  }
  if (spacing) {
    units.spacingX = static_cast<float>(spacing->first);
    units.spacingZ = static_cast<float>(spacing->second);
  }
  if (heights) {
    units.minHeight = static_cast<float>(heights->first);
    units.maxHeight = static_cast<float>(heights->second);
  }
  if (scale) units.scale = static_cast<float>(*scale);
  if (exaggeration) units.exaggeration = static_cast<float>(*exaggeration);
  if (voidValue) units.voidValue = *voidValue;
}

std::vector<std::string> SceneOptions::devices() const {
  if (device != "all") return {device.value_or("")};
  std::vector<std::string> names;
  for (const DeviceReport& report : listDevices())
    if (report.suitable) names.push_back(std::to_string(report.index));
  if (names.empty()) throw deviceError("--device all: no device is suitable (skitter info tells why)");
  return names;
}

Scene SceneOptions::load() const {
  Scene result = scene.empty() ? builtinScene() : loadScene(scene);
  if (agents) scaleHerds(result, *agents);
  if (!rig.empty()) {
    if (result.herds.empty()) throw inputError(fmt::format("--rig: {} has no herds", result.name));
    result.herds.front().rig = rig;
  }
  if (controller)
    for (Herd& herd : result.herds) herd.controller = *controller;
  if (solver)
    for (Herd& herd : result.herds) herd.solver = *solver;
  if (stepping)
    for (Herd& herd : result.herds) herd.stepping = *stepping;
  if (seed) result.seed = *seed;
  applyTerrain(result);
  return result;
}

void SceneOptions::declare(Files& files, const Scene& loaded) const {
  files.reads("SCENE", scene);
  if (const auto* file = std::get_if<TerrainFile>(&loaded.terrain))
    files.reads(terrain.empty() ? "the scene's terrain" : "--terrain", file->file);
  std::set<std::string> rigs;
  for (const Herd& herd : loaded.herds)
    if (herd.rig != "spider") rigs.insert(herd.rig);
  const char* option = rig.empty() ? "the scene's rig" : "--rig";
  for (const std::string& file : rigs) {
    files.reads(option, file);
    files.reads(option, sidecarOf(file));
  }
}

}  // namespace skitter::app
