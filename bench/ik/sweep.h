#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "skitter/device.h"

// Solver x joints x start x limits, each on the device, on the CPU one chain at a time, and on the CPU by
// explicit SIMD.
namespace skitter::bench {

struct SweepOptions {
  uint32_t chains = 20480;
  int repetitions = 7;
  double leastSeconds = 0.05;  // a repetition solves again and again for that long
  bool quick = false;          // few rows
  std::string filter;          // only rows whose name holds each of its words, of "a,b" either
};

struct Sweep {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  int failed = 0;  // rows whose results do not hold; they are not timed
};

// Prints a table as it goes.
Sweep runSweep(Device&, const SweepOptions&);

}  // namespace skitter::bench
