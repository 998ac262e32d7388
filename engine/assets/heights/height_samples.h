#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace skitter {

// What a height file holds, before units are applied and voids are filled.
struct StoredHeights {
  uint32_t columns = 0, rows = 0;
  std::vector<float> values;                // rows * columns, row-major; NaN marks a void
  bool areCodes = false;                    // 0 to 1 of a range; metres otherwise
  std::optional<float> spacingX, spacingZ;  // metres a sample, where the file tells
};

// How a sample is stored. Unsigned samples are codes; signed ones and floats are metres.
struct SampleType {
  enum class Kind { u1, u2, i2, i4, f4, f8 } kind;
  bool bigEndian = false;

  size_t bytes() const;
  bool isCode() const { return kind == Kind::u1 || kind == Kind::u2; }
};

// `voidValue`, a value as stored, becomes a NaN; so does -32768 of i2, the void of SRTM and its kin.
void decodeSamples(const uint8_t* from, size_t count, SampleType, std::optional<double> voidValue, float* to);

// Throws Error(input) naming the file where no sample could have that value.
void checkVoidValue(const std::string& file, SampleType, std::optional<double> voidValue);

// Throws Error(input) naming the file unless both are from minSamples to maxSamples.
void checkSampleCounts(const std::string& file, uint64_t columns, uint64_t rows);

// A side that is unset follows from the other and the file's size; both unset: a square.
struct RawLayout {
  SampleType type;
  std::optional<uint32_t> columns, rows;
};

StoredHeights readPngHeights(const std::filesystem::path& file, std::optional<double> voidValue);
StoredHeights readRawHeights(const std::filesystem::path& file, RawLayout, std::optional<double> voidValue);
// 1201 or 3601 samples a side; the spacing comes from the latitude in the name, where there is one.
StoredHeights readHgtHeights(const std::filesystem::path& file, std::optional<double> voidValue);
StoredHeights readNpyHeights(const std::filesystem::path& file, std::optional<double> voidValue);

}  // namespace skitter
