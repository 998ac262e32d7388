#include "assets/files/jpeg_reader.h"

namespace skitter {

JpegReader::JpegReader(std::span<const uint8_t> bytes) : bytes_(bytes) {
  jpeg_.err = jpeg_std_error(&errors_);
  jpeg_.client_data = this;
  errors_.error_exit = &JpegReader::fail;
  errors_.emit_message = &JpegReader::warn;
}

bool JpegReader::hasSignature(std::span<const uint8_t> bytes) {
  return bytes.size() >= 3 && bytes[0] == 0xff && bytes[1] == 0xd8 && bytes[2] == 0xff;
}

bool JpegReader::readHeader() noexcept {
  if (setjmp(back_)) return false;
  jpeg_create_decompress(&jpeg_);
  jpeg_mem_src(&jpeg_, bytes_.data(), static_cast<unsigned long>(bytes_.size()));
  jpeg_read_header(&jpeg_, TRUE);
  return true;
}

bool JpegReader::readRgba(uint8_t* to) noexcept {
  if (setjmp(back_)) return false;
  jpeg_.out_color_space = JCS_EXT_RGBA;
  jpeg_start_decompress(&jpeg_);
  while (jpeg_.output_scanline < jpeg_.output_height) {
    JSAMPROW row = to + size_t{4} * jpeg_.output_width * jpeg_.output_scanline;
    jpeg_read_scanlines(&jpeg_, &row, 1);
  }
  jpeg_finish_decompress(&jpeg_);
  return true;
}

void JpegReader::fail(j_common_ptr jpeg) {
  auto* self = static_cast<JpegReader*>(jpeg->client_data);
  self->errors_.format_message(jpeg, self->fault_);
  std::longjmp(self->back_, 1);
}

// Levels of 0 and more are news.
void JpegReader::warn(j_common_ptr jpeg, int level) {
  if (level < 0) fail(jpeg);
}

}  // namespace skitter
