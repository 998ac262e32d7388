// The sRGB transfer functions in doubles (IEC 61966-2-1), which tests hold pictures against.
#pragma once

#include <algorithm>
#include <cmath>

namespace skitter::test {

// Linear light of an sRGB code, 0 to 255 and between.
inline double decodedSrgb(double code) {
  const double s = std::clamp(code / 255, 0.0, 1.0);
  return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}
inline double encodedSrgb(double light) {
  return 255 * (light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055);
}

}  // namespace skitter::test
