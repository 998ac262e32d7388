#include <fmt/format.h>

#include <cctype>
#include <cmath>
#include <numbers>

#include "assets/files/file.h"
#include "assets/heights/height_samples.h"
#include "skitter/error.h"

namespace skitter {
namespace {

// The latitude of the middle of the one-degree tile. The name gives the south-west corner: "N27E086.hgt" and
// "n27_e086_1arc_v3.hgt" are both 27.5.
std::optional<double> latitudeOf(const std::string& stem) {
  size_t at = 0;
  const auto letter = [&](char positive, char negative) -> std::optional<int> {
    if (at >= stem.size()) return {};
    const char c = static_cast<char>(std::toupper(static_cast<unsigned char>(stem[at++])));
    if (c != positive && c != negative) return {};
    return c == positive ? 1 : -1;
  };
  const auto whole = [&](size_t digits) -> std::optional<int> {
    int value = 0;
    for (size_t k = 0; k < digits; ++k, ++at) {
      if (at >= stem.size() || !std::isdigit(static_cast<unsigned char>(stem[at]))) return {};
      value = 10 * value + (stem[at] - '0');
    }
    return value;
  };
  const auto north = letter('N', 'S');
  const auto latitude = north ? whole(2) : std::nullopt;
  if (latitude && at < stem.size() && stem[at] == '_') ++at;
  const auto east = latitude ? letter('E', 'W') : std::nullopt;
  const auto longitude = east ? whole(3) : std::nullopt;
  if (!longitude || *longitude > 180) return {};
  const double corner = *north * *latitude;
  if (corner < -90 || corner > 89) return {};
  return corner + 0.5;
}

}  // namespace

StoredHeights readHgtHeights(const std::filesystem::path& file, std::optional<double> voidValue) {
  const SampleType type{SampleType::Kind::i2, true};
  const uint64_t size = FileStream(file).size();
  const auto isTile = [&](uint64_t side) { return size == side * side * type.bytes(); };
  if (!isTile(1201) && !isTile(3601)) {
    throw inputError(
        fmt::format("{}: has {} bytes, expected {} (SRTM3, 1201 x 1201 samples) or {} (SRTM1, 3601 x 3601)",
                    file.string(), size, 1201 * 1201 * 2, 3601 * 3601 * 2));
  }
  StoredHeights samples = readRawHeights(file, {type, {}, {}}, voidValue);
  if (const auto degrees = latitudeOf(file.stem().string())) {
    // Metres a degree of latitude and of longitude on WGS 84, good to a centimetre: National Imagery and
    // Mapping Agency, "The American Practical Navigator" (2002).
    const double phi = *degrees * std::numbers::pi / 180, intervals = samples.columns - 1;
    const double alongMeridian = 111132.92 - 559.82 * std::cos(2 * phi) + 1.175 * std::cos(4 * phi);
    const double alongParallel =
        111412.84 * std::cos(phi) - 93.5 * std::cos(3 * phi) + 0.118 * std::cos(5 * phi);
    samples.spacingX = static_cast<float>(alongParallel / intervals);
    samples.spacingZ = static_cast<float>(alongMeridian / intervals);
  }
  return samples;
}

}  // namespace skitter
