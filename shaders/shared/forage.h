// Herds that forage (shaders/ways/forage_*.comp, docs/foraging.md), as GLSL and C++ both see them.
#ifndef SKITTER_FORAGE_H
#define SKITTER_FORAGE_H

#ifdef __cplusplus
#include <cstdint>

namespace skitter::shared {
#define FORAGE inline constexpr int
#define FORAGE_UINT inline constexpr uint32_t
#else
#define FORAGE const int
#define FORAGE_UINT const uint
#endif

// Places of cells: nothing, the nest, a source of food, a branch in which passages are counted.
FORAGE MOST_SOURCES = 16;
FORAGE MOST_BRANCHES = 16;
FORAGE PLACE_NONE = 0;
FORAGE PLACE_NEST = 1;
FORAGE PLACE_FOOD = 2;
FORAGE PLACE_BRANCH = PLACE_FOOD + MOST_SOURCES;

// A forager's deed in a tick: none, it came home without or with a load, took one from a source, or came
// into a branch. Those of sources and branches follow from their places.
FORAGE DEED_NONE = 0;
FORAGE DEED_EMPTY = 1;
FORAGE DEED_BROUGHT = 2;
FORAGE DEED_AT = 1;  // from a place to its deed

// States of a forager.
FORAGE FORAGE_REST = 0;
FORAGE FORAGE_SEARCH = 1;
FORAGE FORAGE_LADEN = 2;
FORAGE FORAGE_BACK = 3;
FORAGE FORAGE_STATES = 4;

// BINDING_FORAGE_GROUND, uint: what does not change from tick to tick.
FORAGE FORAGE_COLUMNS = 0;
FORAGE FORAGE_ROWS = 1;
FORAGE FORAGE_CELL = 2;      // quanta a side
FORAGE FORAGE_ORIGIN_X = 3;  // int, quanta
FORAGE FORAGE_ORIGIN_Z = 4;
FORAGE FORAGE_NEST_COLUMN = 5;
FORAGE FORAGE_NEST_ROW = 6;
FORAGE FORAGE_SEED_LOW = 7;
FORAGE FORAGE_SEED_HIGH = 8;
FORAGE FORAGE_THRESHOLD = 9;  // grains
FORAGE FORAGE_POWER = 10;
FORAGE FORAGE_LAY_HOME = 11;  // grains
FORAGE FORAGE_LAY_OUT = 12;
FORAGE FORAGE_PATIENCE = 13;
FORAGE FORAGE_AMOUNTS = 16;                           // of the sources
FORAGE FORAGE_CELLS = FORAGE_AMOUNTS + MOST_SOURCES;  // a cell: moves in bits 0 to 7, its place above
FORAGE_UINT FORAGE_PLACE_SHIFT = 8u;

// BINDING_TRAIL, uint: how often each deed was done since the crowd began, then grains in each cell.
FORAGE TRAIL_CELLS = 40;

FORAGE_UINT GRAINS_A_UNIT = 256u;
FORAGE_UINT MOST_GRAINS = (1u << 20) - 1u;
FORAGE FORAGE_QUANTA = 1024;  // in a metre

// Bindings of shaders/ways/forage_lay.comp and forage_fade.comp.
FORAGE BINDING_LAY_FORAGER = 0;  // BINDING_FORAGER
FORAGE BINDING_LAY_TRAIL = 1;
FORAGE BINDING_LAY_RATE = 2;  // BINDING_RATE, where there are levels of rate
struct TrailConstants {
#ifdef __cplusplus
  using uint = uint32_t;
#endif
  uint count;        // agents of the page; cells
  uint evaporation;  // 2^32 times the share of the pheromone that goes
  float tick;
};

#undef FORAGE
#undef FORAGE_UINT
#ifdef __cplusplus
static_assert(PLACE_BRANCH + MOST_BRANCHES + DEED_AT <= TRAIL_CELLS);
}  // namespace skitter::shared
#endif
#endif
