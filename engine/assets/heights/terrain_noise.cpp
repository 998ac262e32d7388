#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "assets/heights/heightfield_limits.h"
#include "base/split_mix.h"
#include "skitter/error.h"
#include "skitter/heightfield.h"

namespace skitter {
namespace {

// Everything here is integer arithmetic and IEEE add, multiply and divide in double, whose results the
// standard fixes; no library function whose last bit may differ between systems.

uint64_t hashOf(uint64_t v) { return base::SplitMix64::draw(v); }

uint64_t hashCell(uint64_t seed, int64_t i, int64_t j) {
  return hashOf(hashOf(seed ^ hashOf(static_cast<uint64_t>(i))) ^ static_cast<uint64_t>(j));
}

// The dot product of the corner's random gradient, with components in [-1, 1), and the offset from it.
double corner(uint64_t seed, int64_t i, int64_t j, double x, double z) {
  const uint64_t hash = hashCell(seed, i, j);
  const double gx = static_cast<double>(static_cast<int32_t>(hash)) / 2147483648.0;
  const double gz = static_cast<double>(static_cast<int32_t>(hash >> 32)) / 2147483648.0;
  return gx * x + gz * z;
}

// Gradient noise with quintic fades (Perlin, "Improving noise", SIGGRAPH 2002), about -1 to 1.
double gradientNoise(uint64_t seed, double x, double z) {
  const double floorX = std::floor(x), floorZ = std::floor(z);
  const auto i = static_cast<int64_t>(floorX), j = static_cast<int64_t>(floorZ);
  const double fx = x - floorX, fz = z - floorZ;
  const auto fade = [](double t) { return t * t * t * (t * (t * 6 - 15) + 10); };
  const auto mix = [](double a, double b, double t) { return a + t * (b - a); };
  const double u = fade(fx), v = fade(fz);
  const double north = mix(corner(seed, i, j, fx, fz), corner(seed, i + 1, j, fx - 1, fz), u);
  const double south = mix(corner(seed, i, j + 1, fx, fz - 1), corner(seed, i + 1, j + 1, fx - 1, fz - 1), u);
  return 1.6 * mix(north, south, v);
}

void check(const char* field, double value, double least, double most) {
  if (!isWithin(value, least, most)) {
    throw inputError(fmt::format("terrain noise: {} is {}, expected {} to {}", field, value, least, most));
  }
}

}  // namespace

Heightfield generateHeightfield(const TerrainNoise& noise) {
  check("columns", noise.columns, minSamples, maxSamples);
  check("rows", noise.rows, minSamples, maxSamples);
  check("spacing", noise.spacing, minSpacing, maxSpacing);
  check("amplitude", noise.amplitude, 0, maxHeightMagnitude);
  check("wavelength", noise.wavelength, minSpacing, maxHeightMagnitude);
  check("octaves", noise.octaves, 1, TerrainNoise::maxOctaves);
  check("gain", noise.gain, 0, 1);

  Heightfield field;
  field.name = "noise";
  field.columns = noise.columns;
  field.rows = noise.rows;
  field.spacingX = field.spacingZ = noise.spacing;
  field.heights.resize(size_t{noise.columns} * noise.rows);
  for (uint32_t row = 0; row < noise.rows; ++row) {
    for (uint32_t column = 0; column < noise.columns; ++column) {
      const double x = (column - 0.5 * (noise.columns - 1)) * noise.spacing;
      const double z = (row - 0.5 * (noise.rows - 1)) * noise.spacing;
      double height = 0, amplitude = 0.5 * noise.amplitude, frequency = 1.0 / noise.wavelength;
      for (int octave = 0; octave < noise.octaves; ++octave) {
        const uint64_t seed = hashOf(noise.seed + 0x632be59bd9b4e019u * static_cast<uint64_t>(octave));
        // A turn by the angle of the 3-4-5 triangle every other octave keeps the lattices from lining up.
        const bool turned = octave % 2 == 1;
        const double u = turned ? 0.8 * x - 0.6 * z : x, v = turned ? 0.6 * x + 0.8 * z : z;
        const double n = gradientNoise(seed, u * frequency, v * frequency);
        // The third octave is folded into ridges, its crease rounded so that a slope stays walkable.
        height += amplitude * (octave == 2 ? 0.6 - 2 * n * n / (std::fabs(n) + 0.25) : n);
        amplitude *= noise.gain;
        frequency *= 2;
      }
      field.heights[size_t{row} * noise.columns + column] = static_cast<float>(height);
    }
  }
  centreHeights(field.heights);
  return field;
}

}  // namespace skitter
