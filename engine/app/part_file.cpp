#include "part_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "skitter/error.h"

namespace skitter::app {

namespace fs = std::filesystem;

namespace {

// A path as far as it is there.
fs::path existingPartOf(const fs::path& path) {
  std::error_code error;
  fs::path existing = fs::absolute(path);
  while (!fs::exists(existing, error) && existing.has_relative_path()) existing = existing.parent_path();
  return existing;
}

}  // namespace

PartFile::PartFile(fs::path file) : file_(std::move(file)), part_(file_) {
  part_ += ".part";
  stream_ = std::fopen(part_.c_str(), "wb");
  if (!stream_) fail();
}

PartFile::PartFile(PartFile&& other) noexcept
    : file_(std::move(other.file_)),
      part_(std::move(other.part_)),
      stream_(std::exchange(other.stream_, nullptr)) {}

PartFile::~PartFile() {
  if (!stream_) return;
  std::fclose(stream_);
  std::error_code ignored;
  fs::remove(part_, ignored);
}

void PartFile::write(std::span<const std::byte> bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), stream_) != bytes.size()) fail();
}

void PartFile::seekToStart() {
  if (std::fseek(stream_, 0, SEEK_SET) != 0) fail();
}

void PartFile::commit() {
  if (std::fflush(stream_) != 0) fail();
  if (std::rename(part_.c_str(), file_.c_str()) != 0) fail();
  std::fclose(std::exchange(stream_, nullptr));
}

void PartFile::fail() const {
  throw inputError(fmt::format("{}: cannot be written: {}", file_.string(), std::strerror(errno)));
}

void writeText(const fs::path& file, const std::string& text) {
  PartFile out(file);
  out.write(text);
  out.commit();
}

void checkFileTarget(const std::string& option, const fs::path& file) {
  std::error_code error;
  if (file.filename().empty() || fs::is_directory(file, error)) {
    throw inputError(fmt::format("{} {}: is a directory, expected a file", option, file.string()));
  }
  // The finished file takes the name over: a device of that name would be gone.
  if (fs::exists(file, error) && !fs::is_regular_file(file, error)) {
    throw inputError(
        fmt::format("{} {}: is no regular file, which is all that can be written", option, file.string()));
  }
  const fs::path folder = file.parent_path().empty() ? fs::path(".") : file.parent_path();
  if (!fs::is_directory(folder, error)) {
    throw inputError(fmt::format("{} {}: there is no directory {}", option, file.string(), folder.string()));
  }
  if (access(folder.c_str(), W_OK) != 0) {
    throw inputError(fmt::format("{} {}: {} is not writable: {}", option, file.string(), folder.string(),
                                 std::strerror(errno)));
  }
}

void checkRoom(const std::string& option, const fs::path& target, double bytes) {
  const fs::path existing = existingPartOf(target);
  std::error_code error;
  const fs::space_info space = fs::space(existing, error);
  // Some file systems tell nothing.
  if (error || space.capacity == 0 || bytes <= static_cast<double>(space.available)) return;
  throw inputError(fmt::format("{} {}: would take {:.0f} MiB, the disk has {} MiB free", option,
                               target.string(), bytes / (1 << 20), space.available >> 20));
}

void checkFolderTarget(const std::string& option, const fs::path& folder) {
  if (folder.empty()) throw inputError(fmt::format("{} is empty, expected a directory", option));
  const fs::path existing = existingPartOf(folder);
  std::error_code error;
  if (!fs::is_directory(existing, error)) {
    throw inputError(
        fmt::format("{} {}: {} is a file, expected a directory", option, folder.string(), existing.string()));
  }
  if (access(existing.c_str(), W_OK) != 0) {
    throw inputError(fmt::format("{} {}: {} is not writable: {}", option, folder.string(), existing.string(),
                                 std::strerror(errno)));
  }
}

}  // namespace skitter::app
