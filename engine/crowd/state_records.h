#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "crowd/herd.h"
#include "crowd/state_file.h"
#include "crowd/state_head.h"

// A state keeps what the device has of a crowd. These functions read it for a state and put it back.
namespace skitter::crowd {

std::vector<StateChunk> recordChunks(const Crowd::Impl& crowd, const Kind& kind);
uint64_t bytesOfRecords(const Crowd::Impl& crowd, const Kind& kind, Record record);
void writeRecords(const Crowd::Impl& crowd, const Kind& kind, Record record, StateWriter& writer);
void readRecords(const Crowd::Impl& crowd, const Kind& kind, Record record, StateReader& reader);

// A footfall as the device has it; agents are numbered through the kind.
struct RawFootfall {
  std::array<float, size_t{4} * shared::FOOTFALL_STRIDE> values;
  float agent() const { return values[4]; }
  float leg() const { return values[5]; }
};

// They are sorted by agent and leg.
std::vector<RawFootfall> footfallsOf(const Crowd::Impl& crowd, const Kind& kind);
void giveFootfalls(const Crowd::Impl& crowd, const Kind& kind, const std::vector<RawFootfall>& all);

// Both are for crowds with levels of rate. A crowd may take the rates of a state that had other levels.
StateRates ratesOf(const Crowd::Impl& crowd);
void giveRates(const StateRates& rates, Crowd::Impl& crowd);

// This adds what the device has counted for a herd since the start, on all of its pages.
void addCounts(const Crowd::Impl& crowd, uint32_t herd, StateHerd& sums);
// One of its pages gets them all, since only the sum is ever asked for.
void giveCounts(const Crowd::Impl& crowd, uint32_t herd, const StateHerd& counts);

}  // namespace skitter::crowd
