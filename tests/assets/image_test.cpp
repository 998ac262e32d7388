// Images of models: what is decoded, what is refused, and their levels, held against doubles.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>

// clang-format off: it uses FILE and size_t of <cstdio>
#include <jpeglib.h>
// clang-format on

#include "assets/materials/mip_levels.h"
#include "base/srgb.h"
#include "files.h"
#include "support/image_bytes.h"
#include "support/srgb.h"

namespace skitter {
namespace {

using test::decodedSrgb;
using test::encodedSrgb;
using test::pngFile;
using test::texelsOf;

Texels gradient(uint32_t width, uint32_t height) {
  return texelsOf(width, height, [](uint32_t x, uint32_t y) {
    return glm::ivec4(8 * x, 255 - 8 * y, 4 * (x + y), 255 - 3 * x);
  });
}

// With libpng's full interface: any colour type and depth, `rows` as the file has them.
struct MadePng {
  uint32_t width = 1, height = 1;
  int bits = 8, colour = PNG_COLOR_TYPE_RGB, interlace = PNG_INTERLACE_NONE;
  std::vector<std::vector<uint8_t>> rows = {};
  std::vector<png_color> palette = {};
  std::vector<uint8_t> palettesAlpha = {};
  double gamma = 0;

  std::vector<uint8_t> bytes() {
    std::vector<uint8_t> written;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_set_write_fn(
        png, &written,
        [](png_structp p, png_bytep from, size_t count) {
          auto* to = static_cast<std::vector<uint8_t>*>(png_get_io_ptr(p));
          to->insert(to->end(), from, from + count);
        },
        nullptr);
    png_set_IHDR(png, info, width, height, bits, colour, interlace, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    if (!palette.empty()) png_set_PLTE(png, info, palette.data(), int(palette.size()));
    if (!palettesAlpha.empty())
      png_set_tRNS(png, info, palettesAlpha.data(), int(palettesAlpha.size()), nullptr);
    if (gamma > 0) png_set_gAMA(png, info, gamma);
    png_write_info(png, info);
    std::vector<png_bytep> pointers;
    for (std::vector<uint8_t>& row : rows) pointers.push_back(row.data());
    png_write_image(png, pointers.data());
    png_write_end(png, nullptr);
    png_destroy_write_struct(&png, &info);
    return written;
  }
};

// Three colours at full resolution of each, or one.
std::vector<uint8_t> jpegBytes(uint32_t width, uint32_t height, J_COLOR_SPACE space, int components,
                               std::vector<uint8_t> samples) {
  jpeg_compress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&jpeg, &bytes, &size);
  jpeg.image_width = width;
  jpeg.image_height = height;
  jpeg.input_components = components;
  jpeg.in_color_space = space;
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, 100, TRUE);
  for (int k = 0; k < jpeg.num_components; ++k)
    jpeg.comp_info[k].h_samp_factor = jpeg.comp_info[k].v_samp_factor = 1;
  jpeg_start_compress(&jpeg, TRUE);
  for (uint32_t y = 0; y < height; ++y) {
    JSAMPROW row = samples.data() + size_t{y} * width * static_cast<size_t>(components);
    jpeg_write_scanlines(&jpeg, &row, 1);
  }
  jpeg_finish_compress(&jpeg);
  std::vector<uint8_t> written(bytes, bytes + size);
  jpeg_destroy_compress(&jpeg);
  std::free(bytes);
  return written;
}

ImageFile fileOf(std::vector<uint8_t> bytes) {
  return {.name = "made", .bytes = std::move(bytes), .fault = {}};
}

TEST(Images, PngIsReadToTheByte) {
  const Texels made = gradient(13, 7);
  EXPECT_EQ(decodeImage(pngFile(made)), made);
}

TEST(Images, EveryKindOfPngBecomesFourBytes) {
  const auto decoded = [](MadePng png) { return decodeImage(fileOf(png.bytes())).rgba; };
  using Rgba = std::vector<uint8_t>;
  EXPECT_EQ(decoded({.width = 2, .colour = PNG_COLOR_TYPE_GRAY, .rows = {{7, 200}}}),
            (Rgba{7, 7, 7, 255, 200, 200, 200, 255}));
  EXPECT_EQ(decoded({.width = 4, .bits = 2, .colour = PNG_COLOR_TYPE_GRAY, .rows = {{0b00011011}}}),
            (Rgba{0, 0, 0, 255, 85, 85, 85, 255, 170, 170, 170, 255, 255, 255, 255, 255}));
  EXPECT_EQ(decoded({.width = 1, .colour = PNG_COLOR_TYPE_GRAY_ALPHA, .rows = {{9, 33}}}),
            (Rgba{9, 9, 9, 33}));
  EXPECT_EQ(decoded({.bits = 16, .rows = {{0x12, 0xff, 0x80, 0x00, 0x01, 0x80}}}),
            (Rgba{0x12, 0x80, 0x01, 255}));
  EXPECT_EQ(decoded({.width = 2,
                     .colour = PNG_COLOR_TYPE_PALETTE,
                     .rows = {{1, 0}},
                     .palette = {{1, 2, 3}, {40, 50, 60}},
                     .palettesAlpha = {255, 128}}),
            (Rgba{40, 50, 60, 128, 1, 2, 3, 255}));
  // Colour spaces are ignored (glTF 2.0, section 3.8.3).
  EXPECT_EQ(decoded({.rows = {{10, 100, 200}}, .gamma = 1.0}), (Rgba{10, 100, 200, 255}));
  EXPECT_EQ(decoded({.width = 2,
                     .height = 2,
                     .colour = PNG_COLOR_TYPE_GRAY,
                     .interlace = PNG_INTERLACE_ADAM7,
                     .rows = {{1, 2}, {3, 4}}}),
            (Rgba{1, 1, 1, 255, 2, 2, 2, 255, 3, 3, 3, 255, 4, 4, 4, 255}));
}

TEST(Images, JpegIsReadAsItsColours) {
  std::vector<uint8_t> samples;
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x)
      samples.insert(samples.end(), {uint8_t(8 * x), uint8_t(8 * y), uint8_t(100 + 2 * x)});
  const Texels found = decodeImage(fileOf(jpegBytes(16, 16, JCS_RGB, 3, samples)));
  ASSERT_EQ(found.width, 16u);
  ASSERT_EQ(found.rgba.size(), 1024u);
  // At full quality coefficients are rounded to whole numbers, which is 0.29 root mean square, and as much in
  // the samples, whose transform is orthonormal. Four times that and a rounding are 1.7 of Y, Cb and Cr each;
  // red, green and blue are Y and at most 1.77 of the others, rounded again.
  for (size_t i = 0; i < 256; ++i) {
    for (size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(found.rgba[4 * i + k], samples[3 * i + k], 6) << "texel " << i << ", " << k;
    EXPECT_EQ(found.rgba[4 * i + 3], 255);
  }
  const Texels grey = decodeImage(fileOf(jpegBytes(8, 8, JCS_GRAYSCALE, 1, std::vector<uint8_t>(64, 77))));
  for (size_t i = 0; i < 256; ++i) EXPECT_NEAR(grey.rgba[i], i % 4 == 3 ? 255 : 77, 1);
}

TEST(Images, BrokenOnesAreRefusedInOneLine) {
  const std::vector<uint8_t> png = pngFile(gradient(40, 40)).bytes;
  const std::vector<uint8_t> jpeg = jpegBytes(64, 64, JCS_RGB, 3, std::vector<uint8_t>(64 * 64 * 3, 90));
  const auto cut = [](std::vector<uint8_t> bytes, size_t size) {
    bytes.resize(size);
    return bytes;
  };
  std::vector<uint8_t> flipped = png, huge = png;
  flipped[png.size() / 2] ^= 0x55;
  huge[17] = huge[21] = 1;  // 65,576 texels a side; libpng looks at the checksum first
  const std::pair<std::vector<uint8_t>, const char*> cases[] = {
      {{'n', 'o'}, "made: is neither PNG nor JPEG"},
      {cut(png, 8), "made: corrupt PNG: the file ends too early"},
      {cut(png, png.size() / 2), "made: corrupt PNG: "},
      {flipped, "made: corrupt PNG: "},
      {huge, "made: corrupt PNG: "},
      {cut(jpeg, 3), "made: corrupt JPEG: "},
      {cut(jpeg, jpeg.size() - 20), "made: corrupt JPEG: "},
      {jpegBytes(8, 8, JCS_CMYK, 4, std::vector<uint8_t>(256, 9)), "made: is a JPEG of ink (CMYK)"},
  };
  for (const auto& [bytes, expected] : cases) {
    const std::string what = test::inputFault([&, from = bytes] { decodeImage(fileOf(from)); });
    EXPECT_EQ(what.rfind(expected, 0), 0u) << what << "\nexpected: " << expected;
  }
  const ImageFile none{.name = "made", .bytes = {}, .fault = "made: no such file"};
  EXPECT_EQ(test::inputFault([&] { decodeImage(none); }), "made: no such file");
}

TEST(Images, AreLimitedInSize) {
  MadePng wide{.width = 16385, .bits = 1, .colour = PNG_COLOR_TYPE_GRAY};
  wide.rows = {std::vector<uint8_t>(2049)};
  EXPECT_EQ(test::inputFault([&] { decodeImage(fileOf(wide.bytes())); }),
            "made: has 16385 x 1 texels, expected 1 to 16384 a side and at most 67108864 in all");
}

// Texel i of n covers [i N / n, (i + 1) N / n] of N.
double coveredShare(uint32_t i, uint32_t n, uint32_t texel, uint32_t size) {
  const double from = double(i) * size / n, to = double(i + 1) * size / n;
  return std::max(0.0, std::min(to, texel + 1.0) - std::max(from, double(texel))) / (to - from);
}

TEST(MipLevels, AreMeansByAreaOfTheLevelBefore) {
  for (const auto& [width, height] : {std::pair(16u, 8u), std::pair(13u, 7u), std::pair(1u, 6u)}) {
    const Texels image = texelsOf(width, height, [](uint32_t x, uint32_t y) {
      const uint32_t h = (x * 2654435761u ^ y * 2246822519u) >> 7;
      return glm::ivec4(h & 255, (h >> 8) & 255, (x + y) % 2 * 255, h & 127);
    });
    for (const TexelKind kind : {TexelKind::numbers, TexelKind::srgb}) {
      const std::vector<Texels> levels = mipLevels(image, kind);
      EXPECT_EQ(levels[0], image);
      EXPECT_EQ(levels.back().rgba.size(), 4u);
      for (size_t level = 1; level < levels.size(); ++level) {
        const Texels &from = levels[level - 1], &to = levels[level];
        ASSERT_EQ(to.width, std::max(1u, from.width / 2));
        ASSERT_EQ(to.height, std::max(1u, from.height / 2));
        for (uint32_t y = 0; y < to.height; ++y)
          for (uint32_t x = 0; x < to.width; ++x)
            for (uint32_t k = 0; k < 4; ++k) {
              const bool light = kind == TexelKind::srgb && k < 3;
              double sum = 0;
              for (uint32_t v = 0; v < from.height; ++v)
                for (uint32_t u = 0; u < from.width; ++u) {
                  const double code = from.rgba[4 * (v * from.width + u) + k];
                  sum += coveredShare(x, to.width, u, from.width) *
                         coveredShare(y, to.height, v, from.height) * (light ? decodedSrgb(code) : code);
                }
              // Rounded to the nearest byte. Single precision may round the other way at half of one.
              EXPECT_NEAR(to.rgba[4 * (y * to.width + x) + k], light ? encodedSrgb(sum) : sum, 0.502)
                  << width << " x " << height << ", level " << level << ": " << x << ", " << y << ", " << k;
            }
      }
    }
  }
}

// Half black, half white is half the light, which is no grey of 128.
TEST(MipLevels, OfColoursKeepTheLight) {
  const Texels board = texelsOf(4, 4, [](uint32_t x, uint32_t y) {
    const int value = (x + y) % 2 == 0 ? 255 : 0;
    return glm::ivec4(value, value, value, value);
  });
  EXPECT_EQ(mipLevels(board, TexelKind::srgb)[1].rgba[0], 188);
  EXPECT_EQ(mipLevels(board, TexelKind::srgb)[1].rgba[3], 128);
  EXPECT_EQ(mipLevels(board, TexelKind::numbers)[1].rgba[0], 128);
}

TEST(Srgb, BytesSurviveTheWayThere) {
  for (int code = 0; code < 256; ++code) {
    EXPECT_NEAR(base::linearOfByte(uint8_t(code)), decodedSrgb(code), 1e-6);
    EXPECT_EQ(base::byteOfLinear(base::linearOfByte(uint8_t(code))), code);
  }
  EXPECT_EQ(base::byteOfLinear(-1), 0);
  EXPECT_EQ(base::byteOfLinear(2), 255);
}

}  // namespace
}  // namespace skitter
