#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>

#include "skitter/ik.h"

namespace skitter::app {

// What `skitter ik` shall reach: rows of one target a chain, handed out in order, chains first.
struct IkTargets {
  uint32_t chains = 0;
  uint64_t rows = 0;
  std::function<void(std::span<glm::vec3>)> next;  // fills as many as it is given

  uint64_t count() const { return chains * rows; }
};

inline constexpr uint32_t defaultIkChains = 10000;
inline constexpr uint64_t defaultIkRows = 100, mostIkRows = 1000000;

// Little-endian float32 x, y, z. Without `chains` each target is a chain of its own, or with Start::previous
// a row of the one chain. Throws Error(input) naming the file.
IkTargets readIkTargets(const std::string& file, std::optional<uint32_t> chains, ik::Start start);

// Seeded, within reach. Start::rest: independent, in directions uniform on the sphere at distances uniform in
// 0.2 to 0.95 of the reach. Start::previous: the first row is such; then each chain's target walks straight
// from one such point to the next, 0.02 of the reach a row.
IkTargets makeIkTargets(uint32_t chains, uint64_t rows, ik::Start start, float reach, uint64_t seed);

}  // namespace skitter::app
