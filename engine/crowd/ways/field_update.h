#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "crowd/ways/stops.h"

namespace skitter::crowd {

// A grid as fields see it: the time that each cell takes to cross, less than 0 where it is impassable, as
// BINDING_WAY_COST has it.
std::vector<float> crossingsOf(const CostGrid& grid);

// What has changed for the field of a goal.
struct FieldChange {
  uint32_t columns = 0, rows = 0;
  std::span<const float> crossings;  // as they are now
  std::span<const size_t> changed;   // the cells whose crossings were others,
  std::span<const float> before;     // and what these were
  const Stops& stopsBefore;
  const Stops& stops;
};

// Of a field that was updated: how many of its times were looked at anew, and which rows have others.
struct FieldUpdate {
  size_t cells = 0;
  uint32_t firstRow = 0, rows = 0;
};

// Brings the times of a field to what solving it anew would make of them, to the bit (docs/ways.md#changes).
// None where more than `most` times change: then `times` is of no use any more.
std::optional<FieldUpdate> updateField(const FieldChange& change, size_t most, std::vector<float>& times);

}  // namespace skitter::crowd
