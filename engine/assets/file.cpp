#include "file.h"

#include <fmt/format.h>

#include <fstream>
#include <system_error>

#include "skitter/error.h"

namespace skitter {

std::vector<uint8_t> readFile(const std::filesystem::path& file) {
  constexpr uintmax_t limit = uintmax_t{1} << 31;
  const std::string name = file.string();
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) throw inputError(fmt::format("{}: no such file", name));
  if (std::filesystem::is_directory(status)) {
    throw inputError(fmt::format("{}: is a directory, expected a file", name));
  }
  if (!std::filesystem::is_regular_file(status)) {
    throw inputError(fmt::format("{}: is not a regular file", name));
  }
  const uintmax_t size = std::filesystem::file_size(file, error);
  if (error) throw inputError(fmt::format("{}: cannot be read: {}", name, error.message()));
  if (size == 0) throw inputError(fmt::format("{}: is empty", name));
  if (size > limit) throw inputError(fmt::format("{}: has {} bytes, expected at most {}", name, size, limit));
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw inputError(fmt::format("{}: cannot be opened for reading", name));
  std::vector<uint8_t> bytes(size);
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  if (static_cast<uintmax_t>(stream.gcount()) != size) {
    throw inputError(fmt::format("{}: reading stopped after {} of {} bytes", name, stream.gcount(), size));
  }
  return bytes;
}

}  // namespace skitter
