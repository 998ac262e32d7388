// The time of a cell of a field (docs/ways.md), as device and host both compute it.
#ifndef SKITTER_EIKONAL_H
#define SKITTER_EIKONAL_H

#ifdef __cplusplus
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace skitter::shared {
#define EIKONAL inline
using eikonal_uint = uint32_t;
inline eikonal_uint floatBitsToUint(float x) { return std::bit_cast<eikonal_uint>(x); }
inline float uintBitsToFloat(eikonal_uint x) { return std::bit_cast<float>(x); }
#else
#define EIKONAL
#define eikonal_uint uint
#endif

// A crossing is 2^18 to 2^19 units: its square root is known to less than a unit where it errs by 5 ulp.
#ifdef __cplusplus
inline constexpr eikonal_uint EIKONAL_UNITS = 18u << 23;
#else
const uint EIKONAL_UNITS = 18u << 23;
#endif

// Whether m^2 + (m - apart)^2 > across^2. The squares wrap, their difference does not, as long as m is near
// the root.
EIKONAL bool isBeyond(eikonal_uint m, eikonal_uint apart, eikonal_uint across) {
  return int(m * m + (m - apart) * (m - apart) - across * across) > 0;
}

// From the lesser times a and b beside the cell in x and z, 0 or more, and the time h > 0 that it takes to
// cross it: Godunov's upwind scheme in whole units of the cell. Greater than the times that it depends on,
// and never less where one of them is greater: no order of cells shows in the times of a field.
EIKONAL float eikonal(float a, float b, float h) {
#ifdef __cplusplus
  using std::floor, std::max, std::min, std::sqrt;
#endif
  eikonal_uint power = floatBitsToUint(h) & 0x7f800000u;  // of two, h at most
  float unit = uintBitsToFloat(power - EIKONAL_UNITS);
  float inUnits = uintBitsToFloat(0x7f000000u - power + EIKONAL_UNITS);
  float first = floor(min(a, b) * inUnits), second = floor(max(a, b) * inUnits), across = floor(h * inUnits);
  float alone = first + across;
  // Where both times are far beyond any, their difference may be no number.
  float apart = second - first;
  apart = apart < across ? apart : across;
  eikonal_uint wholeApart = eikonal_uint(apart), wholeAcross = eikonal_uint(across);
  eikonal_uint m = eikonal_uint(0.5f * (apart + sqrt(2.0f * across * across - apart * apart)));
  m = isBeyond(m, wholeApart, wholeAcross) ? m - 1u : m;
  m = isBeyond(m + 1u, wholeApart, wholeAcross) ? m : m + 1u;
  // The next whole number that float32 has.
  float later = second < 16777216.0f ? second + 1.0f : uintBitsToFloat(floatBitsToUint(second) + 1u);
  return (second < alone ? max(first + float(m), later) : alone) * unit;
}

#undef EIKONAL
#ifdef __cplusplus
}  // namespace skitter::shared
#else
#undef eikonal_uint
#endif
#endif
