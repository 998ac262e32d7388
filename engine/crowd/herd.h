#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "crowd/changes.h"
#include "crowd/clip_records.h"
#include "crowd/damage.h"
#include "crowd/edit.h"
#include "crowd/gait_map.h"
#include "crowd/key_poses.h"
#include "crowd/levels.h"
#include "crowd/load.h"
#include "crowd/regait.h"
#include "crowd/size_run.h"
#include "crowd/stage.h"
#include "crowd/tuning.h"
#include "crowd/ways/fields.h"
#include "crowd/ways/series.h"
#include "crowd/ways/trails.h"
#include "gpu/buffer.h"
#include "gpu/image.h"
#include "gpu/kernel.h"
#include "gpu/timer.h"
#include "shared/bindings.h"
#include "shared/parameters.h"
#include "skitter/crowd.h"
#include "skitter/records.h"

// What a crowd is made of on the device; the stages and the renderer read it.
namespace skitter::crowd {

struct Grid;

// A run of a kind's agents whose records fit the device's bindings.
struct Page : ForRecords<gpu::Buffer> {
  uint32_t firstAgent = 0;
  uint32_t agents = 0;
  gpu::Buffer footfall;  // none unless footfalls are kept
  uint32_t footfallRoom = 0;
  gpu::Buffer awake;                    // blocks with somebody awake, where agents may sleep
  gpu::Buffer list;                     // legs that begin a step this tick
  gpu::Buffer counters;                 // indirect arguments and counts
  gpu::Buffer histogram;                // of reach errors
  gpu::Buffer tint;                     // of each agent, where its kind is tinted; only pictures read it
  gpu::Bindings counted, scattered;     // of the crowd's grid, if it has one
  gpu::Bindings laid;                   // of the kind's trails, if its herds forage
  std::vector<gpu::Bindings> bindings;  // one a stage
};

// How the agents of a kind go over the ground that they know: to goals or, where they forage, by pheromone.
struct Wayfaring {
  Ways ways;                          // what is passable to them
  std::optional<Forage> forage = {};  // where they forage
};

// What equal herds have in common, and their agents of one size: herd after herd in the same pages, so that a
// tick's dispatches do not grow with their number.
struct Kind {
  std::vector<uint64_t> firstAgents;   // the first agent of each of its herds
  uint64_t agents = 0;                 // places for them
  bool reserves = false;               // places may be empty
  bool avoids = false;                 // stages after avoid go by its velocity
  std::optional<Wayfaring> wayfaring;  // where its herds find their way or forage
  int herdSteps = 0;                   // 2 to their power is at least the number of herds in a page
  float size = 1;                      // of its creatures, times the rig that was loaded
  Rig rig;                             // of that size
  Controller controller = Controller::adaptive;
  int legs = 0, bones = 0, groups = 0;  // bones of the longest chain
  IkPlan ik{};
  Tuning tuning;
  ClipSet clipSet;  // without its frames: what a picture and a tool need
  ClipRecords clips;
  gpu::Buffer clipHeads, clipTimes, clipRows, clipLegs, clipBones;
  KeyPoses keyPoses;  // of controller key-poses
  gpu::Buffer keyBuffer;
  gpu::Buffer wallBuffer;       // the scene's obstacles, where its herds avoid
  bool reachTriggered = false;  // legs step when out of reach, without a rhythm
  bool tinted = false;          // some herd of it has a colour or a tint of its own
  bool hurts = false;           // legs of its agents can be hurt, and they can carry loads
  bool reacts = false;          // its agents have reactions
  GaitMap gaitMap;              // where its agents adapt, what they try
  gpu::Buffer gaitMapBuffer;
  std::vector<float> wholeRecord;      // where it hurts: the `hurt` record of an agent that is whole and free
  std::map<uint32_t, Damage> damages;  // of its agents, those that are hurt, as the host has said
  std::map<uint32_t, Load> loads;      // of its agents, those that carry, as the host has said
  std::map<LegPattern, Regait> regaits;  // those that were asked for
  shared::Parameters parameters{};
  gpu::HostBuffer parameterBlock;  // Parameters; written once, before the first tick
  std::vector<float> rigRecords;   // as uploaded to rigBuffer
  gpu::Buffer rigBuffer;
  std::vector<ReadyStage> stages;  // of the controller, those that were asked for
  std::vector<Page> pages;
  SeriesTable series;               // goals in series that its agents have or had, by number
  CostGrid ground;                  // where its herds find their way, without threats
  float threat = 0;                 // Herd::threat
  std::unique_ptr<WayFields> ways;  // where its herds find their way, once it has agents
  std::unique_ptr<Trails> trails;   // where they forage, likewise
  AgentChanges changes;             // for the next tick

  // The place among the kind's herds of the one that an agent is of.
  uint32_t herdOf(uint64_t agent) const;
  // The gait of a pattern, made when it is first asked for.
  const Regait& regaitOf(const LegPattern& pattern);
  // These follow from what the host has said: what an agent carries, and its `hurt` record.
  Load carriedBy(uint32_t agent) const;
  void setLoad(uint32_t agent, const Load& load);
  std::vector<float> hurtRecordOf(uint32_t agent);
  bool findsWay() const { return wayfaring && !wayfaring->forage; }
  bool forages() const { return wayfaring && wayfaring->forage; }
  // Whether stages from body to pose pass over some: sleepers, empty places, or blocks whose turn it is not.
  bool rests(const CrowdOptions& options) const { return options.sleep || reserves || options.levels; }
};

// Who is in a herd's places, as the host has said.
struct Presence {
  // How often somebody has come to a place or left it: even where somebody is there.
  std::vector<uint32_t> generations;
  uint32_t count = 0;  // who are there

