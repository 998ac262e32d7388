#include "experiments/page/png.h"

#include <png.h>

#include <vector>

#include "skitter/error.h"

namespace skitter::experiments {

std::string pngOf(uint32_t width, uint32_t height, std::span<const uint8_t> rgba) {
  // Without its alpha, which says nothing.
  std::vector<uint8_t> rgb;
  rgb.reserve(rgba.size() / 4 * 3);
  for (size_t i = 0; i + 3 < rgba.size(); i += 4) rgb.insert(rgb.end(), {rgba[i], rgba[i + 1], rgba[i + 2]});
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = width;
  image.height = height;
  image.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = 0;
  if (!png_image_write_to_memory(&image, nullptr, &size, 0, rgb.data(), 0, nullptr))
    throw inputError(std::string("a picture cannot be written: ") + image.message);
  std::string bytes(size, '\0');
  if (!png_image_write_to_memory(&image, bytes.data(), &size, 0, rgb.data(), 0, nullptr))
    throw inputError(std::string("a picture cannot be written: ") + image.message);
  bytes.resize(size);
  return bytes;
}

}  // namespace skitter::experiments
