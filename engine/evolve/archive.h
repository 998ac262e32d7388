#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "evolve/genes.h"
#include "skitter/rig.h"

namespace skitter::evolve {

// A candidate that holds a cell of the map.
struct Elite {
  uint64_t candidate = 0;  // its number
  float fitness = 0;
  Genes genes;
  std::vector<float> shares;  // of time for which each leg stands

  bool operator==(const Elite&) const = default;
};

// The map of MAP-Elites: for each pattern cells by behaviour, of which each keeps the fittest candidate
// (docs/evolve.md).
class Archive {
 public:
  static constexpr uint32_t steps = 8;  // of a share
  static constexpr uint32_t cellsOfPattern = steps * steps;

  explicit Archive(size_t patterns) : cells_(patterns) {}

  // Takes the cell where it is empty or its elite is less fit. One without a fitness never does.
  bool offer(size_t pattern, uint32_t cell, const Elite& elite);

  size_t patternCount() const { return cells_.size(); }
  uint64_t cellCount() const { return uint64_t{cells_.size()} * cellsOfPattern; }
  uint64_t filledCount() const;
  const std::optional<Elite>& at(size_t pattern, uint32_t cell) const { return cells_[pattern][cell]; }
  // Those of a pattern, by cell.
  std::vector<const Elite*> elitesOf(size_t pattern) const;
  // The fittest of a pattern, of equal ones the one that came first; none where there is no elite.
  const Elite* bestOf(size_t pattern) const;

  bool operator==(const Archive&) const = default;

 private:
  std::vector<std::array<std::optional<Elite>, cellsOfPattern>> cells_;
};

// The cell of a behaviour, from the share of time for which each leg stands.
uint32_t cellOf(const Rig& rig, uint32_t idle, std::span<const float> shares);

}  // namespace skitter::evolve
