#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "skitter/export.h"

namespace skitter {

// Writes tightly packed RGBA8 sRGB rows, top row first, as an opaque PNG. The file appears whole or not at
// all: it is written as NAME.part and renamed. Throws Error(input) that names the file and the fault, of
// a picture without pixels or of another size, too.
SKITTER_API void writePng(const std::filesystem::path& file, uint32_t width, uint32_t height,
                          std::span<const uint8_t> rgba);

}  // namespace skitter
