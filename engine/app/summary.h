#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "simulate.h"
#include "skitter/crowd.h"
#include "skitter/device.h"

namespace skitter::app {

// What a run came to: printed for people and written for programs.
struct Summary {
  std::string device;
  std::string terrain;  // name, samples and metres
  uint64_t filledVoids = 0;
  uint64_t agents = 0, ticks = 0, frames = 0, seed = 0;
  uint64_t wantedTicks = 0;  // more than `ticks` where the run was interrupted
  TickTimes times;
  bool cpuTold = true;  // the CPU time is the simulation's alone
  Fidelity fidelity;
  uint64_t stateHash = 0;
  std::vector<std::string> files;

  void print() const;
  nlohmann::ordered_json json() const;
};

}  // namespace skitter::app
