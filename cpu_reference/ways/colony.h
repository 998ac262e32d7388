#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace skitter::reference {

// Scouts as docs/colony.md has them: whole numbers, plain loops.
enum class ColonyRule { mmas, acs };

struct ColonyMap {
  uint32_t columns = 0, rows = 0;
  std::vector<float> cost;  // row by row, at least 1; infinity where there is no way
};

// Shares in the units of docs/colony.md.
struct ColonyRecipe {
  ColonyRule rule = ColonyRule::mmas;
  uint32_t ants = 1, crew = 1, steps = 1, passes = 0;
  uint64_t seed = 1;
  uint32_t beta = 1, margin = 512;
  uint32_t evaporation = 0;  // rho, 1/4096
  uint32_t least = 16;       // tau_min, 2^-20
  uint32_t bestEvery = 0;
  uint32_t greed = 0;   // q_0, 2^-32
  uint32_t wear = 0;    // xi, 1/4096
  uint32_t forget = 0;  // gamma, 1/4096
  uint32_t forgetRadius = 0;
};

struct ColonyTrip {
  bool arrived = false;
  uint32_t length = 0;
  std::vector<uint32_t> cells = {};  // from the nest on

  bool operator==(const ColonyTrip&) const = default;
};

class Colony {
 public:
  static constexpr uint32_t noWay = UINT32_MAX;

  Colony(const ColonyMap&, const ColonyRecipe&, uint32_t nest, uint32_t goal);

  void iterate();
  void change(const std::vector<uint32_t>& cells, const std::vector<float>& costs);

  uint32_t iteration() const { return iteration_; }                      // those done
  const std::vector<uint32_t>& pheromone() const { return pheromone_; }  // eight a cell, 2^-20
  const std::vector<ColonyTrip>& trips() const { return trips_; }        // of the last iteration
  const ColonyTrip& best() const { return best_; }
  uint32_t found() const { return found_; }  // the iteration, counted from 1, that found the best

  // From one cell to another: noWay where no move leads there.
  uint32_t moveLength(uint32_t from, uint32_t to) const;
  uint32_t desirability(uint32_t from, uint32_t to) const;
  uint64_t lengthOf(const std::vector<uint32_t>& cells) const;  // UINT64_MAX where it is no way
  ColonyTrip walk(uint32_t ant);
  bool tighten(ColonyTrip&) const;
  // Dijkstra 1959, on the same graph.
  uint64_t shortest() const;

 private:
  uint32_t cellBeside(uint32_t cell, uint32_t direction) const;  // noWay beyond the map
  uint32_t straight(uint32_t cell) const;
  void measure();
  uint32_t choose(const std::vector<uint32_t>& weights, uint64_t random) const;
  const ColonyTrip* firstOf(size_t begin, size_t end) const;
  void update(const ColonyTrip* laying);

  ColonyMap map_;
  ColonyRecipe recipe_;
  uint32_t nest_, goal_, iteration_ = 0, found_ = 0;
  std::vector<uint32_t> lengths_, desirabilities_;  // of the map as it is, eight a cell
  std::vector<uint32_t> pheromone_, crossings_;
  std::vector<ColonyTrip> trips_;
  ColonyTrip best_;
};

}  // namespace skitter::reference
