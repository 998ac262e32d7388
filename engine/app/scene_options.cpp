#include "scene_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>

#include "skitter/error.h"
#include "values.h"

namespace skitter::app {
namespace {

constexpr uint64_t maxAgents = 16777216;  // as in a scene file: beyond it a float cannot count agents
constexpr double maxMetres = 1e5;         // a sample, as in a scene file
constexpr double minMetres = 1e-4;
constexpr double maxHeight = 1e6;  // metres
constexpr double minScale = 1e-6, maxScale = 1e6;
// Steps are timed in whole ticks of at least three a swing, so ticks far from a display's rate animate
// nothing.
constexpr double minTick = 1e-3, maxTick = 0.1;
// Of the built-in spider, by shaders/shared/records.h: 2.7 KB of records and their share of lists and
// counters.
constexpr uint64_t bytesPerAgent = 2800;

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
  command
      .add_option_function<std::string>(
          "--agents",
          [this](const std::string& text) { agents = parseWhole("--agents", text, 0, maxAgents); },
          fmt::format("agents of the first herd; other herds keep their proportion to it [{}]", agentsHelp))
      ->type_name("N");
  command.add_option("--terrain", terrain, "a grey PNG of heights instead of the scene's terrain")
      ->type_name("FILE");
  command
      .add_option_function<std::string>(
          "--spacing",
          [this](const std::string& text) {
            spacing = parsePair("--spacing", text, minMetres, maxMetres, true);
          },
          "metres a sample of the terrain file [its NAME.json, else 0.5]")
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
          "metres of the terrain file's black and white [its NAME.json, else 0,10]")
      ->type_name("MIN,MAX");
  command
      .add_option_function<std::string>(
          "--scale",
          [this](const std::string& text) { scale = parseNumber("--scale", text, minScale, maxScale); },
          "multiplies the terrain file's spacing and heights alike [1]")
      ->type_name("S");
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

Scene SceneOptions::load() const {
  Scene result = scene.empty() ? builtinScene() : loadScene(scene);
  if (agents) scaleHerds(result, *agents);
  if (seed) result.seed = *seed;
  if (!terrain.empty()) result.terrain = TerrainFile{terrain, {}};
  if (!spacing && !heights && !scale) return result;

  auto* file = std::get_if<TerrainFile>(&result.terrain);
  if (!file) {
    throw inputError(fmt::format("{}: {} generates its terrain, so this needs --terrain FILE",
                                 spacing ? "--spacing" : (heights ? "--heights" : "--scale"), result.name));
  }
  if (spacing) {
    file->units.spacingX = static_cast<float>(spacing->first);
    file->units.spacingZ = static_cast<float>(spacing->second);
  }
  if (heights) {
    file->units.minHeight = static_cast<float>(heights->first);
    file->units.maxHeight = static_cast<float>(heights->second);
  }
  if (scale) file->units.scale = static_cast<float>(*scale);
  return result;
}

void checkMemory(const Scene& scene, const Device& device) {
  const uint64_t needed = scene.agentCount() * bytesPerAgent;
  const uint64_t available = device.report().limits.availableBytes;
  if (needed <= available) return;
  throw inputError(fmt::format("{} agents need about {} MiB of device memory, {} has {} MiB free",
                               scene.agentCount(), needed >> 20, device.report().name, available >> 20));
}

}  // namespace skitter::app
