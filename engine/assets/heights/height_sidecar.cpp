#include "assets/heights/height_sidecar.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <limits>

#include "assets/files/file.h"
#include "assets/files/json.h"
#include "skitter/error.h"

namespace skitter {
namespace {

// Where "_403x344" begins in "jacksboro_403x344"; npos where no size trails, or nothing precedes it.
size_t sizeAt(const std::string& stem) {
  constexpr const char* digits = "0123456789";
  const size_t cross = stem.find_last_not_of(digits);
  if (cross == std::string::npos || cross == 0 || cross + 1 == stem.size() || stem[cross] != 'x') {
    return std::string::npos;
  }
  const size_t bar = stem.find_last_not_of(digits, cross - 1);
  if (bar == std::string::npos || bar == 0 || bar + 1 == cross || stem[bar] != '_') return std::string::npos;
  return bar;
}

}  // namespace

HeightSidecar readHeightSidecar(const std::filesystem::path& heights) {
  const std::string stem = heights.stem().string();
  HeightSidecar sidecar;
  std::error_code ignored;
  for (const std::string& candidate : {stem, stem.substr(0, sizeAt(stem))}) {
    const std::filesystem::path file = heights.parent_path() / (candidate + ".json");
    if (!std::filesystem::exists(file, ignored)) continue;
    sidecar.file = file;
    break;
  }
  if (sidecar.file.empty()) return sidecar;

  const std::string name = sidecar.file.string();
  const std::vector<uint8_t> bytes = readFile(sidecar.file);
  const nlohmann::json json = parseJson({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, name);
  if (!json.is_object()) {
    throw inputError(fmt::format("{}: is {}, expected an object", name, describeJson(json)));
  }
  const auto read = [&](const char* key, auto& value) {
    // Narrowing a double beyond a type's range is undefined.
    constexpr auto limit =
        static_cast<double>(std::numeric_limits<typename std::decay_t<decltype(value)>::value_type>::max());
    const auto found = json.find(key);
    if (found == json.end()) return;
    if (!found->is_number() || std::fabs(found->get<double>()) > limit) {
      throw inputError(fmt::format("{}: {} is {}, expected a number", name, key, describeJson(*found)));
    }
    value = found->get<typename std::decay_t<decltype(value)>::value_type>();
  };
  read("width", sidecar.width);
  read("height", sidecar.height);
  read("spacing_x_m", sidecar.spacingX);
  read("spacing_y_m", sidecar.spacingZ);
  read("min_m", sidecar.minHeight);
  read("max_m", sidecar.maxHeight);
  read("void_value", sidecar.voidValue);
  return sidecar;
}

NamedSize sizeInName(const std::filesystem::path& heights) {
  const std::string stem = heights.stem().string();
  const size_t bar = sizeAt(stem);
  if (bar == std::string::npos) return {};
  const char *cross = stem.data() + stem.rfind('x'), *end = stem.data() + stem.size();
  uint32_t columns = 0, rows = 0;
  if (std::from_chars(stem.data() + bar + 1, cross, columns).ec != std::errc{}) return {};
  if (std::from_chars(cross + 1, end, rows).ec != std::errc{}) return {};
  return {columns, rows};
}

}  // namespace skitter
