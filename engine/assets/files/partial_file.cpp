#include "assets/files/partial_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <limits.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <functional>
#include <utility>

#include "skitter/error.h"

namespace skitter {

namespace fs = std::filesystem;

namespace {

constexpr int mostLinks = 40;  // as the kernel has it

Error unwritable(const fs::path& file, const std::string& fault) {
  return inputError(fmt::format("{}: cannot be written: {}", file.string(), fault));
}

// Whether there is a part that a program left which no longer runs: it would hold the lock, which is given
// back however a program ends. Throws where the part is another program's, or nobody's.
bool isStale(const fs::path& file, const fs::path& part) {
  const int there = open(part.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (there < 0 && errno == ENOENT) return false;
  if (there < 0 && errno != ELOOP) throw unwritable(file, writeFault(errno));
  std::error_code error;
  const bool regular = there >= 0 && fs::is_regular_file(part, error);
  const bool locked = regular && flock(there, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  if (there >= 0) close(there);
  if (locked) throw unwritable(file, "another program writes it at this moment");
  if (!regular) throw unwritable(file, fmt::format("{} is in the way; remove it", part.string()));
  return true;
}

int make(const fs::path& file, const fs::path& part) {
  const int made = open(part.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (made < 0) throw unwritable(file, writeFault(errno));
  return made;
}

}  // namespace

fs::path followed(const fs::path& file) {
  fs::path at = file;
  std::error_code error;
  for (int links = 0; fs::is_symlink(at, error); ++links) {
    if (links == mostLinks) throw unwritable(file, std::strerror(ELOOP));
    at = at.parent_path() / fs::read_symlink(at);
  }
  return at;
}

fs::path partOf(const fs::path& file) {
  const std::string name = file.filename().string() + ".part";
  if (name.size() <= NAME_MAX) return file.parent_path() / name;
  return file.parent_path() / fmt::format("skitter-{:016x}.part", std::hash<std::string>()(name));
}

void checkPart(const fs::path& file) {
  const fs::path part = partOf(followed(file));
  if (isStale(file, part)) return;
  close(make(file, part));
  std::error_code ignored;
  fs::remove(part, ignored);
}

std::string writeFault(int error) {
  std::string fault = std::strerror(error);
  if (error == ENOSPC || error == EDQUOT) fault += "; free some room";
  if (error == EFBIG) fault += "; raise the limit that `ulimit -f` shows";
  return fault;
}

PartialFile::PartialFile(fs::path file)
    : file_(std::move(file)), target_(followed(file_)), part_(partOf(target_)) {
  std::error_code ignored;
  if (isStale(file_, part_)) fs::remove(part_, ignored);
  lock_ = make(file_, part_);
  flock(lock_, LOCK_EX | LOCK_NB);  // file systems without locks go without
}

PartialFile::PartialFile(PartialFile&& other) noexcept
    : file_(std::move(other.file_)),
      target_(std::move(other.target_)),
      part_(std::move(other.part_)),
      lock_(std::exchange(other.lock_, -1)),
      stream_(std::exchange(other.stream_, nullptr)) {}

PartialFile::~PartialFile() {
  if (stream_) std::fclose(stream_);
  if (lock_ < 0) return;
  std::error_code ignored;
  fs::remove(part_, ignored);
  close(lock_);
}

std::FILE* PartialFile::stream() {
  if (!stream_) stream_ = std::fopen(part_.c_str(), "wb");
  if (!stream_) throw unwritable(file_, writeFault(errno));
  return stream_;
}

void PartialFile::write(std::span<const std::byte> bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), stream()) != bytes.size())
    throw unwritable(file_, writeFault(errno));
}

void PartialFile::seekToStart() {
  if (std::fseek(stream(), 0, SEEK_SET) != 0) throw unwritable(file_, writeFault(errno));
}

void PartialFile::sync() {
  if (std::fflush(stream()) != 0 || fsync(fileno(stream())) != 0) throw unwritable(file_, writeFault(errno));
}

void PartialFile::keep() {
  // A full disk may show only here.
  if (stream_ && std::fclose(std::exchange(stream_, nullptr)) != 0)
    throw unwritable(file_, writeFault(errno));
  std::error_code error;
  fs::rename(part_, target_, error);
  if (error) throw unwritable(file_, error.message());
  close(std::exchange(lock_, -1));
}

void writeText(const fs::path& file, const std::string& text) {
  PartialFile out(file);
  out.write(text);
  out.keep();
}

}  // namespace skitter
