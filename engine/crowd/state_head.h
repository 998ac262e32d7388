#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "crowd/size_run.h"
#include "skitter/records.h"
#include "skitter/state.h"

// What the head of a state says (docs/state.md); nothing here needs a device.
namespace skitter::crowd {

// Bytes of a kind's agents, whatever their pages: a record of each, agent after agent and of an agent leg
// after leg; or without one the footfalls of the last tick, the generation of each agent's place, or the
// trail of those who forage.
struct StateChunk {
  std::string name;
  uint64_t bytes = 0;

  static constexpr const char *footfalls = "footfalls", *generations = "generations", *trail = "trail";
  std::optional<Record> record() const;
};

// What is to be written of an agent before the next tick, as AgentChange.
struct StateChange {
  uint32_t agent = 0;
  bool goal = false, speed = false, leaves = false;
  std::array<float, 4 * shared::GOAL_STRIDE> record{};
  std::vector<float> stands;  // x, z, heading; empty: where it is
  std::vector<float> hurt;    // Damage::values; empty: its legs and its load are as before
  std::vector<float> load;    // the `carried` record; empty: none, where `hurt` is there
  std::vector<float> push;    // x, z; empty: none
};

struct StateKind {
  std::string rig;  // its name, for messages
  uint64_t agents = 0;
  std::vector<uint64_t> firstAgents;  // of its herds
  std::vector<StateChange> changes;
  int legs = 0, bones = 0, joints = 0;
  uint32_t hash = 0;  // of what the simulation knows of rig and clips
  std::vector<StateChunk> chunks;
};

struct StateHerd {
  std::vector<SizeRun> runs;
  uint32_t generation = 0;      // odd: the herd is gone
  uint32_t lastGeneration = 0;  // the highest of its places
  uint64_t since = 0;           // the tick after which it came
  // What the device has counted since the start.
  std::array<uint32_t, shared::ROW_COUNTERS> counts{};
  std::array<uint32_t, shared::HISTOGRAM_BUCKETS> reachErrors{};
};

// A herd that an event will add.
struct StateComing {
  uint64_t event = 0;            // its number
  std::vector<uint32_t> hashes;  // of its kinds, as StateKind::hash
};

struct StateThreat {
  int64_t kind = -1;               // of the agent that it is; -1: Crowd::setThreat's, by number
  std::array<float, 3> disc = {};  // x, z, radius
};

// A goal in series of a kind's table.
struct StateSeries {
  uint32_t kind = 0;  // of agents
  uint32_t first = 0;
  std::vector<float> places;  // x, z of each, as they are now
  uint32_t goal = 0;          // Goal::Kind
  std::array<float, 3> disc = {};
  std::vector<float> named;  // x, z of each place of the goal
  bool loop = false;
  uint32_t leader = 0;
  int64_t agent = -1;  // -1: the middle of the herd
};

// Levels of rate.
struct StateRates {
  std::array<float, Levels::count - 1> distances{};
  std::array<uint32_t, Levels::count - 1> most{};
  std::vector<int32_t> camera;  // x, y, z, quarter metres; empty: none yet
  std::vector<uint32_t> words;  // of shaders/shared/levels.h, from LEVELS_TICKS on
};

// The members of State, and what only its crowd needs.
struct StateHead : State {
  uint64_t watchUntil = 0;  // the last tick in which gait looks at the ground
  bool rigsAreCallers = false;
  uint64_t agentsInTick = 0;
  uint64_t begun = 0;  // of the events before the next tick, those that have happened
  std::vector<StateKind> kinds;
  std::vector<StateHerd> herds;
  std::vector<StateComing> coming;
  std::vector<StateThreat> threats;
  std::vector<StateSeries> series;
  std::optional<StateRates> rates;
};

// Throws Error(input) where the scene or the note cannot be written. The terrain's heights are hashed only.
nlohmann::json jsonOf(const StateHead& head);
// Without the terrain's heights. Throws Error(input) that names the state.
StateHead headOf(const nlohmann::json& json, const std::string& name);

}  // namespace skitter::crowd
