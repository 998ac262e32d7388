#pragma once

#include <csetjmp>
#include <cstdint>
#include <cstdio>
#include <span>

// clang-format off: it uses FILE and size_t of <cstdio>
#include <jpeglib.h>
// clang-format on

namespace skitter {

// A libjpeg reader over a file in memory. As libpng, libjpeg reports a fault by longjmp (png_reader.h).
class JpegReader {
 public:
  // The bytes outlive the reader.
  explicit JpegReader(std::span<const uint8_t> bytes);
  ~JpegReader() { jpeg_destroy_decompress(&jpeg_); }
  JpegReader(const JpegReader&) = delete;
  JpegReader& operator=(const JpegReader&) = delete;

  static bool hasSignature(std::span<const uint8_t> bytes);

  bool readHeader() noexcept;
  uint32_t columns() const { return jpeg_.image_width; }
  uint32_t rows() const { return jpeg_.image_height; }
  // Grey, or three colours. Four are ink, which takes a profile to become light.
  bool isColour() const { return jpeg_.num_components == 1 || jpeg_.num_components == 3; }

  // RGBA8, `rows` * 4 * `columns` bytes. What libjpeg would pass over with a warning is a fault.
  bool readRgba(uint8_t* to) noexcept;

  const char* fault() const { return fault_; }  // after one of the above has returned false

 private:
  static void fail(j_common_ptr jpeg);
  static void warn(j_common_ptr jpeg, int level);

  jpeg_error_mgr errors_{};
  jpeg_decompress_struct jpeg_{};
  std::span<const uint8_t> bytes_;
  std::jmp_buf back_;
  char fault_[JMSG_LENGTH_MAX] = {};
};

}  // namespace skitter
