#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace skitter::experiments {

// Tightly packed RGBA8 sRGB rows, top row first, as the bytes of an opaque PNG file.
std::string pngOf(uint32_t width, uint32_t height, std::span<const uint8_t> rgba);

}  // namespace skitter::experiments
