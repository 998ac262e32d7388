#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <new>

#include "assets/files/file.h"
#include "assets/heights/height_samples.h"
#include "assets/heights/height_sidecar.h"
#include "assets/heights/heightfield_limits.h"
#include "assets/heights/void_fill.h"
#include "skitter/error.h"
#include "skitter/heightfield.h"

namespace skitter {
namespace {

void checkUnit(const std::string& name, const char* unit, double value, double least, double most) {
  if (!isWithin(value, least, most)) {
    throw inputError(fmt::format("{}: {} is {}, expected {} to {}", name, unit, value, least, most));
  }
}

// The size of a raw file: the caller's, else the sidecar's, else the name's.
RawLayout rawLayout(SampleType type, const std::filesystem::path& file, const HeightfieldUnits& units,
                    const HeightSidecar& sidecar) {
  RawLayout layout{type, units.columns, units.rows};
  const auto take = [&](const char* key, std::optional<double> value, std::optional<uint32_t>& side) {
    if (side || !value) return;
    if (!isWithin(*value, minSamples, maxSamples) || *value != std::floor(*value)) {
      throw inputError(fmt::format("{}: {} is {}, expected a whole number from {} to {}",
                                   sidecar.file.string(), key, *value, minSamples, maxSamples));
    }
    side = static_cast<uint32_t>(*value);
  };
  take("width", sidecar.width, layout.columns);
  take("height", sidecar.height, layout.rows);
  if (!layout.columns && !layout.rows) {
    const NamedSize named = sizeInName(file);
    layout.columns = named.columns;
    layout.rows = named.rows;
  }
  return layout;
}

StoredHeights readSamples(const std::filesystem::path& file, const HeightfieldUnits& units,
                          const HeightSidecar& sidecar, std::optional<double> voidValue) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const auto raw = [&](SampleType::Kind kind) {
    return readRawHeights(file, rawLayout({kind}, file, units, sidecar), voidValue);
  };
  if (extension == ".png") return readPngHeights(file, voidValue);
  if (extension == ".r16") return raw(SampleType::Kind::u2);
  if (extension == ".r32f") return raw(SampleType::Kind::f4);
  if (extension == ".hgt") return readHgtHeights(file, voidValue);
  if (extension == ".npy") return readNpyHeights(file, voidValue);
  const FileStream exists(file);
  throw inputError(fmt::format("{}: is no known kind of heights, expected .png, .r16, .r32f, .hgt or .npy",
                               file.string()));
}

// A size told beside the file must be the file's own. Where the caller tells it, the sidecar's is not asked.
void checkSize(const std::filesystem::path& file, const StoredHeights& samples, const HeightfieldUnits& units,
               const HeightSidecar& sidecar) {
  if (units.columns.value_or(samples.columns) != samples.columns ||
      units.rows.value_or(samples.rows) != samples.rows) {
    throw inputError(fmt::format("{}: has {} x {} samples, but columns and rows were said to be {} x {}",
                                 file.string(), samples.columns, samples.rows,
                                 units.columns.value_or(samples.columns), units.rows.value_or(samples.rows)));
  }
  if (units.columns || units.rows) return;
  const double width = sidecar.width.value_or(samples.columns),
               height = sidecar.height.value_or(samples.rows);
  if (width != samples.columns || height != samples.rows) {
    throw inputError(fmt::format("{}: describes {} x {} samples, but {} has {} x {}", sidecar.file.string(),
                                 width, height, file.filename().string(), samples.columns, samples.rows));
  }
}

// The range of the samples that are no voids.
std::pair<float, float> rangeOf(const std::string& name, const StoredHeights& samples) {
  float low = HUGE_VALF, high = -HUGE_VALF;
  for (size_t k = 0; k < samples.values.size(); ++k) {
    const float value = samples.values[k];
    if (std::isnan(value)) continue;
    if (!isWithin(value, -maxHeightMagnitude, maxHeightMagnitude)) {
      throw inputError(fmt::format(
          "{}: column {}, row {} is {}, expected {} to {} m or the value that marks a void", name,
          k % samples.columns, k / samples.columns, value, -maxHeightMagnitude, maxHeightMagnitude));
    }
    low = std::min(low, value);
    high = std::max(high, value);
  }
  if (low > high) throw inputError(fmt::format("{}: has no heights, all of its samples are voids", name));
  return {low, high};
}

// Metres become codes of the range from the lowest sample to the highest.
void encode(StoredHeights& samples, float low, float high) {
  const float range = high - low;
  for (float& value : samples.values) {
    if (!std::isnan(value)) value = range > 0 ? (value - low) / range : 0.0f;
  }
  samples.areCodes = true;
}

Heightfield load(const std::filesystem::path& file, const HeightfieldUnits& units) {
  const std::string name = file.string();
  const HeightSidecar sidecar = readHeightSidecar(file);
  const auto either = [](const auto& first, const auto& second) { return first ? first : second; };
  const auto voidValue = either(units.voidValue, sidecar.voidValue);
  StoredHeights samples = readSamples(file, units, sidecar, voidValue);
  checkSize(file, samples, units, sidecar);

  const float scale = units.scale.value_or(1.0f), exaggeration = units.exaggeration.value_or(1.0f);
  const auto spacingX = either(either(units.spacingX, sidecar.spacingX), samples.spacingX).value_or(0.5f);
  const auto spacingZ = either(either(units.spacingZ, sidecar.spacingZ), samples.spacingZ).value_or(0.5f);
  checkUnit(name, "scale", scale, minScale, maxScale);
  checkUnit(name, "exaggeration", exaggeration, 0, maxExaggeration);
  checkUnit(name, "spacing x", spacingX, minSpacing, maxSpacing);
  checkUnit(name, "spacing z", spacingZ, minSpacing, maxSpacing);
  checkUnit(name, "scaled spacing x", spacingX * scale, minSpacing, maxSpacing);
  checkUnit(name, "scaled spacing z", spacingZ * scale, minSpacing, maxSpacing);

  const auto [lowest, highest] = rangeOf(name, samples);
  float low = lowest, high = highest;
  if (samples.areCodes) {
    low = either(units.minHeight, sidecar.minHeight).value_or(0.0f);
    high = either(units.maxHeight, sidecar.maxHeight).value_or(10.0f);
  } else if (units.minHeight || units.maxHeight) {
    low = units.minHeight.value_or(lowest);
    high = units.maxHeight.value_or(highest);
    encode(samples, lowest, highest);
  }
  checkUnit(name, "minimum height", low, -maxHeightMagnitude, maxHeightMagnitude);
  checkUnit(name, "maximum height", high, -maxHeightMagnitude, maxHeightMagnitude);
  if (low > high) {
    throw inputError(fmt::format("{}: minimum height {} is above maximum height {}", name, low, high));
  }
  checkUnit(name, "scaled height range", (high - low) * scale * exaggeration, 0, maxHeightMagnitude);

  Heightfield field;
  field.name = file.stem().string();
  field.columns = samples.columns;
  field.rows = samples.rows;
  field.spacingX = spacingX * scale;
  field.spacingZ = spacingZ * scale;
  field.heights = std::move(samples.values);
  field.filledVoids = fillVoids(field.heights, field.columns, field.rows);
  // Without `low`, which the centring would take away again at a cost in precision.
  const float metres = (samples.areCodes ? high - low : 1.0f) * scale * exaggeration;
  for (float& h : field.heights) h *= metres;
  centreHeights(field.heights);
  return field;
}

}  // namespace

Heightfield loadHeightfield(const std::filesystem::path& file, const HeightfieldUnits& units) {
  try {
    return load(file, units);
  } catch (const std::bad_alloc&) {
    throw inputError(fmt::format("{}: does not fit into memory", file.string()));
  }
}

}  // namespace skitter
