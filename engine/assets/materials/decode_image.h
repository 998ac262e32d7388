#pragma once

#include <cstdint>
#include <span>

namespace skitter {

// Whether a file begins as a PNG or a JPEG does.
bool isImage(std::span<const uint8_t> bytes);

}  // namespace skitter
