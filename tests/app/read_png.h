#pragma once

#include <gtest/gtest.h>
#include <png.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace skitter::test {

// A picture that a test reads back.
struct Png {
  png_image image{};
  std::vector<uint8_t> rgb;

  explicit Png(const std::string& file) {
    image.version = PNG_IMAGE_VERSION;
    EXPECT_TRUE(png_image_begin_read_from_file(&image, file.c_str())) << file;
    image.format = PNG_FORMAT_RGB;
    rgb.resize(PNG_IMAGE_SIZE(image));
    EXPECT_TRUE(png_image_finish_read(&image, nullptr, rgb.data(), 0, nullptr)) << file;
  }
  std::array<int, 3> at(size_t x, size_t y) const {
    const uint8_t* pixel = &rgb[3 * (y * image.width + x)];
    return {pixel[0], pixel[1], pixel[2]};
  }
};

}  // namespace skitter::test
