#pragma once

#include "cpu_reference/ways/forage.h"
#include "skitter/crowd.h"
#include "skitter/forage.h"

// Between the engine's foragers and the reference's (docs/foraging.md).
namespace skitter::validation {

// The facts of foragers that the reference needs.
struct ForageFacts {
  reference::ForageMap map;
  reference::ForageTuning tuning;
  int64_t firstNumber = 0;  // in the colony, of agent 0 of the states
  uint64_t agents = 0;      // of the colony, empty places among them
};

// `grid` has cells of whole quanta.
reference::ForageMap forageMapOf(const Forage& forage, const CostGrid& grid);
reference::ForageTuning forageTuningOf(const Forage& forage, uint64_t seed, double dt);

reference::Forager foragerOf(const HerdState& state, size_t agent);
reference::ForageDeed deedOf(const HerdState& state, size_t agent);
// Throws Error(input) where the state's trail does not fit the map.
reference::ForageTrail trailOf(const HerdState& state, const reference::ForageMap& map);

}  // namespace skitter::validation
