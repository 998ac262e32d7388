#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "crowd/herd.h"
#include "shared/parameters.h"
#include "skitter/crowd.h"

namespace skitter::crowd {

// Where the records go that a page's agents begin with; empty where the page keeps none or they begin as
// zeros.
using SpawnRecords = ForRecords<std::span<float>>;
using GoalRecord = std::array<float, 4 * shared::GOAL_STRIDE>;
using BodyRecord = std::array<float, 4 * shared::BODY_STRIDE>;

// Of an empty place.
BodyRecord absentBody();

// What a herd draws its agents' places, phases and sizes by.
constexpr uint64_t seedOf(uint64_t seedOfScene, uint64_t herd) { return seedOfScene + (herd << 32); }

// A herd's sizes, each once, in the order of the scene; 1 where it names none.
std::vector<float> sizesOf(const skitter::Herd& herd);

// How a herd numbers its agents: size after size. The spawn has n places for n agents, reserve included, and
// each place draws its size by the seed, so that no size is more here than there. The first Herd::agents of
// the spawn's places are where somebody is at first.
struct Numbering {
  std::vector<uint32_t> counts = {};  // agents of each size
  std::vector<uint32_t> starts = {};  // each agent's place of the spawn; empty: its own number
};
Numbering numberingOf(const skitter::Herd& herd, uint64_t seed);

// Where agent i of n starts: the herd's spawn, goal and seed decide alone, so neither pages nor threads ever
// change a crowd. And what an agent's records are where it stands. Agents are those of the herd that have one
// size, counted from 0.
class Spawner {
 public:
  // `starts` are the agents' places of the spawn, which outlive it; empty: their numbers.
  Spawner(const skitter::Herd& from, const Kind& kind, const Heightfield& terrain, uint64_t seed,
          std::span<const uint32_t> starts = {});

  struct Placement {
    float x, z, heading;                     // world metres; radians from +z toward +x
    float targetX, targetZ, otherX, otherZ;  // of the goal, world metres
  };
  Placement place(uint32_t agent) const;
  // With the lane in which the agent starts, where the goal is to cross, or through x.
  GoalRecord goalRecord(uint32_t agent, const Goal& goal) const;
  GoalRecord goalRecord(uint32_t agent, float x, const Goal& goal) const;
  // The nearest place at which goals may lie.
  glm::vec2 within(const glm::vec2& place) const;
  // Agents side by side: place i of the spawn is in row i / lanes(), in lane i % lanes().
  uint32_t lanes() const { return lanes_; }

  // Agents [first, first + count), into a page's records from the at-th on: standing at home, feet on the
  // ground; of the herd's reserve, absent. On all cores where there are many.
  void write(uint32_t first, uint32_t count, uint32_t at, const SpawnRecords& records) const;
  // The agent, standing at home in a place, feet on the ground: the at-th of all records but its goal.
  void stand(uint32_t agent, const Place& place, uint32_t at, const SpawnRecords& records) const;

 private:
  class Writer;
  // The agent's place of the spawn.
  uint32_t spotOf(uint32_t agent) const { return starts_.empty() ? agent : starts_[agent]; }
  Place startOf(uint32_t agent) const;
  // Its target and its other end, x and z, in the lane through `lane`.
  glm::vec4 endsOf(const Goal& goal, float lane) const;
  void pushDirections(size_t leg, Writer& chain) const;
  // Agents [first, first + count), on this core.
  void writeRun(uint32_t first, uint32_t count, uint32_t at, const SpawnRecords& records) const;

  const skitter::Herd& herd_;
  const Rig& rig_;
  const ClipRecords& clips_;
  const KeyPoses& keyPoses_;
  const std::vector<float>& whole_;  // the `hurt` record of whole legs; empty: there is none
  const Heightfield& terrain_;
  const shared::Parameters& tuning_;
  const SeriesTable& series_;
  uint64_t seed_;
  std::span<const uint32_t> starts_;
  uint32_t lanes_ = 1, rows_ = 1;
  float laneSpacing_ = 1, rowSpacing_ = 1;
  float limitX_ = 0, limitZ_ = 0;  // how far from the middle agents start and goals lie
};
Spawner spawnerOf(const Crowd::Impl& crowd, const Herd& herd, const SizeRun& run);

}  // namespace skitter::crowd
