// The colony (docs/colony.md), as GLSL and C++ both see it: bindings of set 0, specialization and push
// constants. All buffers are of uint.
#ifndef SKITTER_COLONY_H
#define SKITTER_COLONY_H

#ifdef __cplusplus
#include <cstdint>

namespace skitter::shared {
#define COLONY inline constexpr int
#define COLONY_UINT inline constexpr uint32_t
#else
#define COLONY const int
#define COLONY_UINT const uint
#endif

COLONY COLONY_GROUND = 0;     // a cell: GROUND_ bits
COLONY COLONY_PHEROMONE = 1;  // eight a cell, 2^-20
COLONY COLONY_WEIGHT = 2;     // eight a cell, of the choice
COLONY COLONY_MARK = 3;       // a bit a cell: word of 32 cells by ant
COLONY COLONY_MOVE = 4;       // eight moves a word: word by ant
COLONY COLONY_TRIP = 5;       // an ant: moves, length or NO_WAY
COLONY COLONY_CHAIN = 6;      // two words for nine candidates: move by crew
COLONY COLONY_CROSSING = 7;   // eight a cell: forward moves of the iteration
COLONY COLONY_TRAIL = 8;      // a cell: 8 times the iteration that laid there, plus the direction
COLONY COLONY_BEST = 9;       // BEST_HEAD numbers, then moves, eight a word

COLONY CONSTANT_RULE = 0;
COLONY_UINT COLONY_MMAS = 0u;  // in the order of ColonyRule
COLONY_UINT COLONY_ACS = 1u;

COLONY_UINT GROUND_OPEN = 0xFFu;     // a bit for each direction in which a move is possible
COLONY_UINT GROUND_COST_SHIFT = 8u;  // cost, 1/256, 18 bits; 0: impassable
COLONY_UINT GROUND_COST = 0x3FFFFu;
COLONY_UINT GROUND_CHANGED = 0x80000000u;  // pheromone is forgotten here

COLONY_UINT NO_WAY = 0xFFFFFFFFu;
COLONY_UINT LONGEST_TRIP = 0x7FFFFFFFu;
COLONY_UINT FULL_PHEROMONE = 1u << 20;

COLONY BEST_MOVES = 0;
COLONY BEST_LENGTH = 1;  // or NO_WAY
COLONY BEST_FOUND = 2;
COLONY BEST_HEAD = 4;

// The tasks of update.
COLONY_UINT UPDATE_WEIGHTS = 0u;
COLONY_UINT UPDATE_ITERATION = 1u;
COLONY_UINT UPDATE_FORGET = 2u;

COLONY COLONY_GROUP = 8;        // invocations that walk: few, so that they spread over a device
COLONY COLONY_CELL_GROUP = 64;  // invocations a group over cells

// Push constants of every entry point, in the units of docs/colony.md.
struct ColonyConstants {
#ifdef __cplusplus
  using uint = uint32_t;
#endif
  uint columns, rows, nest, goal;
  uint ants, crew, steps, passes;
  uint seedLow, seedHigh, iteration, update;
  uint beta, margin, evaporation, least;
  uint bestEvery, greed, wear, forget;
};

#undef COLONY
#undef COLONY_UINT
#ifdef __cplusplus
}  // namespace skitter::shared
#endif
#endif
