#include <fmt/format.h>
#include <png.h>

#include <csetjmp>
#include <cstring>
#include <new>

#include "file.h"
#include "heightfield_limits.h"
#include "json.h"
#include "skitter/error.h"
#include "skitter/heightfield.h"

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

struct Samples {
  uint32_t columns = 0, rows = 0;
  std::vector<float> codes;  // 0 to 1
};

Samples readSamples(const std::filesystem::path& file) {
  const std::string name = file.string();
  const std::vector<uint8_t> bytes = readFile(file);
  if (bytes.size() < 8 || png_sig_cmp(bytes.data(), 0, 8) != 0) {
    throw inputError(fmt::format("{}: is not a PNG (wrong signature)", name));
  }
  PngReader reader(bytes);
  if (!reader.readHeader()) throw inputError(fmt::format("{}: corrupt PNG: {}", name, reader.fault()));

  const int type = reader.colourType(), bits = reader.bits();
  if (type != PNG_COLOR_TYPE_GRAY && type != PNG_COLOR_TYPE_GRAY_ALPHA) {
    throw inputError(fmt::format("{}: is a {} PNG, expected grey", name,
                                 type == PNG_COLOR_TYPE_PALETTE ? "palette colour" : "colour"));
  }
  if (bits != 8 && bits != 16)
    throw inputError(fmt::format("{}: has {}-bit grey, expected 8 or 16", name, bits));

  Samples samples{reader.columns(), reader.rows(), {}};
  if (!isWithin(samples.columns, minSamples, maxSamples) || !isWithin(samples.rows, minSamples, maxSamples)) {
    throw inputError(fmt::format("{}: is {} x {} samples, expected {} to {} a side", name, samples.columns,
                                 samples.rows, minSamples, maxSamples));
  }
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

  samples.codes.resize(size_t{samples.columns} * samples.rows);
  for (size_t k = 0; k < samples.codes.size(); ++k) {
    samples.codes[k] = bits == 16 ? static_cast<float>(raw[2 * k] << 8 | raw[2 * k + 1]) / 65535.0f
                                  : static_cast<float>(raw[k]) / 255.0f;
  }
  return samples;
}

// "jacksboro" of "jacksboro_403x344"; the stem itself where no size trails.
std::string withoutSize(const std::string& stem) {
  constexpr const char* digits = "0123456789";
  const size_t rowsAt = stem.find_last_not_of(digits);
  if (rowsAt == std::string::npos || rowsAt + 1 == stem.size() || stem[rowsAt] != 'x') return stem;
  const size_t columnsAt = rowsAt == 0 ? std::string::npos : stem.find_last_not_of(digits, rowsAt - 1);
  if (columnsAt == std::string::npos || columnsAt + 1 == rowsAt || stem[columnsAt] != '_') return stem;
  return columnsAt == 0 ? stem : stem.substr(0, columnsAt);
}

void readSidecar(const std::filesystem::path& image, const Samples& samples, HeightfieldUnits& units) {
  const std::string stem = image.stem().string();
  std::error_code ignored;
  std::filesystem::path sidecar;
  for (const std::string& candidate : {stem, withoutSize(stem)}) {
    sidecar = image.parent_path() / (candidate + ".json");
    if (std::filesystem::exists(sidecar, ignored)) break;
    sidecar.clear();
  }
  if (sidecar.empty()) return;

  const std::vector<uint8_t> bytes = readFile(sidecar);
  const nlohmann::json json =
      parseJson({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, sidecar.string());
  if (!json.is_object()) {
    throw inputError(fmt::format("{}: is {}, expected an object", sidecar.string(), describeJson(json)));
  }
  const auto number = [&](const char* key, double& value) {
    const auto found = json.find(key);
    if (found == json.end()) return false;
    if (!found->is_number()) {
      throw inputError(
          fmt::format("{}: {} is {}, expected a number", sidecar.string(), key, describeJson(*found)));
    }
    value = found->get<double>();
    return true;
  };
  const auto take = [&](const char* key, std::optional<float>& unit) {
    double value = 0;
    if (number(key, value) && !unit) unit = static_cast<float>(value);
  };
  take("spacing_x_m", units.spacingX);
  take("spacing_y_m", units.spacingZ);
  take("min_m", units.minHeight);
  take("max_m", units.maxHeight);
  double width = samples.columns, height = samples.rows;
  number("width", width);
  number("height", height);
  if (width != samples.columns || height != samples.rows) {
    throw inputError(fmt::format("{}: describes {} x {} samples, but {} has {} x {}", sidecar.string(), width,
                                 height, image.filename().string(), samples.columns, samples.rows));
  }
}

void checkUnit(const std::string& name, const char* unit, float value, float least, float most) {
  if (!isWithin(value, least, most)) {
    throw inputError(fmt::format("{}: {} is {}, expected {} to {}", name, unit, value, least, most));
  }
}

Heightfield load(const std::filesystem::path& file, HeightfieldUnits units) {
  const std::string name = file.string();
  Samples samples = readSamples(file);
  readSidecar(file, samples, units);

  const float scale = units.scale.value_or(1.0f);
  const float spacingX = units.spacingX.value_or(0.5f), spacingZ = units.spacingZ.value_or(0.5f);
  const float low = units.minHeight.value_or(0.0f), high = units.maxHeight.value_or(10.0f);
  checkUnit(name, "scale", scale, minScale, maxScale);
  checkUnit(name, "spacing x", spacingX, minSpacing, maxSpacing);
  checkUnit(name, "spacing z", spacingZ, minSpacing, maxSpacing);
  checkUnit(name, "minimum height", low, -maxHeightMagnitude, maxHeightMagnitude);
  checkUnit(name, "maximum height", high, -maxHeightMagnitude, maxHeightMagnitude);
  if (low > high) {
    throw inputError(fmt::format("{}: minimum height {} is above maximum height {}", name, low, high));
  }
  checkUnit(name, "scaled spacing x", spacingX * scale, minSpacing, maxSpacing);
  checkUnit(name, "scaled spacing z", spacingZ * scale, minSpacing, maxSpacing);
  checkUnit(name, "scaled height range", (high - low) * scale, 0, maxHeightMagnitude);

  Heightfield field;
  field.name = file.stem().string();
  field.columns = samples.columns;
  field.rows = samples.rows;
  field.spacingX = spacingX * scale;
  field.spacingZ = spacingZ * scale;
  field.heights = std::move(samples.codes);
  // Without `low`, which the centring would take away again at a cost in precision.
  for (float& h : field.heights) h *= (high - low) * scale;
  centreHeights(field.heights);
  return field;
}

}  // namespace

Heightfield loadHeightfield(const std::filesystem::path& file, const HeightfieldUnits& units) {
  try {
    return load(file, units);
  } catch (const std::bad_alloc&) {
    throw inputError(fmt::format("{}: does not fit into memory", file.string()));
  }
}

}  // namespace skitter
