#include <fmt/format.h>
#include <png.h>

#include <csetjmp>
#include <cstring>
#include <new>

#include "assets/files/file.h"
#include "assets/heights/height_samples.h"
#include "skitter/error.h"

namespace skitter {
namespace {

// A libpng reader over a file in memory. libpng reports a fault by longjmp, which skips destructors: so the
// two methods that call it hold trivial locals only, and everything they fill is owned here.
class PngReader {
 public:
  explicit PngReader(const std::vector<uint8_t>& bytes) : bytes_(bytes) {
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, &PngReader::fail, &PngReader::ignore);
    if (png_) info_ = png_create_info_struct(png_);
    if (!info_) {
      png_destroy_read_struct(&png_, nullptr, nullptr);
      throw std::bad_alloc();
    }
  }
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  bool readHeader() noexcept {
    if (setjmp(png_jmpbuf(png_))) return false;
    png_set_read_fn(png_, this, &PngReader::read);
    png_set_user_limits(png_, 0x7fffffff, 0x7fffffff);  // sizes are judged by the caller, who can name them
    png_read_info(png_, info_);
    return true;
  }

  uint32_t columns() const { return png_get_image_width(png_, info_); }
  uint32_t rows() const { return png_get_image_height(png_, info_); }
  int bits() const { return png_get_bit_depth(png_, info_); }
  int colourType() const { return png_get_color_type(png_, info_); }

  // `rows` points at each row's columns * bits / 8 bytes.
  bool readRows(png_bytep* rows) noexcept {
    if (setjmp(png_jmpbuf(png_))) return false;
    png_set_strip_alpha(png_);
    png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    png_read_image(png_, rows);
    png_read_end(png_, nullptr);
    return true;
  }

  const char* fault() const { return fault_; }

 private:
  static void fail(png_structp png, png_const_charp message) {
    auto* self = static_cast<PngReader*>(png_get_error_ptr(png));
    std::strncpy(self->fault_, message, sizeof(self->fault_) - 1);
    png_longjmp(png, 1);
  }
  static void ignore(png_structp, png_const_charp) {}
  static void read(png_structp png, png_bytep to, size_t count) {
    auto* self = static_cast<PngReader*>(png_get_io_ptr(png));
    if (self->bytes_.size() - self->offset_ < count) png_error(png, "the file ends too early");
    std::memcpy(to, self->bytes_.data() + self->offset_, count);
    self->offset_ += count;
  }

  const std::vector<uint8_t>& bytes_;
  size_t offset_ = 0;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
  char fault_[128] = {};
};

}  // namespace

StoredHeights readPngHeights(const std::filesystem::path& file, std::optional<double> voidValue) {
  const std::string name = file.string();
  const std::vector<uint8_t> bytes = readFile(file);
  if (bytes.size() < 8 || png_sig_cmp(bytes.data(), 0, 8) != 0) {
    throw inputError(fmt::format("{}: is not a PNG (wrong signature)", name));
  }
  PngReader reader(bytes);
  if (!reader.readHeader()) throw inputError(fmt::format("{}: corrupt PNG: {}", name, reader.fault()));

  const int colour = reader.colourType(), bits = reader.bits();
  if (colour != PNG_COLOR_TYPE_GRAY && colour != PNG_COLOR_TYPE_GRAY_ALPHA) {
    throw inputError(fmt::format("{}: is a {} PNG, expected grey", name,
                                 colour == PNG_COLOR_TYPE_PALETTE ? "palette colour" : "colour"));
  }
  if (bits != 8 && bits != 16)
    throw inputError(fmt::format("{}: has {}-bit grey, expected 8 or 16", name, bits));

  StoredHeights samples{reader.columns(), reader.rows(), {}, true, {}, {}};
  checkSampleCounts(name, samples.columns, samples.rows);
  const size_t rowBytes = size_t{samples.columns} * static_cast<size_t>(bits / 8);
  // Deflate expands at most 1032 times, so a small file that declares a huge image is cut off or a lie.
  if (rowBytes * samples.rows / 1032 > bytes.size()) {
    throw inputError(fmt::format("{}: corrupt PNG: {} bytes cannot hold {} x {} samples", name, bytes.size(),
                                 samples.columns, samples.rows));
  }
  std::vector<uint8_t> raw(rowBytes * samples.rows);
  std::vector<png_bytep> rows(samples.rows);
  for (size_t j = 0; j < rows.size(); ++j) rows[j] = raw.data() + j * rowBytes;
  if (!reader.readRows(rows.data())) {
    throw inputError(fmt::format("{}: corrupt PNG: {}", name, reader.fault()));
  }

  const SampleType type{bits == 16 ? SampleType::Kind::u2 : SampleType::Kind::u1, true};
  checkVoidValue(name, type, voidValue);
  samples.values.resize(size_t{samples.columns} * samples.rows);
  decodeSamples(raw.data(), samples.values.size(), type, voidValue, samples.values.data());
  return samples;
}

}  // namespace skitter
