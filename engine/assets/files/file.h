#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <vector>

namespace skitter {

// A file read piece by piece. Opening it throws Error(input) where it is missing, a directory, empty,
// unreadable or a Git LFS pointer.
class FileStream {
 public:
  explicit FileStream(const std::filesystem::path& file);
  uintmax_t size() const { return size_; }
  void seek(uintmax_t at) { stream_.seekg(static_cast<std::streamoff>(at)); }
  void read(void* to, size_t bytes);  // throws Error(input) where fewer are left

 private:
  std::filesystem::path file_;
  uintmax_t size_ = 0;
  std::ifstream stream_;
};

// Every file that this process has opened by a FileStream, so that a program can refuse to write over one.
std::vector<std::filesystem::path> filesRead();

// The whole file. Throws Error(input) where it is missing, a directory, empty, over 2 GiB or unreadable.
std::vector<uint8_t> readFile(const std::filesystem::path& file);

}  // namespace skitter