  // Of places with those generations.
  explicit Presence(std::vector<uint32_t> made);
  Presence() = default;
  bool has(uint32_t place) const { return generations[place] % 2 == 0; }
  // The lowest empty place, none where all are taken.
  std::optional<uint32_t> lowestEmpty() const;
  void come(uint32_t place);
  void leave(uint32_t place);
  // An even one that no handle has.
  uint32_t nextGeneration() const;
  // As a herd begins: `starts` is Numbering::starts, `generation`, which is even, that of places where
  // somebody is.
  static Presence beginning(const skitter::Herd& from, std::span<const uint32_t> starts, uint32_t generation);

 private:
  uint32_t firstEmpty_ = 0;  // no lower place is empty
};

// A herd of the scene: agents of one size or several, numbered size after size.
struct Herd {
  // One for each of its sizes, at least one, in the order of their agents. No two are of one kind.
  std::vector<SizeRun> runs = {SizeRun{}};
  uint32_t agents = 0;                // its places
  std::vector<uint32_t> starts = {};  // Numbering::starts
  Presence presence = {};
  skitter::Herd from = {};  // as in the scene
  uint64_t seed = 0;        // its own
  // How often its number was freed: even while there is a herd.
  uint32_t generation = 0;
  uint64_t since = 0;  // the tick after which it came

  bool isGone() const { return generation % 2 == 1; }
  // The run that one of its places is in.
  const SizeRun& runOf(uint32_t agent) const;
};

// An agent that is a threat, as it was when the host looked last.
struct SeenThreat {
  uint32_t kind = 0;  // of its own
  Threat threat;

  bool operator==(const SeenThreat&) const = default;
};

// What a run of a herd is known by for as long as the herd is there, whatever becomes of others.
struct RunKey {
  uint32_t number, generation;  // of the herd
  uint32_t run;                 // of its runs

  auto operator<=>(const RunKey&) const = default;
};

// A run, and the herd that it is of.
struct HerdRun {
  uint32_t number;  // of the herd
  const Herd* herd;
  const SizeRun* run;

  uint32_t agentCount() const;  // of those who are there
  RunKey key() const { return {number, herd->generation, static_cast<uint32_t>(run - herd->runs.data())}; }
};

}  // namespace skitter::crowd

namespace skitter {

struct Crowd::Impl {
  const gpu::Context* context = nullptr;
  std::unique_ptr<crowd::Grid> grid;  // where everybody is; none unless a herd avoids
  CrowdOptions options;
  Heightfield terrain;  // heights in memory too: cameras and tools look up the ground
  gpu::Image heights;   // R32F, columns x rows, in state sampled; what every stage and the picture read
  std::vector<crowd::Kind> kinds;
  std::vector<crowd::Herd> herds;  // by number, as in the scene; those that are gone among them
  uint32_t watchEvery = 1;         // measure watches one agent of this many
  uint64_t seed = 0;               // of the scene
  uint32_t revision = 0;           // of kinds and herds: a renderer that has seen another looks again
  crowd::HeightEdits edits;
  std::vector<Event> events;  // the scene's, by time
  uint64_t happened = 0;      // the last tick before which all events have happened
  size_t begun = 0;           // and how many before the next one
  // The kinds of herds that events will add, by the event's number: without agents and pipelines.
  std::map<size_t, std::vector<crowd::Kind>> coming;
  std::vector<Threat> threats;          // by number: Crowd::setThreat
  std::vector<crowd::SeenThreat> seen;  // agents that are threats
  bool threatsAreNew = false;           // no tick has gone by them
  uint64_t watchUntil = 0;              // the last tick in which gait looks at the ground; 0: never
  uint64_t tick = 0;
  uint64_t agentsInTick = 0;  // who were there in it
  uint64_t agentTicks = 0;    // and in all since the crowd was made, where crowding is measured
  float dt = 0;               // of the first tick; 0 before it
  gpu::StageTimer timer;
  std::optional<crowd::RateLevels> rates;  // where there are levels of them
  Scene scene;                             // that it was made of
  bool rigsAreCallers = false;             // not those that the scene names

  // One that is gone has no places. Throws Error(input) where no herd had that number.
  const crowd::Herd& herdAt(uint32_t herd) const;
  crowd::Herd& herdAt(uint32_t herd) { return const_cast<crowd::Herd&>(std::as_const(*this).herdAt(herd)); }
  // One that is there: throws Error(input) for one that is gone, too.
  const crowd::Herd& presentHerdAt(uint32_t herd) const;
  // Throws Error(input) where that herd is gone; `what` reads it.
  void expectHerd(const char* what, HerdId id) const;
  // Of the herd's first size: those of its other sizes differ in lengths alone. Throws as presentHerdAt.
  crowd::Kind& kindOf(uint32_t herd) { return kinds[presentHerdAt(herd).runs.front().kind]; }
  const crowd::Kind& kindOf(uint32_t herd) const { return kinds[presentHerdAt(herd).runs.front().kind]; }
  // Of an agent. Throws Error(input) where the herd has no such place.
  const crowd::Kind& kindOf(uint32_t herd, uint32_t agent) const;
};

namespace crowd {

// Those of all herds that are there, herd after herd, and so by key: each is validated by itself.
std::vector<HerdRun> allRuns(const Crowd::Impl& crowd);
// Those of a kind's agents, in their order.
std::vector<HerdRun> runsOf(const Crowd::Impl& crowd, uint32_t kind);

}  // namespace crowd

inline Crowd::Impl& implOf(Crowd& crowd) { return *crowd.impl_; }
inline const Crowd::Impl& implOf(const Crowd& crowd) { return *crowd.impl_; }

}  // namespace skitter
