#pragma once

#include <png.h>

#include <cstdint>
#include <functional>
#include <stdexcept>
#include <vector>

#include "skitter/material.h"

namespace skitter::test {

// An image of which each texel is known: red, green, blue and alpha at (x, y).
inline Texels texelsOf(uint32_t width, uint32_t height,
                       const std::function<glm::ivec4(uint32_t, uint32_t)>& texelAt) {
  Texels texels{width, height, {}};
  for (uint32_t y = 0; y < height; ++y)
    for (uint32_t x = 0; x < width; ++x)
      for (int k = 0; k < 4; ++k) texels.rgba.push_back(static_cast<uint8_t>(texelAt(x, y)[k]));
  return texels;
}

// As a PNG file of eight bits, colours and alpha.
inline std::vector<uint8_t> pngBytes(const Texels& texels) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = texels.width;
  image.height = texels.height;
  image.format = PNG_FORMAT_RGBA;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::vector<uint8_t> bytes(size);
  if (png_image_write_to_memory(&image, bytes.data(), &size, 0, texels.rgba.data(), 0, nullptr) == 0)
    throw std::runtime_error(image.message);
  bytes.resize(size);
  return bytes;
}

inline ImageFile pngFile(const Texels& texels, const std::string& name = "made.png") {
  return {.name = name, .bytes = pngBytes(texels), .fault = {}};
}

}  // namespace skitter::test
