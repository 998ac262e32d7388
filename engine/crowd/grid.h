#pragma once

#include <cstdint>

#include "crowd/herd.h"
#include "shared/bindings.h"
#include "shared/grid.h"

namespace skitter::crowd {

// How far agents that avoid see beyond footprints.
inline constexpr float lookLegLengths = 2;

// Records, as the device loads them, may take this many.
uint64_t bytesABinding(const gpu::Context& context);

// How a crowd with a herd that avoids counts places (docs/stages/avoid.md).
struct Quanta {
  float inMetre = 0;
  uint32_t longestReach = 0;  // of any agent, quanta; of those who do not avoid their footprints

  uint32_t radiusOf(const Kind& kind) const;  // of its agents' footprints
  uint32_t lookOf(const Kind& kind) const;    // how far they see beyond footprints
  uint32_t droppedBits() const;               // of a power, so that the rest fits into a key
};
Quanta quantaOf(const Crowd::Impl& crowd);

// Whose turn it is to go first changes with this number, which the tick has.
uint32_t turnOf(const Crowd::Impl& crowd);

// Agents that avoid look around once in a round of so many ticks of `dt` seconds (docs/stages/avoid.md), a
// power of two up to 4.
uint32_t roundTicksOf(float dt);
// Invocations in which all of a page look around whose turn it is.
uint32_t lookersOf(const Page& page, float dt);

// The number in the crowd of a kind's first agent.
uint32_t numberOf(const Crowd::Impl& crowd, const Kind& kind);

bool avoids(const Crowd::Impl& crowd);

// Where everybody is, for stage avoid and for CrowdOptions::crowding: agents of all kinds and pages, cell
// after cell. Refers to nothing of the crowd; its kinds' pages have the bindings.
struct Grid {
  // With room for the agents that the crowd has. Throws Error(device) where a binding does not reach them.
  explicit Grid(const Crowd::Impl& crowd);

  // Sorts all agents, as their bodies are, and measures overlaps if that is asked for, with a barrier after
  // it.
  void record(const Crowd::Impl& crowd, vk::CommandBuffer cmd) const;
  // The constants of a stage that sees the crowd.
  shared::TickConstants constantsOf(const Crowd::Impl& crowd, const Kind& kind, const Page& page,
                                    const Stage& stage, uint64_t tick) const;
  shared::GridConstants gridConstantsOf(const Crowd::Impl& crowd, const Kind& kind, const Page& page) const;
  float cellsAQuantum() const;

  Quanta quanta;
  uint32_t buckets = 0, row = 0, run = 0;
  gpu::Buffer counts, sums, cells, places, walkers;
  gpu::Buffer crowding;  // CROWDING_ figures since the crowd was made
  gpu::Kernel count, sum, place, scatter, overlap;
  gpu::Bindings summed, placed, overlapped;
};

// Device memory of the grid that the crowd needs.
uint64_t bytesOfGrid(const Crowd::Impl& crowd);

// The grid that the crowd needs, with the bindings of all pages. Waits for the device where there is or was
// one. Call it whenever kinds have come or gone, once they have pages.
void shareGround(Crowd::Impl& crowd);

}  // namespace skitter::crowd
