#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "skitter/export.h"

namespace skitter {

// Levels of rate: who is far from the camera ticks every second, fourth or eighth time, by as much longer a
// tick (docs/levels.md). Agents change rate in blocks of eight that follow each other in their herd.
struct Levels {
  static constexpr uint32_t count = 4;
  static constexpr float farthest = 8000;  // metres, that a distance may be

  // Metres from the camera to which full, half and quarter rate reach; each at least as far as the one
  // before. A block that is slower comes back within 0.89 of it.
  std::array<float, count - 1> distances = {20, 60, 180};
  // Agents that may have full, half and quarter rate; the nearest have the higher one. Within a tenth, so
  // that a level may stay below it by so much.
  std::array<uint32_t, count - 1> most = {1000, 9000, 90000};

  bool operator==(const Levels&) const = default;
};

// "default", or a JSON file with keys `distances` and `most`, each optional. Throws Error(input) that names
// the file, the key and the fault.
SKITTER_API Levels loadLevels(const std::filesystem::path& fileOrDefault);
// The same of JSON text; `name` begins messages.
SKITTER_API Levels parseLevels(std::string_view json, const std::string& name);

// What became of a level.
struct LevelFigures {
  uint32_t rate = 1;        // its agents tick in every so many-th tick
  uint64_t agents = 0;      // that have it after the last tick
  uint64_t agentTicks = 0;  // that were made at it, since the crowd was made
  // Of its agents as they are now, over all ticks in which they were watched: mean slide of a planted foot
  // per stance, leg lengths. None without a stance, or without CrowdOptions::measure.
  std::optional<double> slip = {};
};

}  // namespace skitter
