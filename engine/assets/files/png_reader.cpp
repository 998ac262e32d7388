#include "assets/files/png_reader.h"

#include <csetjmp>
#include <cstring>
#include <new>

namespace skitter {

PngReader::PngReader(std::span<const uint8_t> bytes) : bytes_(bytes) {
  png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, &PngReader::fail, &PngReader::ignore);
  if (png_) info_ = png_create_info_struct(png_);
  if (!info_) {
    png_destroy_read_struct(&png_, nullptr, nullptr);
    throw std::bad_alloc();
  }
}

bool PngReader::hasSignature(std::span<const uint8_t> bytes) {
  return bytes.size() >= 8 && png_sig_cmp(bytes.data(), 0, 8) == 0;
}

bool PngReader::readHeader() noexcept {
  if (setjmp(png_jmpbuf(png_))) return false;
  png_set_read_fn(png_, this, &PngReader::read);
  png_set_user_limits(png_, 0x7fffffff, 0x7fffffff);  // sizes are judged by the caller, who can name them
  png_read_info(png_, info_);
  return true;
}

bool PngReader::canHoldItsRows() const {
  return png_get_rowbytes(png_, info_) * size_t{rows()} / 1032 <= bytes_.size();
}

void PngReader::readRows(png_bytep* rows) {
  png_set_interlace_handling(png_);
  png_read_update_info(png_, info_);
  png_read_image(png_, rows);
  png_read_end(png_, nullptr);
}

bool PngReader::readGrey(png_bytep* rows) noexcept {
  if (setjmp(png_jmpbuf(png_))) return false;
  png_set_strip_alpha(png_);
  readRows(rows);
  return true;
}

bool PngReader::readRgba(png_bytep* rows) noexcept {
  if (setjmp(png_jmpbuf(png_))) return false;
  png_set_expand(png_);  // palettes, fewer than 8 bits, and a transparent colour
  png_set_strip_16(png_);
  png_set_gray_to_rgb(png_);
  png_set_add_alpha(png_, 255, PNG_FILLER_AFTER);
  readRows(rows);
  return true;
}

void PngReader::fail(png_structp png, png_const_charp message) {
  auto* self = static_cast<PngReader*>(png_get_error_ptr(png));
  std::strncpy(self->fault_, message, sizeof(self->fault_) - 1);
  png_longjmp(png, 1);
}

void PngReader::read(png_structp png, png_bytep to, size_t count) {
  auto* self = static_cast<PngReader*>(png_get_io_ptr(png));
  if (self->bytes_.size() - self->offset_ < count) png_error(png, "the file ends too early");
  std::memcpy(to, self->bytes_.data() + self->offset_, count);
  self->offset_ += count;
}

}  // namespace skitter
