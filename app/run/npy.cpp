#include "app/run/npy.h"

#include <fmt/format.h>

#include <bit>

namespace skitter::app {
namespace {

constexpr size_t headerBytes =
    192;  // enough for five axes of 20 digits; a multiple of 64, as the format asks

}  // namespace

NpyWriter::NpyWriter(const std::filesystem::path& file, std::string type, std::vector<uint64_t> shape)
    : file_(file), type_(std::move(type)), shape_(std::move(shape)) {
  static_assert(std::endian::native == std::endian::little);
  file_.write(header(0));
}

void NpyWriter::finish(uint64_t entries) {
  file_.seekToStart();
  file_.write(header(entries));
  file_.keep();
}

std::string NpyWriter::header(uint64_t entries) const {
  std::string shape = fmt::format("{},", entries);
  for (uint64_t length : shape_) shape += fmt::format(" {},", length);
  std::string text("\x93NUMPY\x01\x00", 8);
  const size_t dictionaryBytes = headerBytes - text.size() - 2;
  text += static_cast<char>(dictionaryBytes & 0xff);
  text += static_cast<char>(dictionaryBytes >> 8);
  text += fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}), }}", type_, shape);
  text.resize(headerBytes - 1, ' ');
  return text + '\n';
}

}  // namespace skitter::app
