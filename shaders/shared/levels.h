// Levels of rate (docs/levels.md): the buffer of the whole crowd that stage wake reads and writes, unsigned
// integers.
#ifndef SKITTER_LEVELS_H
#define SKITTER_LEVELS_H

#ifdef __cplusplus
namespace skitter::shared {
#define LEVEL inline constexpr int
#else
#define LEVEL const int
#endif

// Distances are squares, in sixteenths of a square metre; differences on each axis are cut to LEVELS_FARTHEST
// quarter metres, so that the sum of three squares fits. The least is LEVELS_NEAREST.
LEVEL LEVELS_FARTHEST = 32767;
LEVEL LEVELS_NEAREST = 8;
// Distances of a histogram: eight buckets of equal width an octave, from LEVELS_NEAREST on.
LEVEL LEVELS_BUCKETS = 232;

// Each level but the last one has a farthest distance, and a number of agents that it and the levels before
// it may have in all. Both are constant.
LEVEL LEVELS_FAR = 0;
LEVEL LEVELS_MOST = 4;
// Each level has two words, low and high: agents times ticks that they have made since the start.
LEVEL LEVELS_TICKS = 8;
// Each level has the number of its agents after the last tick.
LEVEL LEVELS_AGENTS = 16;
// Each level but the last one has a farthest distance at which it has room, in turn for even and odd ticks.
LEVEL LEVELS_EDGE = 24;
LEVEL LEVELS_EDGES = 4;
// The histogram counts agents by the distance of their block before the tick, in turn for even and odd ticks.
LEVEL LEVELS_HISTOGRAM = 32;
LEVEL LEVELS_HISTOGRAM_STRIDE = 256;
LEVEL LEVELS_WORDS = 544;

// Flags of wake's dispatches: there is a camera; the page is the first one of the crowd; and so many times
// the slowest level that the crowd's dt allows.
LEVEL LEVELS_HAS_CAMERA = 1;
LEVEL LEVELS_IS_FIRST = 2;
LEVEL LEVELS_SLOWEST = 4;
// The place of a level in an entry of the list of legs that begin a step.
LEVEL LIST_LEVEL = 1 << 30;

#undef LEVEL
#ifdef __cplusplus
}  // namespace skitter::shared
#endif
#endif
