#pragma once

#include <cstdint>

#include "crowd/herd.h"
#include "crowd/spawn.h"

namespace skitter::crowd {

// Bytes an agent in each of the page's record buffers; of `watch`, bytes a watched agent.
struct RecordBytes {
  uint64_t goal, steer, body, gait, step, foot, chain, pose, metric, list, watch, play, start, fix, spring;
  uint64_t largest() const { return std::max({body, step, foot, chain, pose, metric, list, watch, fix}); }
  uint64_t sum(uint32_t watchEvery) const {
    return goal + steer + body + gait + step + foot + chain + pose + metric + list + watch / watchEvery +
           play + start + fix + spring;
  }
};

RecordBytes recordBytes(const Herd& herd);

// What a stage's binding of that number (shaders/shared/bindings.h) is bound to.
gpu::Binding bindingOf(const Crowd::Impl& crowd, const Herd& herd, const Page& page, uint32_t binding);

// The most agents whose records fit the device's bindings. Throws Error(device) when not even one does.
uint32_t agentsPerPage(const gpu::Context& context, const CrowdOptions& options, const RecordBytes& bytes);

// Agents [first, first + agents) of the herd: buffers, their first records, and a descriptor set a stage.
Page makePage(const Crowd::Impl& crowd, const Herd& herd, const Spawner& spawner, uint32_t first,
              uint32_t agents);

}  // namespace skitter::crowd
