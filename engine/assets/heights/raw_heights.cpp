#include <fmt/format.h>

#include <cmath>

#include "assets/files/file.h"
#include "assets/heights/height_samples.h"
#include "skitter/error.h"

namespace skitter {
namespace {

uint64_t squareRoot(uint64_t count) {
  auto root = static_cast<uint64_t>(std::sqrt(static_cast<double>(count)));
  while (root * root > count) --root;
  while ((root + 1) * (root + 1) <= count) ++root;
  return root;
}

}  // namespace

StoredHeights readRawHeights(const std::filesystem::path& file, RawLayout layout,
                             std::optional<double> voidValue) {
  const std::string name = file.string();
  FileStream stream(file);
  checkVoidValue(name, layout.type, voidValue);
  const uint64_t sampleBytes = layout.type.bytes(), size = stream.size(), count = size / sampleBytes;

  uint64_t columns = layout.columns.value_or(0), rows = layout.rows.value_or(0);
  if (!layout.columns && !layout.rows) {
    columns = rows = squareRoot(count);
    if (columns * rows * sampleBytes != size) {
      throw inputError(
          fmt::format("{}: has {} bytes, which is no square of {}-byte samples; its size comes from "
                      "--terrain-size, from columns and rows of the scene, from width and height "
                      "of a NAME.json beside it or from a name as hill_403x344{}",
                      name, size, sampleBytes, file.extension().string()));
    }
  } else if (!layout.rows) {
    rows = columns > 0 ? count / columns : 0;
  } else if (!layout.columns) {
    columns = rows > 0 ? count / rows : 0;
  }
  checkSampleCounts(name, columns, rows);
  if (columns * rows * sampleBytes != size) {
    throw inputError(fmt::format("{}: has {} bytes, but {} x {} samples of {} bytes are {}", name, size,
                                 columns, rows, sampleBytes, columns * rows * sampleBytes));
  }

  StoredHeights samples{
      static_cast<uint32_t>(columns), static_cast<uint32_t>(rows), {}, layout.type.isCode(), {}, {}};
  samples.values.resize(columns * rows);
  std::vector<uint8_t> row(columns * sampleBytes);
  for (uint64_t j = 0; j < rows; ++j) {
    stream.read(row.data(), row.size());
    decodeSamples(row.data(), columns, layout.type, voidValue, samples.values.data() + j * columns);
  }
  return samples;
}

}  // namespace skitter
