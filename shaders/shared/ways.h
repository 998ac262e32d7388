// The fields of herds that find their way (shaders/ways, docs/ways.md): layout, bindings, push constants.
#ifndef SKITTER_WAYS_H
#define SKITTER_WAYS_H

#ifdef __cplusplus
#include <cstdint>

namespace skitter::shared {
#define WAY inline constexpr int
#else
#define WAY const int
#endif

// BINDING_WAY: what stage navigate reads, vec4.
//   [0] number of fields, columns, rows, metres a cell
//   [1] x, z of the corner of cell (0, 0), unused x 2
//   [WAY_HEADS + k] field k: x, z of the goal, x, z of its stop
//   [WAY_PLACES + k] place k of goals in series: x, z, the first of those that may come next,
//     how many (0: none)
//   [WAY_TIMES + k * cells + cell] time at the middles of cells (i, j), (i + 1, j), (i, j + 1),
//     (i + 1, j + 1); beyond the grid's end those of its last column or row, of impassable cells beside
//     passable ones as these lead along them
WAY WAY_HEADS = 2;
WAY MOST_WAYS = 16;
WAY WAY_PLACES = WAY_HEADS + MOST_WAYS;
WAY MOST_PLACES = 64;
WAY WAY_TIMES = WAY_PLACES + MOST_PLACES;

// float per cell: cost * cell; where impassable less than 0, and its time follows from that
WAY BINDING_WAY_COST = 0;
WAY BINDING_WAY_TIME = 1;   // float per cell, field after field: time; WAY_FAR where none is known yet
WAY BINDING_WAY_STATE = 2;  // uint per field: 1 while a round lets a time fall
WAY BINDING_WAY_OUT = 3;    // BINDING_WAY

// Invocations that share a diagonal: as many as every device has in a work group.
WAY WAY_GROUP = 128;
// Rounds in one dispatch. On 512 x 512 cells a round is 14,300 turns of loops; Mesa's software device ends
// the loops of an invocation after 65,535.
WAY WAY_ROUNDS = 4;

#ifdef __cplusplus
inline constexpr float WAY_FAR = 1e30f;
// The cost of impassable cells, for those who are in one.
inline constexpr float WAY_INSIDE_COST = 10;
// How much later, in cells, an impassable cell seems than the passable ones beside it, for those between
// them.
inline constexpr float WAY_BESIDE = 0.3f;
// x and z of the goal of those who flee: its times are 0 at every passable cell.
inline constexpr float WAY_OUT = 1e6f;
#else
const float WAY_FAR = 1e30;
#endif

struct WayConstants {
#ifdef __cplusplus
  uint32_t columns, rows;
  uint32_t first;   // field that the first work group solves, or that is gathered
  uint32_t inside;  // 1: impassable cells, once passable ones are solved; 0: these
  uint32_t from;    // the first cell that is gathered
  float beside;     // metres: WAY_BESIDE cells; 0: times lead out of impassable cells, not along them
#else
  uint columns, rows;
  uint first;
  uint inside;
  uint from;
  float beside;
#endif
};

#undef WAY
#ifdef __cplusplus
}  // namespace skitter::shared
#endif
#endif
