#include <fmt/format.h>
#include <png.h>

#include <cassert>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "render/partial_file.h"
#include "skitter/error.h"
#include "skitter/image.h"

namespace skitter {
namespace {

struct Close {
  void operator()(FILE* stream) const { std::fclose(stream); }
};

std::vector<uint8_t> withoutAlpha(std::span<const uint8_t> rgba) {
  std::vector<uint8_t> rgb(rgba.size() / 4 * 3);
  for (size_t i = 0; i < rgba.size() / 4; ++i) std::memcpy(&rgb[i * 3], &rgba[i * 4], 3);
  return rgb;
}

}  // namespace

void writePng(const std::filesystem::path& file, uint32_t width, uint32_t height,
              std::span<const uint8_t> rgba) {
  assert(rgba.size() == size_t(width) * height * 4);
  const auto failed = [&](const std::string& fault) {
    return inputError(fmt::format("{}: cannot be written: {}", file.string(), fault));
  };
  render::PartialFile partial(file);
  std::unique_ptr<FILE, Close> stream(std::fopen(partial.part().c_str(), "wb"));
  if (!stream) throw failed(std::strerror(errno));

  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = width;
  image.height = height;
  image.format = PNG_FORMAT_RGB;
  image.flags = PNG_IMAGE_FLAG_FAST;
  const std::vector<uint8_t> rows = withoutAlpha(rgba);
  errno = 0;
  if (png_image_write_to_stdio(&image, stream.get(), 0, rows.data(), 0, nullptr) == 0)
    throw failed(errno != 0 ? std::strerror(errno) : image.message);
  // A full disk may show only here.
  if (std::fflush(stream.get()) != 0 || std::fclose(stream.release()) != 0)
    throw failed(std::strerror(errno));
  partial.keep();
}

}  // namespace skitter
