#pragma once

#include <cstdint>
#include <vector>

#include "skitter/material.h"

namespace skitter {

// Whether an image's red, green and blue are colours. Alpha is a number at all times.
enum class TexelKind { numbers, srgb };

// An image's levels, from itself to a single texel, each half as wide and high as the one before, rounded
// down. A texel is the mean of those that it lies over, by area; of colours, the mean of their light.
std::vector<Texels> mipLevels(Texels image, TexelKind kind);

}  // namespace skitter
