#pragma once

#include <filesystem>
#include <optional>

namespace skitter {

// `NAME.json` beside a height file `NAME.png`, or `hill.json` beside `hill_403x344.png`.
struct HeightSidecar {
  std::filesystem::path file;  // empty where there is none
  std::optional<double> width, height;
  std::optional<float> spacingX, spacingZ, minHeight, maxHeight;
  std::optional<double> voidValue;
};
// Throws Error(input) naming the sidecar and the key at fault.
HeightSidecar readHeightSidecar(const std::filesystem::path& heights);

// 403 and 344 of "hill_403x344.r16".
struct NamedSize {
  std::optional<uint32_t> columns, rows;
};
NamedSize sizeInName(const std::filesystem::path& heights);

}  // namespace skitter
