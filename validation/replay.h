#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cpu_reference/clips/table.h"
#include "cpu_reference/stages/adapt.h"
#include "cpu_reference/stages/avoid.h"
#include "cpu_reference/stages/ik.h"
#include "cpu_reference/stages/swing_key_poses.h"
#include "cpu_reference/types.h"
#include "cpu_reference/ways/way.h"
#include "crowd/clip_records.h"
#include "crowd/controller.h"
#include "crowd/gait_map.h"
#include "crowd/key_poses.h"
#include "crowd/stage_id.h"
#include "crowd/tuning.h"
#include "shared/parameters.h"
#include "skitter/crowd.h"
#include "validation/convert_forage.h"
#include "validation/judge.h"

namespace skitter::validation {

// What the reference is told of a herd; `herdFacts` in herd_facts.h takes it from one.
struct HerdFacts {
  const Rig& rig;
  const Heightfield& terrain;
  shared::Parameters parameters;
  const std::vector<float>& rigRecords;  // include/skitter/records.h
  crowd::IkPlan ik{};
  Controller controller = Controller::adaptive;
  crowd::ClipRecords clips = {};  // where clips are played
  crowd::KeyPoses keyPoses = {};  // of controller key-poses
  uint32_t firstAgent = 0;        // the number in the herd of agent 0 of the states, for messages
  // Where the herd avoids: how, and the numbers in the crowd and in the kind of that agent.
  reference::AvoidTuning avoid = {};
  int64_t firstNumber = 0, firstInKind = 0;
  std::vector<reference::WayField> ways = {};       // the fields of its kind, as they are on the device
  std::vector<reference::WayPlace> wayPlaces = {};  // those of its goals in series
  std::optional<ForageFacts> forage = {};           // where the herd forages
  crowd::GaitMap gaitMap = {};                      // where it adapts
};

// All agents that are there, of the whole crowd: as they were before a tick.
using Surroundings = std::vector<reference::Walker>;

// What every check needs to know about the herd.
struct Setting {
  Controller controller = Controller::adaptive;
  reference::Tuning tuning;
  reference::Heights heights;
  reference::Creature creature;
  int legs = 0, bones = 0;  // bones of the longest chain: shorter ones are padded
  double extent = 0;        // metres, how far the terrain reaches from the world's origin
  reference::IkPlan ik;
  reference::ClipTable clips;
  reference::KeyPoses keyPoses;
  reference::AvoidTuning avoid;
  int64_t firstNumber = 0, firstInKind = 0;
  std::vector<reference::WayField> ways;
  std::vector<reference::WayPlace> wayPlaces;
  std::optional<ForageFacts> forage;
  reference::GaitMap gaitMap;
};

// The creature that an agent is, of a herd that can be hurt, before it reacts.
reference::Creature hurtCreatureOf(const Setting& herd, const HerdState& state, size_t agent);

// `terrain` is a copy that outlives the setting. Throws Error(input) when the rig records' size does not fit
// the rig.
Setting settingOf(const HerdFacts& herd, const Heightfield& terrain);

// The agents of a herd that tick `n` compares: all agents up to `most`, else one of every few, drawn by the
// seed anew in each tick.
AgentSample sampleAt(uint64_t seed, uint64_t n, uint32_t agents, uint32_t most);

// Whether the device had the agent tick in tick `n`, where there are levels of rate. Lockstep holds against
// the reference whose turn it is.
bool hasTurn(uint64_t n, const HerdState& after, size_t agent);

// The records of those agents, from a whole herd's state without metrics.
HerdState sampled(const HerdState& whole, const AgentSample& sample);

// Lock-step replay: of two consecutive states of a herd, every stage of the reference starts from exactly
// what that stage of the engine started from and its result is held against what the engine wrote. Records
// that a stage itself or a later one writes come from `before`, those of earlier stages from `after`. For an
// agent that sleeps, as the device has it, or whose turn it is not, the stages from body to pose compute
// nothing: what they write must be what it was before, and only what is not counts as a sample; what is was
// kept.
class Replay {
 public:
  // Copies what it needs. Of the controller's stages those in `only` are compared; empty: all. Throws
  // Error(input) when the rig records' size does not fit the rig.
  explicit Replay(const HerdFacts& herd, std::vector<crowd::StageId> only = {});
  Replay(const Replay&) = delete;
  Replay& operator=(const Replay&) = delete;

  // `n` is the tick that led from `before` to `after`, states of the same agents: all of these are compared.
  // A state without poses, metrics or footfalls leaves pose, measure or footfall out. `around`, before the
  // tick and by their numbers, is for a herd that avoids. The trail of a colony is compared where the states
  // hold all who forage in it. Throws Error(input) when a record buffer's size
  // does not fit the number of agents, or such a herd's agents are not among `around`.
  void tick(uint64_t n, const HerdState& before, const HerdState& after, const Surroundings& around = {});

  // The terrain was edited before the next tick (Crowd::editHeights).
  void edit(uint32_t x0, uint32_t z0, uint32_t columns, uint32_t rows, std::span<const float> heights);

  // The fields and places are others from the next tick() on.
  void setWays(std::vector<reference::WayField> ways, std::vector<reference::WayPlace> places) {
    setting_.ways = std::move(ways);
    setting_.wayPlaces = std::move(places);
    made_.clear();
    waysAreNew_ = true;
  }

  // Likewise the ground of those who forage.
  void setForage(std::optional<ForageFacts> forage) {
    setting_.forage = std::move(forage);
    made_.clear();
  }

  // The stages that are compared, in order, less those that every tick left out.
  std::vector<StageResult> results() const;
  bool pass() const;
  // A sample has failed already.
  bool hasRefused() const;

 private:
  // For an agent whose tick takes so many of the crowd's, with the creature that it is where its legs can be
  // hurt.
  const Setting& settingFor(const HerdState& after, size_t agent, crowd::StageId stage, uint64_t span);

  Heightfield terrain_;
  Setting setting_;
  std::map<uint64_t, Setting> made_;  // of setting_, by how many ticks an agent's own one takes
  std::vector<crowd::StageId> only_;
  std::vector<Judge> judges_;
  bool waysAreNew_ = true;     // no tick has compared them
  std::vector<bool> leftOut_;  // by every tick so far; before the first, none is
};

// The controller's stages that are replayed, in order, and the records of each that a sleeper keeps.
struct CheckedStage {
  crowd::StageId stage;
  std::vector<Record> writes;
};
std::vector<CheckedStage> checkedStages(Controller controller);

// One line a stage, and why it failed where it did.
std::string table(const std::vector<StageResult>& results);

}  // namespace skitter::validation
