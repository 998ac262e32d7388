#include "assets/materials/decode_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <new>
#include <string_view>

#include "assets/files/jpeg_reader.h"
#include "assets/files/png_reader.h"
#include "skitter/error.h"
#include "skitter/material.h"

namespace skitter {
namespace {

constexpr uint32_t maxSide = 16384;                // texels
constexpr uint64_t maxTexels = uint64_t{1} << 26;  // of an image, whatever the file says

template <typename... Arguments>
[[noreturn]] void refuse(const ImageFile& image, fmt::format_string<Arguments...> format,
                         Arguments&&... arguments) {
  throw inputError(image.name + ": " + fmt::format(format, std::forward<Arguments>(arguments)...));
}

// Room for an image of the reader's size.
template <class Reader>
Texels roomFor(const ImageFile& image, const Reader& reader) {
  Texels texels{reader.columns(), reader.rows(), {}};
  if (texels.width == 0 || texels.height == 0 || texels.width > maxSide || texels.height > maxSide ||
      uint64_t{texels.width} * texels.height > maxTexels) {
    refuse(image, "has {} x {} texels, expected 1 to {} a side and at most {} in all", texels.width,
           texels.height, maxSide, maxTexels);
  }
  texels.rgba.resize(size_t{4} * texels.width * texels.height);
  return texels;
}

Texels decodePng(const ImageFile& image) {
  PngReader reader(image.bytes);
  if (!reader.readHeader()) refuse(image, "corrupt PNG: {}", reader.fault());
  if (!reader.canHoldItsRows()) {
    refuse(image, "corrupt PNG: {} bytes cannot hold {} x {} texels", image.bytes.size(), reader.columns(),
           reader.rows());
  }
  Texels texels = roomFor(image, reader);
  std::vector<png_bytep> rows(texels.height);
  for (size_t j = 0; j < rows.size(); ++j) rows[j] = texels.rgba.data() + j * 4 * texels.width;
  if (!reader.readRgba(rows.data())) refuse(image, "corrupt PNG: {}", reader.fault());
  return texels;
}

Texels decodeJpeg(const ImageFile& image) {
  JpegReader reader(image.bytes);
  if (!reader.readHeader()) refuse(image, "corrupt JPEG: {}", reader.fault());
  if (!reader.isColour()) refuse(image, "is a JPEG of ink (CMYK), expected grey or colours");
  Texels texels = roomFor(image, reader);
  if (!reader.readRgba(texels.rgba.data())) refuse(image, "corrupt JPEG: {}", reader.fault());
  return texels;
}

}  // namespace

std::string notAnImage(std::span<const uint8_t> bytes) {
  if (PngReader::hasSignature(bytes) || JpegReader::hasSignature(bytes)) return "";
  const auto has = [&](size_t at, std::string_view signature) {
    return bytes.size() >= at + signature.size() &&
           std::memcmp(bytes.data() + at, signature.data(), signature.size()) == 0;
  };
  struct Format {
    size_t at;
    std::string_view signature, name;
  };
  for (const Format& format : {Format{0, "\xabKTX 20", "KTX2"},
                               {0, "\xabKTX 11", "KTX"},
                               {8, "WEBP", "WebP"},
                               {4, "ftypavif", "AVIF"},
                               {0, "DDS ", "DDS"},
                               {0, "GIF8", "GIF"},
                               {0, "BM", "BMP"},
                               {0, "II*", "TIFF"},
                               {0, std::string_view("MM\0*", 4), "TIFF"},
                               {0, "8BPS", "PSD"},
                               {0, "sB", "Basis"}})
    if (has(format.at, format.signature)) return fmt::format("is {}, expected PNG or JPEG", format.name);
  return "is neither PNG nor JPEG";
}

Texels decodeImage(const ImageFile& image) {
  if (!image.fault.empty()) throw inputError(image.fault);
  try {
    if (PngReader::hasSignature(image.bytes)) return decodePng(image);
    if (JpegReader::hasSignature(image.bytes)) return decodeJpeg(image);
  } catch (const std::bad_alloc&) {
    refuse(image, "does not fit into memory");
  }
  refuse(image, "{}", notAnImage(image.bytes));
}

}  // namespace skitter
