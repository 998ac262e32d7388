#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "crowd/herd.h"
#include "crowd/spawn.h"

namespace skitter::crowd {

// So many agents and those that their last block has room for (shaders/shared/records.h).
inline uint32_t wholeBlocks(uint32_t agents) {
  return (agents + shared::BLOCK - 1) / shared::BLOCK * shared::BLOCK;
}

// One of a page's buffers, and how large it is.
struct PageBuffer {
  const char* name;
  gpu::Buffer Page::*buffer;
  uint64_t bytes;  // of an entry: an agent's, or a few agents'
  std::span<float> SpawnRecords::*spawned =
      nullptr;                 // where it is written at first; none: it begins as zeros
  uint32_t agents = 1;         // an entry for so many
  uint64_t most = UINT64_MAX;  // bytes, whatever the number of agents
  gpu::BufferUse use = gpu::BufferUse::records;
  bool inBlocks = false;  // leg records, which come in whole blocks of agents
  uint64_t more = 0;      // bytes after the last entry

  uint64_t bytesOf(uint32_t pageAgents) const {
    const uint64_t count = inBlocks ? wholeBlocks(pageAgents) : pageAgents;
    return std::min(most, (count + agents - 1) / agents * bytes + more);
  }
};

// Those that the herd's controller and what was asked for (poses, figures, footfalls) need.
std::vector<PageBuffer> pageBuffers(const Crowd::Impl& crowd, const Herd& herd);

// What a stage's binding of that number (shaders/shared/bindings.h) is bound to.
gpu::Binding bindingOf(const Crowd::Impl& crowd, const Herd& herd, const Page& page, uint32_t binding);

// The most agents whose records fit the device's bindings. Throws Error(device) when not even one does.
uint32_t agentsPerPage(const Crowd::Impl& crowd, const Herd& herd);

// Device memory that so many agents of the herd take, in pages.
uint64_t bytesOf(const Crowd::Impl& crowd, const Herd& herd, uint32_t agents);

// All agents of the herd: buffers, the records that they begin with, and a descriptor set a stage.
std::vector<Page> makePages(const Crowd::Impl& crowd, const Herd& herd, const Spawner& spawner,
                            uint32_t agents);

// Agents of a page: first, first + stride and so on, `count` of them.
struct PageSample {
  uint32_t first, count;
};
// Those of the sample that the page has.
PageSample sampleOf(const Page& page, const AgentSample& sample);

}  // namespace skitter::crowd
