#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "cpu_reference/stages/rate.h"
#include "crowd/herd.h"
#include "validation/judge.h"

namespace skitter::validation {

// Whose turn it is in a crowd with levels of rate, and at which rate everybody goes on: all blocks, for who
// has room depends on all.
class RateCheck {
 public:
  // `crowd` outlives this.
  explicit RateCheck(const Crowd::Impl& crowd);
  // Before a tick, and after it.
  void begin();
  void end();
  StageResult result() const { return judge_.result(); }
  bool hasRefused() const { return judge_.hasRefused(); }

 private:
  // An agent as the device has it.
  struct Rated {
    glm::dvec3 place{0};
    int level = 0, lastLevel = 0;
    uint64_t lastTick = 0;
    bool absent = false, disturbed = false, pushed = false;
  };
  using Counts = std::array<uint64_t, reference::rateLevels>;

  // Of each kind, its agents in their order.
  std::vector<std::vector<Rated>> download() const;
  std::vector<uint32_t> words() const;
  void compareCounts(uint64_t n, const Counts& agents);

  const Crowd::Impl& crowd_;
  reference::RateTuning tuning_;
  std::vector<std::vector<Rated>> before_;
  // What the last tick and the one before it counted.
  std::vector<reference::SeenBlock> seen_, seenBefore_;
  Counts agentTicks_{};
  Judge judge_{"wake"};
};

}  // namespace skitter::validation
