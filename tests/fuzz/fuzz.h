#pragma once

#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "skitter/error.h"

namespace skitter::fuzz {

inline void expect(bool holds, const char* what, const char* seen = "") {
  if (holds) return;
  std::fprintf(stderr, "fuzz: %s: %s\n", what, seen);
  std::abort();
}

// Reads, where only an Error of kind input may come of it, in one line that begins with `name`.
template <typename Read>
void refuseOrRead(const std::string& name, const Read& read) {
  try {
    read();
  } catch (const Error& error) {
    const std::string message = error.what();
    expect(error.kind() == Error::Kind::input, "an error of another kind", error.what());
    expect(message.rfind(name, 0) == 0, "a message that does not name the file", error.what());
    for (const char c : message)
      expect(c != '\n' && c != '\r' && c != '\0', "a message of several lines", error.what());
  }
}

// The bytes as a file, for readers that take one: one per process, in memory where the system has such a
// place.
class ScratchFile {
 public:
  ScratchFile(const uint8_t* data, size_t size, const std::string& ending)
      : path_(folder() / ("fuzz" + std::to_string(getpid()) + ending)) {
    std::FILE* out = std::fopen(path_.c_str(), "wb");
    expect(out != nullptr, "no scratch file", path_.c_str());
    std::fwrite(data, 1, size, out);
    std::fclose(out);
  }
  ~ScratchFile() { std::filesystem::remove(path_); }
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  static std::filesystem::path folder() {
    const std::filesystem::path memory = "/dev/shm";
    return std::filesystem::exists(memory) ? memory : std::filesystem::temp_directory_path();
  }

  std::filesystem::path path_;
};

}  // namespace skitter::fuzz
