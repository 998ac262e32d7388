// Trial and error of agents that adapt (docs/stages/adapt.md), as GLSL and C++ both see it: its numbers, and
// the layout of the map of gaits, a constant table of vec4.
#ifndef SKITTER_ADAPT_H
#define SKITTER_ADAPT_H

#ifdef __cplusplus
namespace skitter::shared {
#define ADAPT_CONST inline constexpr
#define ADAPT_FUNCTION inline constexpr
#else
#define ADAPT_CONST const
#define ADAPT_FUNCTION
#endif

ADAPT_CONST float ADAPT_SETTLE_SECONDS = 1.0;
ADAPT_CONST float ADAPT_COUNTED_SECONDS = 3.2;
ADAPT_CONST float ADAPT_SAFE_MARGIN = 0.03;  // leg lengths: with less, a tick counts as unstable
ADAPT_CONST float ADAPT_LEAST_SPEED = 0.1;   // leg lengths a second: who wants to be slower tries nothing
ADAPT_CONST float ADAPT_DEVIATION = 0.3;     // of what is expected of a gait, before any trial
ADAPT_CONST float ADAPT_NOISE = 0.001;       // variance of a measured fitness
ADAPT_CONST float ADAPT_EXPLORATION = 2.0;   // deviations that a gait may be better than expected
ADAPT_CONST float ADAPT_GOOD_ENOUGH = 0.9;   // share of the best in the map at which a search ends
// The kernel's length, in shares of time. A leg that is idle in one of two gaits is about 0.7 of it apart: a
// bad trial tells of gaits that differ in two such legs, and the few trials reach the others sooner.
ADAPT_CONST float ADAPT_LENGTH = 1.2;

// The map: an entry a candidate,
//   [0] groups, share of the desired velocity, expected fitness; in the first entry the highest of these
//   [1] shift of the homes x, y, z (model, m); in the first entry the first candidate that has the highest
//   [2 + leg] group, lag, neighbours and slowness of a leg, as in `hurt`
//   then the legs' shares of time in which they stand, four a vec4
// and after the entries a row a candidate: its kernel with each candidate, four a vec4.
ADAPT_CONST int GAIT_MAP_LEGS = 2;  // where the vec4 of legs begin
ADAPT_FUNCTION int gaitMapStride(int legs) { return GAIT_MAP_LEGS + legs + (legs + 3) / 4; }
ADAPT_FUNCTION int gaitMapRow(int candidate, int candidates, int legs) {
  return candidates * gaitMapStride(legs) + candidate * ((candidates + 3) / 4);
}
#ifdef __cplusplus
}  // namespace skitter::shared
#endif
#endif
