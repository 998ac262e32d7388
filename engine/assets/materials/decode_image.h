#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace skitter {

// Why a file is none that can be decoded, as its first bytes show: which other format it has; empty for a PNG
// or JPEG.
std::string notAnImage(std::span<const uint8_t> bytes);

}  // namespace skitter
