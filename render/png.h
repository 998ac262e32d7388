#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace skitter::render {

// fast suits pictures that are written one after another, small those that are kept in a page.
enum class PngEffort { fast, small };

// Tightly packed RGBA8 sRGB rows, top row first, as the bytes of an opaque PNG file.
std::string pngOf(uint32_t width, uint32_t height, std::span<const uint8_t> rgba, PngEffort effort);

}  // namespace skitter::render
