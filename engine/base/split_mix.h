#pragma once

#include <cstdint>

namespace skitter::base {

// SplitMix64 (Steele, Lea and Flood, "Fast splittable pseudorandom number generators", 2014).
class SplitMix64 {
 public:
  explicit constexpr SplitMix64(uint64_t seed) : state_(seed) {}

  constexpr uint64_t operator()() { return mixed(state_ += increment); }
  // In [0, 1).
  constexpr double uniform() { return static_cast<double>((*this)() >> 11) * 0x1p-53; }

  // The nth draw, counted from 1, of a generator with this seed.
  static constexpr uint64_t draw(uint64_t seed, uint64_t n = 1) { return mixed(seed + increment * n); }

  // The generator's finalizer: one to one, and 0 stays 0.
  static constexpr uint64_t mixed(uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }

 private:
  static constexpr uint64_t increment = 0x9e3779b97f4a7c15u;  // 2^64 / golden ratio
  uint64_t state_;
};

}  // namespace skitter::base
