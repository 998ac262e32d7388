#ifndef FORAGE_GLSL
#define FORAGE_GLSL
// Headings and choices of foragers (docs/foraging.md), in whole numbers.
#include "shared/forage.h"

// Directions 0 to 7 turn from +x by +z; those with an odd number are diagonal.
ivec2 forageStep(int direction) {
  int at = 4 * direction;
  return ivec2((0x21000122u >> at) & 15u, (0x00012221u >> at) & 15u) - 1;
}

// How far a direction leads along a heading.
int alongHeading(ivec2 heading, int direction) {
  ivec2 by = heading * forageStep(direction);
  return ((direction & 1) == 0 ? 512 : 362) * (by.x + by.y);
}

// How far the direction leads that leads furthest.
int mostAlongHeading(ivec2 heading) {
  ivec2 by = abs(heading);
  return max(512 * max(by.x, by.y), 362 * (by.x + by.y));
}

// The heading after a move.
ivec2 turnedHeading(ivec2 heading, int direction) {
  return ((3 * heading) >> 2) + 256 * forageStep(direction);
}

// The way to the nest over flat ground, 1/512 cell.
int homeLength(ivec2 cell, ivec2 nest) {
  ivec2 apart = abs(cell - nest);
  return 512 * max(apart.x, apart.y) + 212 * min(apart.x, apart.y);
}

// (smell / most) ^ power, 1/1024.
uint attraction(uint smell, uint most, uint power) {
  uint share = 1024u * smell / most, value = share;
  for (uint i = 1u; i < power; ++i) value = (value * share) >> 10;
  return max(value, 1u);
}

// Those of `moves` that are ahead, or where none is, those that turn least.
uint movesAhead(uint moves, ivec2 heading) {
  int most = -0x7fffffff;
  for (int d = 0; d < 8; ++d)
    if ((moves >> d & 1u) != 0u) most = max(most, alongHeading(heading, d));
  int least = most > 0 ? 1 : most;
  for (int d = 0; d < 8; ++d)
    if (alongHeading(heading, d) < least) moves &= ~(1u << d);
  return moves;
}

// Those of them that lead nearer to the nest, if one does.
uint movesHome(uint moves, ivec2 cell, ivec2 nest) {
  uint nearer = moves;
  for (int d = 0; d < 8; ++d)
    if (homeLength(cell + forageStep(d), nest) >= homeLength(cell, nest)) nearer &= ~(1u << d);
  return nearer != 0u ? nearer : moves;
}

// How much a forager prefers a move for its direction alone.
uint preference(ivec2 heading, int direction, bool goesHome, ivec2 cell, ivec2 nest) {
  uint ahead = 4 * alongHeading(heading, direction) > 3 * mostAlongHeading(heading) ? 2u : 1u;
  int nearer = homeLength(cell, nest) - homeLength(cell + forageStep(direction), nest);
  int length = (direction & 1) == 0 ? 512 : 724;
  return goesHome && 2 * nearer > length ? 4u * ahead : ahead;
}

// The first direction up to which the weights add up to more than that share of their sum; 8 where all are 0.
int drawnMove(uint weights[8], uint random) {
  uint sum = 0u, mark, unused, upTo = 0u;
  for (int d = 0; d < 8; ++d) sum += weights[d];
  umulExtended(random, sum, mark, unused);
  int chosen = 0;
  for (int d = 0; d < 8; ++d) {
    upTo += weights[d];
    if (mark >= upTo) chosen = d + 1;
  }
  return chosen;
}

#endif
