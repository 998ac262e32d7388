#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace skitter::base {

// sRGB (IEC 61966-2-1) and linear light, both 0 to 1.
inline float linearOfSrgb(float s) {
  return s <= 0.04045f ? s / 12.92f : std::pow((s + 0.055f) / 1.055f, 2.4f);
}
inline float srgbOfLinear(float v) {
  v = std::clamp(v, 0.0f, 1.0f);
  return v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f;
}

// The light of a byte.
inline float linearOfByte(uint8_t code) {
  static const std::array<float, 256> light = [] {
    std::array<float, 256> table{};
    for (size_t i = 0; i < table.size(); ++i) table[i] = linearOfSrgb(static_cast<float>(i) / 255);
    return table;
  }();
  return light[code];
}

// The byte whose sRGB value is nearest: how many of the bytes' midpoints the light exceeds. Faster than a
// power, of which an image would take millions.
inline uint8_t byteOfLinear(float v) {
  static const std::array<float, 255> midpoints = [] {
    std::array<float, 255> table{};
    for (size_t i = 0; i < table.size(); ++i) table[i] = linearOfSrgb((static_cast<float>(i) + 0.5f) / 255);
    return table;
  }();
  return static_cast<uint8_t>(std::upper_bound(midpoints.begin(), midpoints.end(), v) - midpoints.begin());
}

}  // namespace skitter::base
