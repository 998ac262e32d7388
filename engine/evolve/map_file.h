#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "evolve/archive.h"
#include "skitter/evolve.h"

namespace skitter::evolve {

// A search between two batches.
struct SearchState {
  uint64_t seed = 1;
  uint32_t batch = 0;
  float dt = 0;
  uint64_t evaluations = 0;
  Archive archive{0};
};

// As JSON, an elite a line.
std::string writeMap(const Rig& rig, const std::vector<uint32_t>& patterns, const SearchState& state);
// Throws Error(input) that names the key where it is damaged, or another rig's.
SearchState readMap(const std::string& json, const std::string& name, const Rig& rig,
                    const std::vector<uint32_t>& patterns, size_t genes);

}  // namespace skitter::evolve
