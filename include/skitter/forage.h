#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "skitter/load.h"
#include "skitter/ways.h"

// Herds that forage (docs/foraging.md). Places are world x, z in metres.
namespace skitter {

struct FoodSource {
  glm::vec2 centre{0};
  float radius = 1;       // Disc::minRadius to Scene::maxCoordinate
  uint32_t amount = 100;  // loads; 0 to maxAmount

  static constexpr uint32_t maxAmount = 1u << 30;
  bool operator==(const FoodSource&) const = default;
};

// How the agents of a herd forage: they leave the nest, choose their way by pheromone, find food, carry it
// home and lay pheromone as they go.
struct Forage {
  static constexpr size_t maxSources = 16, maxBranches = 16;
  static constexpr double minCell = 0.1, maxCell = 100, maxThreshold = 1000, maxLaid = 100, minLife = 1,
                          maxLife = 1e6, maxRest = 1e5;
  static constexpr uint32_t maxPower = 4, maxPatience = 1u << 20;

  Disc nest{.centre = {0, 0}, .radius = 2};
  std::vector<FoodSource> food = {};
  // Places in which Foraging::passed counts who comes in: one across each branch of a way.
  std::vector<Disc> branches = {};
  float cell = 2;          // metres a side of the cells in which pheromone is, minCell to maxCell
  float threshold = 20;    // k: units of pheromone as attractive as none at all, 0 to maxThreshold
  uint32_t power = 2;      // n, 1 to maxPower
  float layHome = 10;      // units that an agent with a load lays in each cell, 0 to maxLaid
  float layOut = 0;        // units that one lays who searches, 0 to maxLaid
  float life = 90;         // seconds, mean life of pheromone, minLife to maxLife
  uint32_t patience = 60;  // cells after which a search is given up, 1 to maxPatience
  float rest = 5;          // seconds, mean stay in the nest, 0 to maxRest
  // What food is to who carries it (docs/loads.md); of mass 0: nothing. Of herds that can be hurt
  // (Herd::hurt).
  Load load = {};

  bool operator==(const Forage&) const = default;
};

// The deeds of the foragers of a herd, and of herds that share its colony, since the crowd began.
struct Foraging {
  uint64_t brought = 0;               // loads carried home
  uint64_t empty = 0;                 // returns to the nest without one
  std::vector<uint64_t> taken = {};   // loads taken from each source
  std::vector<uint64_t> passed = {};  // entries of each of Forage::branches
};

// The pheromone of a colony. Cells go row after row along +z.
struct PheromoneGrid {
  uint32_t columns = 0, rows = 0;
  float cell = 0;                 // metres a side
  glm::vec2 origin{0};            // x, z of the corner of cell (0, 0)
  std::vector<float> units = {};  // in each cell
};

}  // namespace skitter
