#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "bench/cpu_crowd/avoid/ints.h"
#include "bench/cpu_crowd/avoid/walkers.h"
#include "skitter/records.h"

namespace skitter::cpu_avoid {

// docs/stages/avoid.md, "The grid": hashed cells, and a counting sort of the agents into them. Threads take
// chunks of the agents, and chunks of the buckets. `F` keeps what is compiled for scalars apart from what is
// compiled for SIMD.
template <class F>
class Grid {
 public:
  Grid(const Walkers& walkers, size_t chunks);

  // A tick's, in this order; all but `begin` for each chunk, in any order.
  void count(size_t chunk);    // the agents' buckets, and how many are in each
  void sum(size_t chunk);      // agents in the chunk's buckets
  void begin();                // where the first agents of chunks of buckets go
  void place(size_t chunk);    // where those of each bucket go, chunk of agents after chunk of agents
  void scatter(size_t chunk);  // there they go

  // Calls each(first, last) for the runs of agents in the nine cells about a bucket.
  template <class Each>
  void eachRun(uint32_t about, const Each& each) const {
    for (const uint32_t row : {about - row_, about, about + row_}) {
      const uint32_t low = (row - 1) & mask_, high = (row + 1) & mask_;
      if (low < high) {
        each(begins_[low], begins_[high + 1]);
      } else {  // across the table's end
        each(begins_[low], begins_.back());
        each(0u, begins_[high + 1]);
      }
    }
  }

  // The agents, bucket after bucket, and room for a register after the last one.
  std::vector<int32_t> x, z, radius, number;  // quanta
  std::vector<float> velocityX, velocityZ, share;
  std::vector<uint32_t> bucket;

 private:
  struct Range {
    size_t first, last;
  };
  Range rangeOf(size_t chunk, size_t all) const {
    return {all * chunk / counts_.size(), all * (chunk + 1) / counts_.size()};
  }

  const Walkers& walkers_;
  uint32_t mask_, row_;
  float cells_;  // in a quantum
  // Of each agent by its number.
  std::vector<int32_t> placeX_, placeZ_;
  std::vector<uint32_t> bucket_;
  // Of each chunk of agents, how many are in each bucket, and then where the next of these goes.
  std::vector<std::vector<uint32_t>> counts_;
  std::vector<uint32_t> sums_;    // agents in each chunk of buckets, and then before it
  std::vector<uint32_t> begins_;  // of each bucket, and the end
};

template <class F>
Grid<F>::Grid(const Walkers& walkers, size_t chunks) : walkers_(walkers) {
  const size_t agents = walkers.size(), padded = agents + size_t{kWidth<F>};
  const auto buckets = static_cast<uint32_t>(std::bit_ceil(std::max<size_t>(2 * agents, 256)));
  mask_ = buckets - 1;
  row_ = 1u << (std::bit_width(buckets) - 1) / 2;
  const int32_t widest = agents > 0 ? *std::ranges::max_element(walkers.radius) : 1;
  cells_ = 1 / std::max(1.01f * static_cast<float>(2 * widest + walkers.look), 128.0f);
  for (std::vector<int32_t>* each : {&x, &z, &radius, &number, &placeX_, &placeZ_}) each->resize(padded);
  for (std::vector<float>* each : {&velocityX, &velocityZ, &share}) each->resize(padded);
  bucket.resize(padded);
  bucket_.resize(padded);
  counts_.assign(chunks, std::vector<uint32_t>(buckets));
  sums_.resize(chunks);
  begins_.resize(buckets + 1);
}

template <class F>
void Grid<F>::count(size_t chunk) {
  const auto [first, last] = rangeOf(chunk, walkers_.size());
  const float quanta = walkers_.quanta, tile = shared::TILE_SIZE * quanta, cells = cells_;
  const float *tileX = walkers_.tileX.data(), *tileZ = walkers_.tileZ.data();
  const float *localX = walkers_.localX.data(), *localZ = walkers_.localZ.data();
  int32_t* __restrict placeX = placeX_.data(), * __restrict placeZ = placeZ_.data();
  uint32_t* __restrict into = bucket_.data();
  const auto row = static_cast<int32_t>(row_);
  for (size_t i = first; i < last; ++i) {
    const float atX = tileX[i] * tile + std::floor(localX[i] * quanta);
    const float atZ = tileZ[i] * tile + std::floor(localZ[i] * quanta);
    placeX[i] = static_cast<int32_t>(atX);
    placeZ[i] = static_cast<int32_t>(atZ);
    const auto cellX = static_cast<int32_t>(std::floor(atX * cells));
    const auto cellZ = static_cast<int32_t>(std::floor(atZ * cells));
    into[i] = static_cast<uint32_t>(cellX + row * cellZ) & mask_;
  }
  std::vector<uint32_t>& counts = counts_[chunk];
  std::ranges::fill(counts, 0u);
  for (size_t i = first; i < last; ++i) ++counts[into[i]];
}

template <class F>
void Grid<F>::sum(size_t chunk) {
  const auto [first, last] = rangeOf(chunk, mask_ + size_t{1});
  uint32_t sum = 0;
  for (const std::vector<uint32_t>& counts : counts_)
    for (size_t b = first; b < last; ++b) sum += counts[b];
  sums_[chunk] = sum;
}

template <class F>
void Grid<F>::begin() {
  uint32_t before = 0;
  for (uint32_t& sum : sums_) {
    const uint32_t own = sum;
    sum = before;
    before += own;
  }
  begins_.back() = before;
}

template <class F>
void Grid<F>::place(size_t chunk) {
  const auto [first, last] = rangeOf(chunk, mask_ + size_t{1});
  uint32_t next = sums_[chunk];
  for (size_t b = first; b < last; ++b) {
    begins_[b] = next;
    for (std::vector<uint32_t>& counts : counts_) {
      const uint32_t own = counts[b];
      counts[b] = next;
      next += own;
    }
  }
}

template <class F>
void Grid<F>::scatter(size_t chunk) {
  const auto [first, last] = rangeOf(chunk, walkers_.size());
  std::vector<uint32_t>& next = counts_[chunk];
  for (size_t i = first; i < last; ++i) {
    const uint32_t at = next[bucket_[i]]++;
    x[at] = placeX_[i];
    z[at] = placeZ_[i];
    radius[at] = walkers_.radius[i];
    number[at] = static_cast<int32_t>(i);
    bucket[at] = bucket_[i];
    velocityX[at] = walkers_.speed[i] * walkers_.headingX[i];
    velocityZ[at] = walkers_.speed[i] * walkers_.headingZ[i];
    share[at] = walkers_.share[i];
  }
}

}  // namespace skitter::cpu_avoid
