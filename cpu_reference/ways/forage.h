#pragma once

#include <cstdint>
#include <vector>

#include "cpu_reference/types.h"

// Foragers as docs/foraging.md has them: whole numbers but for the velocity, plain loops.
namespace skitter::reference {

// Cells row after row along +z, as those who forage see them. Lengths are in quanta.
struct ForageMap {
  int64_t columns = 0, rows = 0;
  int64_t cell = 1;                     // quanta a side
  int64_t originX = 0, originZ = 0;     // corner of cell (0, 0)
  std::vector<bool> passable = {};      // a cell each
  std::vector<bool> nest = {};          // a cell each
  std::vector<int64_t> source = {};     // of food, in that cell; -1: none
  std::vector<int64_t> branch = {};     // in which passages are counted; -1: none
  std::vector<uint32_t> amounts = {};   // loads of each source at first
  int64_t nestColumn = 0, nestRow = 0;  // of the nest's middle
  size_t branches = 0;
};

struct ForageTuning {
  uint64_t seed = 1;                 // the colony's
  uint64_t leave = 0;                // 2^32 times the chance to leave the nest in a tick
  uint32_t threshold = 0;            // k, grains
  uint32_t power = 2;                // n
  uint32_t layHome = 0, layOut = 0;  // grains a cell, with a load and without
  uint32_t patience = 0;             // cells after which a search is given up
  uint64_t evaporation = 0;          // 2^32 times the share that goes each time
  uint64_t every = 1;                // ticks from one time to the next
};

enum class Foraging { rest, search, laden, back };

struct Forager {
  int64_t cell = -1;  // that it goes to; -1: none
  // Where it has been heading: a sum over its moves, in which each counts three quarters of the next.
  int64_t headingX = 0, headingZ = 0;
  Foraging state = Foraging::rest;
  int64_t steps = 0;        // cells since it left nest or food
  int64_t lastBranch = -1;  // of the last cell that it entered

  bool operator==(const Forager&) const = default;
};

// An agent's deed in a tick, which the trail learns after all agents have decided.
struct ForageDeed {
  int64_t entered = -1;  // a cell; -1: none
  uint32_t grains = 0;   // laid there
  enum class Kind { none, empty, brought, took, passed } kind = Kind::none;
  int64_t of = 0;  // the source or branch

  bool operator==(const ForageDeed&) const = default;
};

struct ForageTrail {
  uint64_t empty = 0, brought = 0;    // returns to the nest without and with a load
  std::vector<uint64_t> taken = {};   // from each source
  std::vector<uint64_t> passed = {};  // entries of each branch
  std::vector<uint32_t> grains = {};  // a cell each

  bool operator==(const ForageTrail&) const = default;
};

struct ForageResult {
  Forager forager;
  ForageDeed deed;
  glm::dvec2 velocity{0};
  double distance = 0;  // metres to what it goes to
};

// The tuning of an agent that ticks in every so many-th tick.
ForageTuning overTicks(const ForageTuning& tuning, int ticks);

// Moves from a cell: bit d for direction d.
uint32_t forageMoves(const ForageMap& map, int64_t cell);

// Agent `number` of the colony in tick `n`, that goes so many m/s; the trail is that before the tick.
ForageResult forage(const ForageTuning& tuning, const ForageMap& map, const ForageTrail& trail,
                    const AgentBody& body, const Forager& before, double speed, int64_t number, uint64_t n);

// An empty trail.
ForageTrail freshTrail(const ForageMap& map);
void layTrail(const ForageDeed& deed, ForageTrail& trail);
// At the end of tick `n`, once all deeds are laid.
void evaporate(const ForageTuning& tuning, uint64_t n, ForageTrail& trail);

}  // namespace skitter::reference
