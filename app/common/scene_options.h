#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "app/common/files.h"
#include "app/common/values.h"
#include "skitter/scene.h"

namespace CLI {
class App;
}

namespace skitter::app {

// The scene's herds, and those that its events add; none twice.
template <class SceneOrConst>
auto herdsOf(SceneOrConst& scene) {
  std::vector<decltype(scene.herds.data())> all;
  for (auto& herd : scene.herds) all.push_back(&herd);
  for (auto& event : scene.events)
    if (auto* addition = std::get_if<HerdAddition>(&event.what)) all.push_back(&addition->herd);
  return all;
}

// What is simulated and where: a scene file, and the flags that change it.
struct SceneOptions {
  std::string scene;  // empty: the built-in scene
  std::optional<uint64_t> agents, seed;
  std::string rig;               // empty: the scene's own
  std::optional<Solver> solver;  // of every herd, like the next two; none: the scene's own
  std::optional<Controller> controller;
  std::optional<Stepping> stepping;
  bool avoid = false;   // every herd does
  std::string terrain;  // empty: the scene's own
  std::optional<Size> terrainSize;
  std::optional<std::pair<double, double>> spacing, heights;
  std::optional<double> scale, exaggeration, voidValue;
  double dt = 1.0 / 60;
  std::optional<std::string> device;

  // What DeviceRequest::device is to be, one after the other: "" for the best one; of "all", every suitable
  // one. Throws Error(device) where there is none.
  std::vector<std::string> devices() const;

  // `agentsHelp` says what happens without --agents; null: neither --agents and --controller, of which the
  // command has lists, nor --avoid.
  void addTo(CLI::App& command, const char* agentsHelp);
  // The scene as the flags leave it. Throws Error(input).
  Scene load() const;
  // Throws Error(input) that names the first option that makes another scene of `saved`, which the file
  // `state` holds. Camera, light and the scene's name do not count.
  void refuseOthersThan(const Scene& saved, const std::string& state) const;
  // What the scene that was loaded is read from.
  void declare(Files& files, const Scene& loaded) const;

 private:
  // A given option changes a scene by this.
  struct Change {
    std::string option;  // "--agents 50"
    std::function<void(Scene& scene)> make;
  };
  std::vector<Change> changes() const;
  void addCountTo(CLI::App& command, const char* agentsHelp);
  void addTerrainTo(CLI::App& command);
};

}  // namespace skitter::app
