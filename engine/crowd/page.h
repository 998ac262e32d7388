#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "crowd/herd.h"
#include "crowd/spawn.h"

namespace skitter::crowd {

// So many agents and those that their last block has room for (include/skitter/records.h).
inline uint32_t wholeBlocks(uint32_t agents) {
  return (agents + shared::BLOCK - 1) / shared::BLOCK * shared::BLOCK;
}

constexpr uint64_t bytesOfCounters(int counters) {
  return static_cast<uint64_t>(counters) * sizeof(uint32_t);
}

// One of a page's buffers, and how large it is.
struct PageBuffer {
  const char* name;
  uint64_t bytes;                       // of an entry: an agent's, or a few agents'
  std::optional<Record> record = {};    // that it holds
  gpu::Buffer Page::*buffer = nullptr;  // where it holds none
  bool spawned = false;                 // agents begin with it; else it begins as zeros
  uint32_t agents = 1;                  // an entry for so many
  uint64_t most = UINT64_MAX;           // bytes, whatever the number of agents
  gpu::BufferUse use = gpu::BufferUse::records;
  bool inBlocks = false;  // leg records, which come in whole blocks of agents
  uint64_t more = 0;      // bytes after the last entry

  uint64_t bytesOf(uint32_t pageAgents) const {
    const uint64_t count = inBlocks ? wholeBlocks(pageAgents) : pageAgents;
    return std::min(most, (count + agents - 1) / agents * bytes + more);
  }
  gpu::Buffer& in(Page& page) const { return record ? page.of(*record) : page.*buffer; }
  const gpu::Buffer& in(const Page& page) const { return in(const_cast<Page&>(page)); }
};

// Whether the kind's pages hold those records of every agent; what is only bound has room for one.
bool keeps(const Kind& kind, const CrowdOptions& options, Record record);

// Bytes of one of the kind's records.
uint64_t bytesOfRecord(const Kind& kind, Record record);

// Those that the kind's stages bind.
std::vector<PageBuffer> pageBuffers(const Crowd::Impl& crowd, const Kind& kind);

// What a stage's binding of that number (shaders/shared/bindings.h) is bound to. Throws std::logic_error for
// a number that is none of them.
gpu::Binding bindingOf(const Crowd::Impl& crowd, const Kind& kind, const Page& page, uint32_t binding);
// Those of a stage of the kind.
gpu::Bindings bindingsOf(const Crowd::Impl& crowd, const Kind& kind, const Page& page,
                         const ReadyStage& stage);

// The most agents whose records fit the device's bindings. Throws Error(device) when not even one does.
uint32_t agentsPerPage(const Crowd::Impl& crowd, const Kind& kind);

// Kind::herdSteps, from the kind's other members.
int herdStepsOf(const Crowd::Impl& crowd, const Kind& kind);

// Device memory that the kind's agents take, in pages.
uint64_t bytesOf(const Crowd::Impl& crowd, const Kind& kind);

// All agents of the kind: buffers, the records that they begin with, and a descriptor set a stage. `spawners`
// are those of its herds; without them all records begin as zeros. Stages that see the whole crowd have no
// bindings yet (crowd/grid.h).
std::vector<Page> makePages(const Crowd::Impl& crowd, const Kind& kind, std::span<const Spawner> spawners);

// A herd's agents that are in one page.
struct Part {
  const Kind* kind;
  const Page* page;
  uint32_t firstAgent;     // of the herd, or of the run whose parts these are
  uint32_t first, agents;  // where in the page, and how many
  uint32_t row;            // the herd's in what the page counts for each of its herds
};
// In order.
std::vector<Part> partsOf(const Crowd::Impl& crowd, uint32_t herd);
std::vector<Part> partsOf(const Crowd::Impl& crowd, const SizeRun& run);

// What the page has counted for the part's herd, ROW_ by ROW_. Waits for the device.
using CounterRow = std::array<uint32_t, shared::ROW_COUNTERS>;
CounterRow rowOf(const gpu::Context& context, const Part& part);

// Agents of a run: first, first + stride and so on, `count` of them.
struct RunSample {
  uint32_t first, count;
};
// Those of the sample that are among `agents` from `firstAgent` on; `first` is counted from there.
RunSample sampleOf(uint32_t firstAgent, uint32_t agents, const AgentSample& sample);

}  // namespace skitter::crowd
