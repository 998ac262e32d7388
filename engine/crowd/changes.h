#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "gpu/vulkan.h"
#include "skitter/crowd.h"
#include "skitter/records.h"

namespace skitter::crowd {

struct Kind;

// What is to be written of an agent before the next tick.
struct AgentChange {
  uint32_t agent = 0;                                   // of the kind
  bool goal = false, speed = false;                     // all of the goal, or its speed
  bool leaves = false;                                  // its place is empty then
  bool hurt = false;                                    // its legs and its load are as its kind has them
  std::array<float, 4 * shared::GOAL_STRIDE> record{};  // the goal's
  std::optional<Place> stands{};                        // anew, there
  std::optional<glm::vec2> push{};                      // m/s, in the next tick
};

// Those of a kind's agents that wait for the next tick, each agent once. Nothing is kept for a kind whose
// agents nobody has ever changed.
class AgentChanges {
 public:
  bool empty() const { return changes_.empty(); }
  const std::vector<AgentChange>& all() const { return changes_; }
  // Of one of so many agents; what was said of it before stands.
  AgentChange& of(uint32_t agent, uint64_t agents);
  // By agent; afterwards there are none.
  std::vector<AgentChange> take();

 private:
  std::vector<AgentChange> changes_;
  std::vector<uint32_t> places_;  // 1 + where an agent is among the changes, or 0
};

// Writes what waits, of all kinds, between two barriers from and to transfers. Nothing of the host needs to
// outlive the call.
void recordChanges(Crowd::Impl& crowd, vk::CommandBuffer cmd);
bool changesWait(const Crowd::Impl& crowd);

// Writes what waits at once, to the bits that the next tick would have begun with: so a reference can begin
// with them, too. Waits for the device.
void applyChanges(Crowd::Impl& crowd);

// So that measure sees no jump in the next tick, of any of the kind's agents, who all began this moment.
void beginWatch(const Crowd::Impl& crowd, uint32_t kind, vk::CommandBuffer cmd);

}  // namespace skitter::crowd
