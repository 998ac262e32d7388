#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>

#include "bench/cpu_crowd/avoid/grid.h"

// docs/stages/avoid.md, "1. Neighbours".
namespace skitter::cpu_avoid {

constexpr int mostNeighbours = shared::NEIGHBOURS;

// Of least power comes first, of equal ones the least number.
inline int64_t orderOf(int32_t power, int32_t number) { return (int64_t{power} << 32) | number; }

// The first few of those that are told, in order.
struct FirstFew {
  int64_t order[mostNeighbours];
  int32_t at[mostNeighbours];  // in the grid
  int count = 0;

  void tell(int64_t of, int32_t where) {
    if (count == mostNeighbours && of >= order[mostNeighbours - 1]) return;
    int place = count < mostNeighbours ? count++ : mostNeighbours - 1;
    for (; place > 0 && of < order[place - 1]; --place) {
      order[place] = order[place - 1];
      at[place] = at[place - 1];
    }
    order[place] = of;
    at[place] = where;
  }
};

// The neighbours of the agents of a block, the nearest first.
template <class F>
struct alignas(64) Nearest {
  static constexpr int width = kWidth<F>;
  // Rows beyond the neighbours are of no meaning, but they are places in the grid.
  static constexpr int rows = 16;

  int32_t at[rows][width] = {};     // in the grid
  int32_t power[rows][width] = {};  // quanta^2
  float count[width] = {};          // neighbours
  float seen[width] = {};           // agents in reach
  int most = 0;                     // neighbours of any agent of the block

  void put(int lane, const FirstFew& few) {
    for (int k = 0; k < few.count; ++k) {
      at[k][lane] = few.at[k];
      power[k][lane] = static_cast<int32_t>(few.order[k] >> 32);
    }
  }
  void tell(int lane, int seenThere) {
    const int counted = std::min(seenThere, mostNeighbours);
    seen[lane] = static_cast<float>(seenThere);
    count[lane] = static_cast<float>(counted);
    most = std::max(most, counted);
  }
  void begin() { most = 0; }
};

// Those of the agent at place i of the grid.
inline void findNearest(const Grid<float>& grid, int32_t look, int32_t i, int lane, Nearest<float>& nearest) {
  const int32_t x = grid.x[i], z = grid.z[i], radius = grid.radius[i];
  FirstFew few;
  int seen = 0;
  grid.eachRun(grid.bucket[i], [&](uint32_t first, uint32_t last) {
    for (auto j = static_cast<int32_t>(first); j < static_cast<int32_t>(last); ++j) {
      const int32_t dx = grid.x[j] - x, dz = grid.z[j] - z, radii = grid.radius[j] + radius;
      const int32_t reach = radii + look;
      // Farther away the squares may be beyond an int.
      if (dx > reach || -dx > reach || dz > reach || -dz > reach || j == i) continue;
      const int32_t distance2 = dx * dx + dz * dz;
      if (distance2 > reach * reach) continue;
      ++seen;
      few.tell(orderOf(distance2 - radii * radii, grid.number[j]), j);
    }
  });
  nearest.put(lane, few);
  nearest.tell(lane, seen);
}

// The same with a register of candidates at a time: they lie one after another in the grid. Up to sixteen in
// reach are put in order by counting those before each, without a branch.
inline void findNearest(const Grid<Lanes>& grid, int32_t look, int32_t i, int lane, Nearest<Lanes>& nearest) {
  constexpr int ranked = Nearest<Lanes>::rows, room = 64;
  static_assert(ranked >= kLanes);
  alignas(64) int32_t at[room], power[room], number[room];
  const IntLanes x(grid.x[i]), z(grid.z[i]), own(grid.radius[i]), beyond(look), numbers = countUp();
  FirstFew few;
  int found = 0, seen = 0;
  const auto tellAll = [&] {
    for (int c = 0; c < found; ++c) few.tell(orderOf(power[c], number[c]), at[c]);
    found = 0;
  };
  grid.eachRun(grid.bucket[i], [&](uint32_t first, uint32_t last) {
    for (uint32_t j = first; j < last; j += kLanes) {
      const IntLanes dx = load<IntLanes>(&grid.x[j]) - x, dz = load<IntLanes>(&grid.z[j]) - z;
      const IntLanes radii = load<IntLanes>(&grid.radius[j]) + own, reach = radii + beyond;
      const IntLanes distance2 = dx * dx + dz * dz, across = reach + reach;
      // Farther away the squares may be beyond 32 bits.
      uint64_t set =
          atMost(dx + reach, across) & atMost(dz + reach, across) & atMost(distance2, reach * reach);
      if (last - j < kLanes) set &= (uint64_t{1} << (last - j)) - 1;
      const uint32_t self = static_cast<uint32_t>(i) - j;
      if (self < kLanes) set &= ~(uint64_t{1} << self);
      if (found > room - kLanes) tellAll();
      storeSet(at + found, set, numbers + IntLanes(static_cast<int32_t>(j)));
      storeSet(power + found, set, distance2 - radii * radii);
      storeSet(number + found, set, load<IntLanes>(&grid.number[j]));
      found += std::popcount(set);
      seen += std::popcount(set);
    }
  });
  nearest.tell(lane, seen);
  if (seen > ranked) {
    tellAll();
    nearest.put(lane, few);
    return;
  }
  alignas(64) int64_t order[ranked], before[ranked] = {};
  for (int c = 0; c < ranked; ++c)
    order[c] = c < found ? orderOf(power[c], number[c]) : std::numeric_limits<int64_t>::max();
  for (int j = 0; j < found; ++j)
    for (int c = 0; c < ranked; ++c) before[c] += order[j] < order[c] ? 1 : 0;
  for (int c = 0; c < found; ++c) {
    nearest.at[before[c]][lane] = at[c];
    nearest.power[before[c]][lane] = power[c];
  }
}

}  // namespace skitter::cpu_avoid
