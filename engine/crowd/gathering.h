#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "crowd/page.h"
#include "gpu/transfer.h"
#include "skitter/crowd.h"

namespace skitter::crowd {

// Records and other buffers of a crowd's pages that the host gets with one submission.
class Gathering {
 public:
  explicit Gathering(const gpu::Context& context) : downloads_(context) {}

  // A sample of the parts' records, agent after agent and, of an agent, leg after leg; none of those parts
  // whose herd does not keep the record. `records` must stay until finish().
  void add(const Crowd::Impl& crowd, std::span<const Part> parts, Record record, const AgentSample& sample,
           std::vector<float>& records);
  // Fills `into`, which must stay until finish(), from the buffer's beginning on.
  template <class T>
  void add(const gpu::Buffer& buffer, std::span<T> into) {
    downloads_.add(buffer, std::as_writable_bytes(into));
  }

  // Fills all that was added. The crowd's device is idle.
  void finish();

 private:
  // The whole blocks that hold the agents. Records of an agent's legs lie apart in them.
  struct Blocks {
    std::vector<std::byte> bytes;
    std::vector<uint64_t> places;
    uint64_t each;
    std::span<std::byte> records;
  };
  void add(const Part& part, Record record, const AgentSample& sample, std::span<std::byte> records);

  gpu::Downloads downloads_;
  std::vector<Blocks> blocks_;
};

}  // namespace skitter::crowd
