#pragma once

#include <vulkan/vulkan.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "skitter/scene.h"

// The types by which a program moves a crowd while it runs (Crowd::steer, setSpeed, teleport;
// docs/steering.md).
namespace skitter {

// A handle of an agent: a herd of the crowd, a place in that herd, and how often agents have come there. It
// never means another agent, not even once its place is taken again. 64 bits, which a C program can keep.
class AgentId {
 public:
  constexpr AgentId() = default;  // of nobody
  constexpr AgentId(uint32_t herd, uint32_t agent, uint32_t generation = 0) {
    if (herd < 1u << 10 && agent < 1u << 24 && generation < 1u << 30)
      bits_ = uint64_t{herd} << 54 | uint64_t{agent} << 30 | generation;
  }
  static constexpr AgentId ofBits(uint64_t bits) {
    AgentId id;
    id.bits_ = bits;
    return id;
  }

  constexpr uint32_t herd() const { return static_cast<uint32_t>(bits_ >> 54); }
  constexpr uint32_t agent() const { return static_cast<uint32_t>(bits_ >> 30 & 0xffffff); }
  constexpr uint32_t generation() const { return static_cast<uint32_t>(bits_ & 0x3fffffff); }
  constexpr uint64_t bits() const { return bits_; }
  constexpr bool operator==(const AgentId&) const = default;

 private:
  uint64_t bits_ = UINT64_MAX;
};

// A handle of a herd: its number, and which herd it is of those that have had that number.
struct HerdId {
  uint32_t index = UINT32_MAX, generation = 0;
  constexpr bool operator==(const HerdId&) const = default;
};

struct AgentGoal {
  AgentId agent;
  Goal goal;
};
struct AgentSpeed {
  AgentId agent;
  float speed = 0;  // metres per second, 0 to Goal::maxSpeed
};
struct AgentPlace {
  AgentId agent;
  Place place;
};

// A leg, by its number in the rig, and what it becomes.
struct AgentLeg {
  AgentId agent;
  uint32_t leg = 0;
  LegState state = LegState::lost;
  // The first bone that a lost leg has lost, counted from the root; none: the second, so that the first is
  // left as a stump, or the only one.
  std::optional<uint32_t> bone = {};
};

// A load, and who carries it.
struct AgentLoad {
  AgentId agent;
  Load load = {};
};

// A push: an impulse over the agent's own mass. Its velocity changes by so much, or by 1 / (1 + m) of it
// where it carries m times its mass.
struct AgentPush {
  AgentId agent;
  glm::vec2 velocity{0};  // x, z, metres per second, at most Push::most long
};

// What an agent of a herd with reactions does (docs/reactions.md).
enum class ReactionPhase { steady, stumbling, falling, lying, righting, rising };
constexpr const char* nameOf(ReactionPhase phase) {
  constexpr std::array names = {"steady", "stumbling", "falling", "lying", "righting", "rising"};
  return names[static_cast<size_t>(phase)];
}
struct Reaction {
  ReactionPhase phase = ReactionPhase::steady;
  // Since the agent came. It fell where there are more falls than before, and stands again likewise.
  uint32_t falls = 0, stands = 0;
  float down = 0;        // seconds since this fall began; 0 for who stands
  float downBefore = 0;  // seconds of all those falls from which it stood again
};

// The states of an agent whose herd adapts (Herd::adapts, docs/evolve.md#while-they-walk).
enum class SearchPhase { atEase, searching, settled };
constexpr const char* nameOf(SearchPhase phase) {
  constexpr std::array names = {"at ease", "searching", "settled"};
  return names[static_cast<size_t>(phase)];
}
struct Search {
  SearchPhase phase = SearchPhase::atEase;
  uint32_t trials = 0;  // that have ended since the agent was hurt last
  float best = 0;       // the highest fitness of these
};

// Goal records of a run of a herd's agents on the device, for shaders of the caller's, which may write them:
// GOAL_STRIDE vec4 per agent (include/skitter/records.h), that of agent firstAgent + i beginning with
// vec4 GOAL_STRIDE * (first + i). Equal herds share buffers. Owned by the crowd.
struct GoalBuffer {
  VkBuffer goals = VK_NULL_HANDLE;      // a storage buffer; binds from its beginning
  uint32_t first = 0;                   // record of agent firstAgent
  uint32_t firstAgent = 0, agents = 0;  // of the herd
};

}  // namespace skitter
