// The grid of a crowd that shares its ground (shaders/grid, docs/stages/avoid.md): bindings, push constants.
#ifndef SKITTER_GRID_H
#define SKITTER_GRID_H

#ifdef __cplusplus
#include <cstdint>

namespace skitter::shared {
#define GRID inline constexpr int
#else
#define GRID const int
#endif

// Beside BINDING_BODY.
GRID BINDING_GRID_COUNT = 0;    // a bucket's agents, added to its empty count: uint
GRID BINDING_GRID_COUNTED = 1;  // the same, read
GRID BINDING_GRID_SUM_OUT = 2;  // agents of each run of buckets: float
GRID BINDING_GRID_SUM = 3;
GRID BINDING_GRID_CELL = 4;
GRID BINDING_GRID_CELL_OUT = 5;
GRID BINDING_GRID_PLACE_OUT = 6;
GRID BINDING_GRID_WALKER_OUT = 7;
GRID BINDING_GRID_WALKER = 8;
GRID BINDING_GRID_CROWDING = 9;

// The buckets from a cell to the next one in z, by the highest bit of the number of buckets.
#define GRID_ROW(highestBit) (1 << (highestBit) / 2)

// A key, of an agent near another one, is its power times 2^NEIGHBOUR_KEY_BITS plus where it stands among all
// who are looked at (shaders/stages/neighbours.glsl).
GRID NEIGHBOUR_KEY_BITS = 7;

// Counts begin as the bits of 2^23 as a float, whose last place is 1: integer atomics count in them, and
// loads of vec4 read them as numbers.
#ifdef __cplusplus
inline constexpr uint32_t GRID_EMPTY = 0x4B000000u;
inline constexpr float GRID_EMPTY_NUMBER = 8388608.0f;
#else
const uint GRID_EMPTY = 0x4B000000u;
const float GRID_EMPTY_NUMBER = 8388608.0;
#endif

struct GridConstants {
#ifdef __cplusplus
  uint32_t count;    // agents of the page; runs of buckets
  uint32_t first;    // the number in the crowd of the page's first agent
  uint32_t buckets;  // a power of two
  uint32_t row;      // buckets from a cell to the next one in z
  uint32_t run;      // buckets that one invocation sums up, a multiple of 4
#else
  uint count;
  uint first;
  uint buckets;
  uint row;
  uint run;
#endif
  float quanta;  // in a metre
  float cells;   // in a quantum
  float radius;  // of the page's agents, quanta
  float avoids;  // 1 if their herds do
};

#undef GRID
#ifdef __cplusplus
}  // namespace skitter::shared
#endif
#endif
