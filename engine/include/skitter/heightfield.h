#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace skitter {

// A terrain y = h(x, z), sampled at the corners of a regular grid and bilinear in between.
// Columns run to +x and rows to +z; the grid is centred on the world's origin and heights are metres relative
// to mid height (the mean of the lowest and the highest sample). Outside, heights clamp to the edge.
struct Heightfield {
  std::string name;
  uint32_t columns = 0;        // samples along x, at least 2
  uint32_t rows = 0;           // samples along z, at least 2
  float spacingX = 1;          // metres a sample, > 0
  float spacingZ = 1;          // metres a sample, > 0
  std::vector<float> heights;  // rows * columns, row-major, metres, finite

  float originX() const { return -0.5f * spacingX * static_cast<float>(columns - 1); }  // x of column 0
  float originZ() const { return -0.5f * spacingZ * static_cast<float>(rows - 1); }     // z of row 0
  float extentX() const { return spacingX * static_cast<float>(columns - 1); }
  float extentZ() const { return spacingZ * static_cast<float>(rows - 1); }
  // Bilinear height at world (x, z), for spawning, cameras and tools; the simulation samples on the device.
  float at(float x, float z) const;
};

// Units of a height file. An unset value is looked up in the sidecar (`NAME.json` beside the file, or
// `NAME` without a trailing `_WIDTHxHEIGHT`), then defaults: spacing 0.5 m, heights 0 to 10 m, scale 1.
struct HeightfieldUnits {
  std::optional<float> spacingX, spacingZ;    // metres a sample, before scale
  std::optional<float> minHeight, maxHeight;  // metres at code 0 and code 65535 (or 255), before scale
  std::optional<float> scale;                 // uniform: multiplies spacing and heights alike
};

// Reads a 16-bit (or 8-bit) grey PNG. Throws Error(input) that names the file and the fault.
Heightfield loadHeightfield(const std::filesystem::path& file, const HeightfieldUnits& units = {});

// Rolling ground made of value noise in octaves, with ridges; the same bits for the same arguments.
struct TerrainNoise {
  uint32_t columns = 513, rows = 513;
  float spacing = 0.5f;      // metres a sample
  float amplitude = 8.0f;    // metres, height of the largest hills
  float wavelength = 48.0f;  // metres between the largest hills
  int octaves = 6;
  float gain = 0.47f;  // amplitude ratio between octaves
  uint64_t seed = 1;
};
Heightfield generateHeightfield(const TerrainNoise& noise);

}  // namespace skitter
