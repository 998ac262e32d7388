#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bench/ik/dissertation_figures.h"

namespace skitter::experiments {

// A frame that is timed.
struct FrameSize {
  uint32_t width = 0, height = 0;  // pixels
  float scale = 1;                 // RendererOptions::scale
};

// How much is measured. Everything is drawn from `seed`; ticks are of `dt` seconds.
struct Settings {
  std::string extent = "full";  // for people
  uint64_t seed = 1;
  double dt = 1.0 / 60;

  bench::FigureSizes solves;  // Figures 3 to 5

  // Agents before a budget is passed: Figures 6 to 8.
  uint32_t budgetFrom = 64;        // agents at which the search begins
  uint32_t budgetMost = 1u << 18;  // and at which it gives up
  uint32_t budgetSettle = 60;      // ticks before any is timed
  uint32_t budgetTicks = 61;       // ticks timed; their median decides
  double budgetPrecision = 0.03;   // width of the last bracket, share of the number
  uint32_t drawnFrom = 8;          // the same, where each frame is drawn
  uint32_t drawnSettle = 20, drawnFrames = 21;
  FrameSize frame{1280, 720}, softwareFrame{640, 360, 0.5f};  // the second one on software devices
  std::vector<double> budgets = {16.7, 33.3};                 // milliseconds

  std::vector<uint32_t> collectionLegs = {1, 4, 8, 64, 1000, 8000, 80000};
  int collectionRepetitions = 101;

  uint32_t settleTicks = 150;  // until an agent walks: arcs, gait
  uint32_t arcTicks = 240;     // at most, for two cycles
  uint32_t placementTicks = 300;
  uint32_t placementAgents = 36;
  uint32_t pictureWidth = 960, pictureHeight = 600;

  uint32_t fidelityAgents = 64, fidelityTicks = 600;

  uint32_t gaitAgents = 16, gaitTicks = 360;
  std::vector<double> gaitSpeeds = {0.25, 0.5, 0.75, 1, 1.5, 2, 2.5, 3};  // leg lengths a second

  uint32_t damageEvaluations = 1u << 18;  // of the search for gaits
  uint32_t damagedCreatures = 100;        // that look for one by trial and error
  double damageSeconds = 20;              // for which each pattern of lost legs is judged

  static Settings full() { return {}; }
  static Settings quick();
  // No experiment of more than `ticks` ticks or of more than a few agents: to try the command out.
  static Settings trial(uint32_t ticks);
};

}  // namespace skitter::experiments
