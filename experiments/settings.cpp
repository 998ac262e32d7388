#include "experiments/settings.h"

#include <algorithm>

namespace skitter::experiments {

Settings Settings::quick() {
  Settings s;
  s.extent = "quick: fewer points, ticks and agents";
  s.solves = {.chains = 256,
              .steps = 10,
              .iterationPower = 3,
              .accuracyPower = 6,
              .instances = 200,
              .mostInstances = 5000,
              .mostIterations = 500,
              .longestSeconds = 1,
              .repetitions = 3};
  s.budgetFrom = 512;
  s.budgetSettle = 20;
  s.budgetTicks = 15;
  s.budgetPrecision = 0.1;
  s.drawnSettle = 5;
  s.drawnFrames = 7;
  s.collectionRepetitions = 31;
  s.settleTicks = 120;
  s.placementTicks = 180;
  s.fidelityAgents = 36;
  s.fidelityTicks = 240;
  s.gaitAgents = 8;
  s.gaitTicks = 200;
  s.gaitSpeeds = {0.25, 0.5, 1, 1.5, 2, 3};
  s.damageEvaluations = 1u << 15;
  return s;
}

Settings Settings::trial(uint32_t ticks) {
  Settings s = quick();
  s.extent = "a trial, so small that its figures mean nothing";
  s.solves = bench::FigureSizes::quick();
  s.solves.repetitions = 1;
  s.budgetFrom = 2;
  s.drawnFrom = 2;
  s.budgetMost = 4;
  s.budgetSettle = std::min(s.budgetSettle, ticks);
  s.budgetTicks = std::min(s.budgetTicks, ticks);
  s.drawnSettle = 1;
  s.drawnFrames = 1;
  s.frame = {64, 36};
  s.softwareFrame = {64, 36, 0.5f};
  s.collectionLegs = {1, 4, 16};
  s.collectionRepetitions = 3;
  s.settleTicks = std::min(s.settleTicks, ticks);
  s.arcTicks = std::min(s.arcTicks, ticks);
  s.placementTicks = std::min(s.placementTicks, ticks);
  s.placementAgents = 4;
  s.pictureWidth = 160;
  s.pictureHeight = 100;
  s.fidelityAgents = 4;
  s.fidelityTicks = std::min(s.fidelityTicks, ticks);
  s.gaitAgents = 2;
  s.gaitTicks = std::min(s.gaitTicks, ticks);
  s.gaitSpeeds = {0.5, 1};
  s.damageEvaluations = 128;
  s.damagedCreatures = 2;
  s.damageSeconds = ticks * s.dt;
  return s;
}

}  // namespace skitter::experiments
