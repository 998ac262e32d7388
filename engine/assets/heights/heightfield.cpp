#include "skitter/heightfield.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "assets/heights/heightfield_limits.h"
#include "skitter/error.h"

namespace skitter {

namespace {

float mix(float a, float b, float t) { return a + t * (b - a); }

// A program's own heightfield may be anything.
void expectSamples(const Heightfield& field) {
  if (field.columns >= minSamples && field.rows >= minSamples &&
      field.heights.size() == uint64_t{field.columns} * field.rows)
    return;
  throw inputError(
      fmt::format("{}: {} x {} samples with {} heights, expected at least {} x {}, each with one", field.name,
                  field.columns, field.rows, field.heights.size(), minSamples, minSamples));
}

// The four samples about a place, and where it is between them.
struct Cell {
  const float* north;  // of the row of lower z: the sample of lower x, and the one after it
  const float* south;
  float a, b;  // along x and z, 0 to 1
};

Cell cellAt(const Heightfield& field, float x, float z) {
  expectSamples(field);
  // !(u > 0) also sends a NaN to the edge.
  const auto locate = [](float u, uint32_t samples, size_t& index) {
    const float last = static_cast<float>(samples - 1);
    if (!(u > 0)) u = 0;
    u = std::min(u, last);
    index = std::min<size_t>(static_cast<size_t>(u), samples - 2);
    return u - static_cast<float>(index);
  };
  size_t i = 0, j = 0;
  const float a = locate((x - field.originX()) / field.spacingX, field.columns, i);
  const float b = locate((z - field.originZ()) / field.spacingZ, field.rows, j);
  const float* north = field.heights.data() + j * field.columns + i;
  return {north, north + field.columns, a, b};
}

}  // namespace

float Heightfield::at(float x, float z) const {
  const Cell c = cellAt(*this, x, z);
  return mix(mix(c.north[0], c.north[1], c.a), mix(c.south[0], c.south[1], c.a), c.b);
}

glm::vec3 Heightfield::normalAt(float x, float z) const {
  const Cell c = cellAt(*this, x, z);
  const float slopeX = mix(c.north[1] - c.north[0], c.south[1] - c.south[0], c.b) / spacingX;
  const float slopeZ = (mix(c.south[0], c.south[1], c.a) - mix(c.north[0], c.north[1], c.a)) / spacingZ;
  return glm::normalize(glm::vec3(-slopeX, 1, -slopeZ));
}

float Heightfield::seenAt(float x, float z) const {
  const auto folded = [](float along, float extent) {
    const float turned = std::fmod(std::abs(along), 2 * extent);
    return extent - std::abs(turned - extent);
  };
  return at(originX() + folded(x - originX(), extentX()), originZ() + folded(z - originZ(), extentZ()));
}

void Heightfield::check() const {
  expectSamples(*this);
  for (const float spacing : {spacingX, spacingZ})
    if (!isWithin(spacing, minSpacing, maxSpacing))
      throw inputError(
          fmt::format("{}: a spacing of {} m, expected {} to {}", name, spacing, minSpacing, maxSpacing));
  const auto bad = std::ranges::find_if(heights, [](float h) { return !std::isfinite(h); });
  if (bad != heights.end())
    throw inputError(
        fmt::format("{}: height {} is {}, expected a finite one", name, bad - heights.begin(), *bad));
}

void Heightfield::edit(uint32_t x0, uint32_t z0, uint32_t editColumns, uint32_t editRows,
                       std::span<const float> samples) {
  expectSamples(*this);
  const auto text = [](auto value) { return std::to_string(value); };
  if (uint64_t{x0} + editColumns > columns || uint64_t{z0} + editRows > rows)
    throw inputError(name + ": an edit of " + text(editColumns) + " x " + text(editRows) + " samples at " +
                     text(x0) + ", " + text(z0) + " leaves the " + text(columns) + " x " + text(rows) +
                     " of the terrain");
  if (samples.size() != uint64_t{editColumns} * editRows)
    throw inputError(name + ": an edit of " + text(editColumns) + " x " + text(editRows) + " has " +
                     text(samples.size()) + " samples");
  if (!std::all_of(samples.begin(), samples.end(), [](float h) { return std::isfinite(h); }))
    throw inputError(name + ": an edit has a sample that is not finite");
  for (uint32_t z = 0; z < editRows; ++z)
    std::copy_n(samples.begin() + std::ptrdiff_t{z} * editColumns, editColumns,
                heights.begin() + std::ptrdiff_t{z0 + z} * columns + x0);
}

}  // namespace skitter
