#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "skitter/export.h"

namespace skitter {

// A terrain y = h(x, z), sampled at the corners of a regular grid and bilinear in between.
// Columns run to +x and rows to +z; the grid is centred on the world's origin and heights are metres relative
// to mid height (the mean of the lowest and the highest sample). Outside, heights clamp to the edge.
struct SKITTER_API Heightfield {
  std::string name;
  uint32_t columns = 0;        // samples along x, at least 2
  uint32_t rows = 0;           // samples along z, at least 2
  float spacingX = 1;          // metres per sample, > 0
  float spacingZ = 1;          // metres per sample, > 0
  std::vector<float> heights;  // rows * columns, row-major, metres, finite
  uint64_t filledVoids = 0;    // samples of the file that had no height and were given one

  float originX() const { return -0.5f * spacingX * static_cast<float>(columns - 1); }  // x of column 0
  float originZ() const { return -0.5f * spacingZ * static_cast<float>(rows - 1); }     // z of row 0
  float extentX() const { return spacingX * static_cast<float>(columns - 1); }
  float extentZ() const { return spacingZ * static_cast<float>(rows - 1); }
  // Throws Error(input) where a size, a spacing or a sample cannot be. A crowd checks the ground that it is
  // made on.
  void check() const;
  // Each of these throws Error(input) where samples are missing.
  //
  // Bilinear height at world (x, z), for spawning, cameras and tools; the simulation samples on the device.
  float at(float x, float z) const;
  // The ground's unit normal there, of the same surface.
  glm::vec3 normalAt(float x, float z) const;
  // The same, but beyond its edge the ground goes on as its mirror image, as it does in pictures.
  float seenAt(float x, float z) const;
  // Replaces the samples of columns [x0, x0 + columns) and rows [z0, z0 + rows) by `samples`, row-major,
  // metres. Throws Error(input) where the rectangle leaves the grid, `samples` has another size or one is not
  // finite.
  void edit(uint32_t x0, uint32_t z0, uint32_t columns, uint32_t rows, std::span<const float> samples);
};

// Facts about a height file beside its samples. An unset value is looked up in the sidecar (`NAME.json`
// beside the file, or `NAME` without a trailing `_WIDTHxHEIGHT`), then in the file itself, then defaults:
// spacing 0.5 m, codes from 0 to 10 m, scale and exaggeration 1. docs/terrain.md tells it in full.
struct HeightfieldUnits {
  std::optional<float> spacingX = {}, spacingZ = {};  // metres per sample, before scale
  // Metres at code 0 and at the highest code, before scale; a file of metres is rescaled to this range.
  std::optional<float> minHeight = {}, maxHeight = {};
  std::optional<float> scale = {};                  // uniform: multiplies spacing and heights alike
  std::optional<float> exaggeration = {};           // multiplies heights alone
  std::optional<uint32_t> columns = {}, rows = {};  // of raw files; others must agree
  std::optional<double> voidValue = {};             // a sample of this value, as stored, is a void

  bool operator==(const HeightfieldUnits&) const = default;
};

// Reads .png (grey, 8 or 16 bits), .r16, .r32f, .hgt (SRTM) or .npy, by the name's extension. Voids are
// filled and counted. Throws Error(input) that names the file and the fault.
SKITTER_API Heightfield loadHeightfield(const std::filesystem::path& file,
                                        const HeightfieldUnits& units = {});

// Rolling ground made of value noise in octaves, with ridges; the same bits for the same arguments.
struct TerrainNoise {
  static constexpr int maxOctaves = 16;

  uint32_t columns = 513, rows = 513;
  float spacing = 0.5f;      // metres per sample
  float amplitude = 8.0f;    // metres, height of the largest hills
  float wavelength = 48.0f;  // metres between the largest hills
  int octaves = 6;
  float gain = 0.47f;  // amplitude ratio between octaves
  uint64_t seed = 1;

  bool operator==(const TerrainNoise&) const = default;
};
SKITTER_API Heightfield generateHeightfield(const TerrainNoise& noise);

}  // namespace skitter
