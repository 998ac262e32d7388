#include "app/common/scene_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "app/common/noise_option.h"
#include "skitter/device.h"
#include "skitter/error.h"
#include "skitter/rig_gaits.h"
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
  const std::vector<Herd*> herds = herdsOf(scene);
  if (herds.empty()) throw inputError(fmt::format("--agents: {} has no herds", scene.name));
  const uint32_t first = herds.front()->agents;
  uint64_t sum = 0;
  for (Herd* herd : herds) {
    uint32_t& count = herd->agents;
    const bool isFirst = herd == herds.front();
    double scaled = static_cast<double>(agents);
    if (!isFirst && first > 0) scaled *= static_cast<double>(count) / first;
    if (!isFirst && first == 0) scaled = count;
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
  command.add_flag("--avoid", avoid, "agents of every herd keep clear of those near them");
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

std::vector<SceneOptions::Change> SceneOptions::changes() const {
  std::vector<Change> all;
  const auto ofEveryHerd = [&](const char* option, const auto& given, auto Herd::*member) {
    if (!given) return;
    all.push_back({fmt::format("{} {}", option, nameOf(*given)), [&given, member](Scene& result) {
                     for (Herd* herd : herdsOf(result)) herd->*member = *given;
                   }});
  };
  if (agents)
    all.push_back(
        {fmt::format("--agents {}", *agents), [this](Scene& result) { scaleHerds(result, *agents); }});
  if (!rig.empty())
    all.push_back({fmt::format("--rig {}", rig), [this](Scene& result) {
                     if (result.herds.empty())
                       throw inputError(fmt::format("--rig: {} has no herds", result.name));
                     result.herds.front().rig = rig;
                   }});
  ofEveryHerd("--controller", controller, &Herd::controller);
  ofEveryHerd("--solver", solver, &Herd::solver);
  ofEveryHerd("--stepping", stepping, &Herd::stepping);
  if (avoid)
    all.push_back({"--avoid", [](Scene& result) {
                     for (Herd& herd : result.herds) herd.avoid = true;
                   }});
  if (seed) all.push_back({fmt::format("--seed {}", *seed), [this](Scene& result) { result.seed = *seed; }});
  if (!terrain.empty())
    all.push_back({fmt::format("--terrain {}", terrain), [this](Scene& result) {
                     if (isNoise(terrain))
                       result.terrain = parseNoise("--terrain", terrain);
                     else
                       result.terrain = TerrainFile{terrain, {}};
                   }});
  const auto ofUnits = [&](const char* option, bool given, std::function<void(HeightfieldUnits&)> set) {
    if (!given) return;
    all.push_back({option, [this, option, set = std::move(set)](Scene& result) {
                     auto* file = std::get_if<TerrainFile>(&result.terrain);
                     if (!file)
                       throw inputError(
                           fmt::format("{}: {} generates its terrain, so this needs --terrain FILE", option,
                                       terrain.empty() ? result.name : terrain));
                     set(file->units);
                   }});
  };
  ofUnits("--terrain-size", terrainSize.has_value(), [this](HeightfieldUnits& units) {
    units.columns = terrainSize->width;
    units.rows = terrainSize->height;
  });
  ofUnits("--spacing", spacing.has_value(), [this](HeightfieldUnits& units) {
    units.spacingX = static_cast<float>(spacing->first);
    units.spacingZ = static_cast<float>(spacing->second);
  });
  ofUnits("--heights", heights.has_value(), [this](HeightfieldUnits& units) {
    units.minHeight = static_cast<float>(heights->first);
    units.maxHeight = static_cast<float>(heights->second);
  });
  ofUnits("--scale", scale.has_value(),
          [this](HeightfieldUnits& units) { units.scale = static_cast<float>(*scale); });
  ofUnits("--exaggeration", exaggeration.has_value(),
          [this](HeightfieldUnits& units) { units.exaggeration = static_cast<float>(*exaggeration); });
  ofUnits("--void-value", voidValue.has_value(),
          [this](HeightfieldUnits& units) { units.voidValue = *voidValue; });
  return all;
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
  for (const Change& change : changes()) change.make(result);
  return result;
}

void SceneOptions::refuseOthersThan(const Scene& saved, const std::string& state) const {
  const auto jsonOf = [&](Scene each) {
    each.camera = saved.camera;
    each.light = saved.light;
    each.name = saved.name;
    return nlohmann::json::parse(sceneJson(each));
  };
  const nlohmann::json expected = jsonOf(saved);
  const auto compare = [&](const std::string& option, const Scene& found) {
    const nlohmann::json other = jsonOf(found), differences = nlohmann::json::diff(expected, other);
    if (differences.empty()) return;
    const nlohmann::json::json_pointer place(differences[0].at("path").get<std::string>());
    const auto valueIn = [&](const nlohmann::json& json) {
      return json.contains(place) ? json.at(place).dump() : "none";
    };
    throw inputError(fmt::format("{}: {} was saved with {} {}, not {}", option, state,
                                 place.to_string().substr(1), valueIn(expected), valueIn(other)));
  };
  for (const Change& change : changes()) {
    Scene changed = saved;
    change.make(changed);
    // --terrain begins with no units; those that are given have a change of their own.
    const auto* before = std::get_if<TerrainFile>(&saved.terrain);
    auto* file = std::get_if<TerrainFile>(&changed.terrain);
    if (before && file && file->units == HeightfieldUnits{}) file->units = before->units;
    compare(change.option, changed);
  }
  if (!scene.empty()) compare(fmt::format("SCENE {}", scene), load());
}

void SceneOptions::declare(Files& files, const Scene& loaded) const {
  files.reads("SCENE", scene);
  if (const auto* file = std::get_if<TerrainFile>(&loaded.terrain))
    files.reads(terrain.empty() ? "the scene's terrain" : "--terrain", file->file);
  std::set<std::string> rigs;
  for (const Herd* herd : herdsOf(loaded))
    if (herd->rig != "spider") rigs.insert(herd->rig);
  const char* option = rig.empty() ? "the scene's rig" : "--rig";
  for (const std::string& file : rigs) {
    files.reads(option, file);
    files.reads(option, sidecarOf(file));
    files.reads(option, gaitsOf(file));
  }
}

}  // namespace skitter::app
