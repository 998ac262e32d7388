#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

namespace skitter {

// Bounds that every source of a heightfield shares: those of a device's 2D images, and of sensible metres.
constexpr uint32_t minSamples = 2, maxSamples = 16384;  // a side
constexpr float minSpacing = 1e-4f, maxSpacing = 1e5f;  // metres a sample
constexpr float maxHeightMagnitude = 1e6f;              // metres
constexpr float minScale = 1e-6f, maxScale = 1e6f;
constexpr float maxExaggeration = 1000;

// False for NaN.
inline bool isWithin(double value, double least, double most) { return value >= least && value <= most; }

// Shifts heights so that the mean of the lowest and the highest is zero.
inline void centreHeights(std::vector<float>& heights) {
  float low = heights.front(), high = heights.front();
  for (float h : heights) {
    low = h < low ? h : low;
    high = h > high ? h : high;
  }
  const float middle = 0.5f * (low + high);
  for (float& h : heights) h -= middle;
}

}  // namespace skitter
