#include "assets/files/file.h"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>
#include <set>
#include <string_view>
#include <system_error>

#include "skitter/error.h"

namespace skitter {
namespace {

struct Opened {
  std::mutex mutex;
  std::set<std::filesystem::path> files;
};
Opened& opened() {
  static Opened all;
  return all;
}

// A clone holds a pointer in place of a large file that was not fetched: a few lines of text, and these are
// the first words (Git LFS specification, docs/spec.md; the second is the name that it had before).
bool isLfsPointer(std::string_view start) {
  return start.starts_with("version https://git-lfs.github.com/spec/") ||
         start.starts_with("version https://hawser.github.com/spec/");
}

}  // namespace

FileStream::FileStream(const std::filesystem::path& file) : file_(file) {
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
  size_ = std::filesystem::file_size(file, error);
  if (error) throw inputError(fmt::format("{}: cannot be read: {}", name, error.message()));
  if (size_ == 0) throw inputError(fmt::format("{}: is empty", name));
  stream_.open(file, std::ios::binary);
  if (!stream_) throw inputError(fmt::format("{}: cannot be opened for reading", name));
  std::string start(std::min<uintmax_t>(size_, 48), '\0');
  read(start.data(), start.size());
  if (isLfsPointer(start)) throw inputError(fmt::format("{}: is a Git LFS pointer; run git lfs pull", name));
  seek(0);
  const std::lock_guard lock(opened().mutex);
  opened().files.insert(file);
}

void FileStream::read(void* to, size_t bytes) {
  stream_.read(static_cast<char*>(to), static_cast<std::streamsize>(bytes));
  if (static_cast<size_t>(stream_.gcount()) != bytes) {
    throw inputError(
        fmt::format("{}: reading stopped after {} of {} bytes", file_.string(), stream_.gcount(), bytes));
  }
}

std::vector<std::filesystem::path> filesRead() {
  const std::lock_guard lock(opened().mutex);
  return {opened().files.begin(), opened().files.end()};
}

std::vector<uint8_t> readFile(const std::filesystem::path& file) {
  constexpr uintmax_t limit = uintmax_t{1} << 31;
  FileStream stream(file);
  if (stream.size() > limit) {
    throw inputError(
        fmt::format("{}: has {} bytes, expected at most {}", file.string(), stream.size(), limit));
  }
  std::vector<uint8_t> bytes(stream.size());
  stream.read(bytes.data(), bytes.size());
  return bytes;
}

}  // namespace skitter
