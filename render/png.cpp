#include "render/png.h"

#include <fmt/format.h>
#include <png.h>

#include <cassert>
#include <cstring>
#include <vector>

#include "assets/files/partial_file.h"
#include "skitter/error.h"
#include "skitter/image.h"

namespace skitter {
namespace render {

std::string pngOf(uint32_t width, uint32_t height, std::span<const uint8_t> rgba, PngEffort effort) {
  assert(rgba.size() == size_t(width) * height * 4);
  std::vector<uint8_t> rgb(rgba.size() / 4 * 3);
  for (size_t i = 0; i < rgba.size() / 4; ++i) std::memcpy(&rgb[i * 3], &rgba[i * 4], 3);
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = width;
  image.height = height;
  image.format = PNG_FORMAT_RGB;
  if (effort == PngEffort::fast) image.flags = PNG_IMAGE_FLAG_FAST;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string bytes(size, '\0');
  if (png_image_write_to_memory(&image, bytes.data(), &size, 0, rgb.data(), 0, nullptr) == 0)
    throw inputError(std::string("a picture cannot be written: ") + image.message);
  bytes.resize(size);
  return bytes;
}

}  // namespace render

void writePng(const std::filesystem::path& file, uint32_t width, uint32_t height,
              std::span<const uint8_t> rgba) {
  if (width == 0 || height == 0 || rgba.size() != size_t{4} * width * height)
    throw inputError(fmt::format("{}: a picture of {} x {} pixels in {} bytes, expected 4 bytes per pixel",
                                 file.string(), width, height, rgba.size()));
  writeText(file, render::pngOf(width, height, rgba, render::PngEffort::fast));
}

}  // namespace skitter
