#include <fmt/format.h>

#include "assets/files/file.h"
#include "assets/files/png_reader.h"
#include "assets/heights/height_samples.h"
#include "skitter/error.h"

namespace skitter {

StoredHeights readPngHeights(const std::filesystem::path& file, std::optional<double> voidValue) {
  const std::string name = file.string();
  const std::vector<uint8_t> bytes = readFile(file);
  if (!PngReader::hasSignature(bytes))
    throw inputError(fmt::format("{}: is not a PNG (wrong signature)", name));
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
  if (!reader.canHoldItsRows()) {
    throw inputError(fmt::format("{}: corrupt PNG: {} bytes cannot hold {} x {} samples", name, bytes.size(),
                                 samples.columns, samples.rows));
  }
  std::vector<uint8_t> raw(rowBytes * samples.rows);
  std::vector<png_bytep> rows(samples.rows);
  for (size_t j = 0; j < rows.size(); ++j) rows[j] = raw.data() + j * rowBytes;
  if (!reader.readGrey(rows.data())) {
    throw inputError(fmt::format("{}: corrupt PNG: {}", name, reader.fault()));
  }

  const SampleType type{bits == 16 ? SampleType::Kind::u2 : SampleType::Kind::u1, true};
  checkVoidValue(name, type, voidValue);
  samples.values.resize(size_t{samples.columns} * samples.rows);
  decodeSamples(raw.data(), samples.values.size(), type, voidValue, samples.values.data());
  return samples;
}

}  // namespace skitter
