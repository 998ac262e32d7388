#include "assets/heights/void_fill.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace skitter {
namespace {

struct Grid {
  std::vector<float>& values;
  uint32_t columns, rows;
};

// Each sample is the mean of those of its four children that are known.
std::vector<float> halve(const Grid& fine, uint32_t columns, uint32_t rows) {
  std::vector<float> coarse(size_t{columns} * rows);
  for (uint32_t j = 0; j < rows; ++j) {
    for (uint32_t i = 0; i < columns; ++i) {
      float sum = 0;
      int known = 0;
      for (uint32_t y = 2 * j; y < std::min(2 * j + 2, fine.rows); ++y) {
        for (uint32_t x = 2 * i; x < std::min(2 * i + 2, fine.columns); ++x) {
          const float child = fine.values[size_t{y} * fine.columns + x];
          if (std::isnan(child)) continue;
          sum += child;
          ++known;
        }
      }
      coarse[size_t{j} * columns + i] =
          known > 0 ? sum / static_cast<float>(known) : std::numeric_limits<float>::quiet_NaN();
    }
  }
  return coarse;
}

// Bilinear between the coarse samples, which lie in the middle of their four children.
float atFine(const Grid& coarse, uint32_t x, uint32_t y) {
  const auto locate = [](uint32_t fine, uint32_t samples, uint32_t& near, uint32_t& far) {
    near = fine / 2;
    far = fine % 2 == 0 ? (near > 0 ? near - 1 : near) : std::min(near + 1, samples - 1);
  };
  uint32_t i = 0, i2 = 0, j = 0, j2 = 0;
  locate(x, coarse.columns, i, i2);
  locate(y, coarse.rows, j, j2);
  const auto value = [&](uint32_t column, uint32_t row) {
    return coarse.values[size_t{row} * coarse.columns + column];
  };
  return 0.75f * (0.75f * value(i, j) + 0.25f * value(i2, j)) +
         0.25f * (0.75f * value(i, j2) + 0.25f * value(i2, j2));
}

// Gauss-Seidel in alternating directions.
void relax(const Grid& grid, const std::vector<uint32_t>& voids, int sweeps) {
  const auto update = [&](uint32_t k) {
    const uint32_t i = k % grid.columns, j = k / grid.columns;
    float sum = 0;
    int neighbours = 0;
    const auto add = [&](bool there, size_t at) {
      if (!there) return;
      sum += grid.values[at];
      ++neighbours;
    };
    add(i > 0, size_t{k} - 1);
    add(i + 1 < grid.columns, size_t{k} + 1);
    add(j > 0, size_t{k} - grid.columns);
    add(j + 1 < grid.rows, size_t{k} + grid.columns);
    grid.values[k] = sum / static_cast<float>(neighbours);
  };
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    if (sweep % 2 == 0) {
      std::for_each(voids.begin(), voids.end(), update);
    } else {
      std::for_each(voids.rbegin(), voids.rend(), update);
    }
  }
}

// The cascade: the grid of half the resolution is filled first and is where the sweeps start from, so that
// few are needed here. Coarse grids take more sweeps, which cost little there (Bornemann and Deuflhard, "The
// cascadic multigrid method for elliptic problems", 1996).
void fill(const Grid& grid, const std::vector<uint32_t>& voids, int sweeps) {
  constexpr int mostSweeps = 1024;
  const uint32_t columns = (grid.columns + 1) / 2, rows = (grid.rows + 1) / 2;
  std::vector<float> values = halve(grid, columns, rows);
  const Grid coarse{values, columns, rows};
  std::vector<uint32_t> coarseVoids;
  for (uint32_t k = 0; k < values.size(); ++k) {
    if (std::isnan(values[k])) coarseVoids.push_back(k);
  }
  if (!coarseVoids.empty()) fill(coarse, coarseVoids, std::min(2 * sweeps, mostSweeps));
  for (const uint32_t k : voids) grid.values[k] = atFine(coarse, k % grid.columns, k / grid.columns);
  relax(grid, voids, sweeps);
}

}  // namespace

uint64_t fillVoids(std::vector<float>& values, uint32_t columns, uint32_t rows) {
  constexpr int finestSweeps = 16;
  const size_t count =
      static_cast<size_t>(std::count_if(values.begin(), values.end(), [](float v) { return std::isnan(v); }));
  if (count == 0 || count == values.size()) return count;
  std::vector<uint32_t> voids;
  voids.reserve(count);
  for (uint32_t k = 0; k < values.size(); ++k) {
    if (std::isnan(values[k])) voids.push_back(k);
  }
  fill({values, columns, rows}, voids, finestSweeps);
  return count;
}

}  // namespace skitter
