#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "skitter/device.h"
#include "skitter/ik.h"

namespace skitter::bench {

// The dissertation's Figures 3, 4 and 5 (time against the iterations allowed, the accuracy asked for, and
// both), each in both readings of "altered in multiples of 100", and the cost of more iterations beside that
// of more instances. Four series: FABRIK without limits; the dissertation's two rules with cones of 60
// degrees; its edge rule with targets anywhere.

// How much is measured.
struct FigureSizes {
  uint32_t chains = 2048;  // a batch
  uint32_t steps = 20;     // of 100, in the first reading
  int iterationPower = 4;  // 100^4 is the last power of 100 that 32 bits hold
  int accuracyPower = 18;  // 100^-18 the last that a normal float does
  uint32_t instances = 1000, mostInstances = 100000, mostIterations = 1000;
  double longestSeconds = 100;  // of one batch; what is foreseen to take longer is left out
  int repetitions = 5;

  static FigureSizes quick() { return {64, 2, 1, 1, 20, 20, 5, 100, 5}; }
};

// A batch of one series under one setting.
struct SolvePoint {
  std::string series;
  uint32_t iterations = 0;  // allowed
  float tolerance = 0;      // share of the reach
  // A solve, median of the repetitions: CPU time of all threads on a software device, else the wall's.
  double microseconds = 0;
  double meanIterations = 0, meanError = 0;
  std::array<double, 4> stops{};                       // shares: ik::Stop tolerance, cap, stall, unreachable
  double leastMicroseconds = 0, mostMicroseconds = 0;  // of the repetitions
};
struct SolveSweep {
  std::string name;  // "iterations-steps", "accuracy-factors", ...
  std::vector<SolvePoint> points;
  std::vector<std::string> leftOut;  // a line each
};
struct InstancePoint {
  std::string series, altered;  // "instances" or "iterations"
  uint32_t instances = 0, iterations = 0;
  double milliseconds = 0, wallMilliseconds = 0;  // of the batch
};

// For people: "FABRIK without limits".
const char* seriesTitle(const std::string& series);

// Called as measuring goes on, with the share that is done; what it throws ends it.
using FigureProgress = std::function<void(double)>;

// The six sweeps, in the order of the figures.
std::vector<SolveSweep> measureSweeps(Device&, const FigureSizes&, const FigureProgress& = {});
std::vector<InstancePoint> measureInstances(Device&, const FigureSizes&, const FigureProgress& = {});

// As scripts/plots reads them.
std::string csvOf(const SolveSweep&);
std::string csvOf(const std::vector<InstancePoint>&);

// Measures all and writes one CSV file each into `folder`.
void writeDissertationFigures(Device&, const std::filesystem::path& folder, bool quick);

}  // namespace skitter::bench
