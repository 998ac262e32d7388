#ifndef COLONY_GLSL
#define COLONY_GLSL
// Lengths, shares and moves of a colony (docs/colony.md), in whole numbers.
#include "shared/colony.h"

// Directions 0 to 7 turn from +x by +z; those with an odd number are diagonal.
ivec2 stepOf(uint direction) {
  uint at = 4u * direction;
  return ivec2((0x21000122u >> at) & 15u, (0x00012221u >> at) & 15u) - 1;
}

// The direction of a step other than (0, 0).
uint directionOf(ivec2 by) {
  int at = 3 * (by.y + 1) + by.x + 1;
  return at == 8 ? 1u : (0x23084765u >> (4 * at)) & 15u;
}

// Candidates 0 to 8 are a cell (4) and those around it, row by row.
ivec2 besideOf(int candidate) { return ivec2(candidate % 3, candidate / 3) - 1; }

uint costOf(uint ground) { return (ground >> GROUND_COST_SHIFT) & GROUND_COST; }

// From one cell to the next, by their costs.
uint moveLength(uint from, uint to, uint direction) {
  uint both = from + to;
  return (direction & 1u) == 0u ? both : (181u * both + 64u) >> 7;
}

// The way to the goal over flat ground, 1/512 cell.
int straightLength(ivec2 cell, ivec2 goal) {
  ivec2 apart = abs(cell - goal);
  return 512 * max(apart.x, apart.y) + 212 * min(apart.x, apart.y);
}

// (margin / (margin + detour)) ^ beta, 1/4096.
uint desirabilityOf(uint detour, uint margin, uint beta) {
  uint ratio = 4096u * margin / (margin + detour), eta = 4096u;
  for (uint power = 0u; power < beta; ++power) eta = (eta * ratio) >> 12;
  return max(eta, 1u);
}

// A share of 1/4096 of an amount below 2^20, or a share below 1 of 2^20.
uint shareOf(uint amount, uint share) { return (amount * share) >> 12; }

#endif
