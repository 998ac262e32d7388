#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "skitter/state.h"

namespace skitter::app {

// A run keeps this in a state beside its crowd, so that it can go on without being told anew (docs/state.md).
struct RunNote {
  double dt = 0;
  uint64_t ticksPerFrame = 1;
  std::optional<uint64_t> frames;   // wanted in all
  nlohmann::ordered_json obstacle;  // null: there is none
  nlohmann::ordered_json manifest;
  // With which the run began, where its events add or remove herds: a state's scene has those that there are.
  std::optional<Scene> scene = {};

  const Scene& sceneOf(const State& state) const { return scene ? *scene : state.scene; }

  std::string text() const;
  // Of the state in that file. One that another program has saved has the defaults. Throws Error(input).
  static RunNote of(const State& state, const std::string& file);
};

}  // namespace skitter::app
