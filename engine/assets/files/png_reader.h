#pragma once

#include <png.h>

#include <cstdint>
#include <span>

namespace skitter {

// A libpng reader over a file in memory. libpng reports a fault by longjmp, which skips destructors: so the
// methods that call it hold trivial locals only, and everything they fill is owned by the caller.
class PngReader {
 public:
  // Throws std::bad_alloc. The bytes outlive the reader.
  explicit PngReader(std::span<const uint8_t> bytes);
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  static bool hasSignature(std::span<const uint8_t> bytes);

  bool readHeader() noexcept;
  uint32_t columns() const { return png_get_image_width(png_, info_); }
  uint32_t rows() const { return png_get_image_height(png_, info_); }
  int bits() const { return png_get_bit_depth(png_, info_); }
  int colourType() const { return png_get_color_type(png_, info_); }
  // Deflate expands at most 1032 times, so a small file that declares a huge image is cut off or a lie.
  bool canHoldItsRows() const;

  // The numbers as they are, without alpha: `rows` points at each row's columns * bits / 8 bytes of grey.
  bool readGrey(png_bytep* rows) noexcept;
  // Whatever the file holds as RGBA8: `rows` points at each row's 4 * columns bytes.
  bool readRgba(png_bytep* rows) noexcept;

  const char* fault() const { return fault_; }  // after one of the above has returned false

 private:
  static void fail(png_structp png, png_const_charp message);
  static void ignore(png_structp, png_const_charp) {}
  static void read(png_structp png, png_bytep to, size_t count);
  void readRows(png_bytep* rows);

  std::span<const uint8_t> bytes_;
  size_t offset_ = 0;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
  char fault_[128] = {};
};

}  // namespace skitter
