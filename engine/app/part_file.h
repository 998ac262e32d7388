#pragma once

#include <cstdio>
#include <filesystem>
#include <span>
#include <string>

namespace skitter::app {

// A file that is written as NAME.part and carries its name only once it is whole. What was not committed is
// removed. Every failure throws Error(input) naming the file.
class PartFile {
 public:
  explicit PartFile(std::filesystem::path file);
  ~PartFile();
  PartFile(PartFile&&) noexcept;
  PartFile& operator=(PartFile&&) = delete;

  void write(std::span<const std::byte> bytes);
  void write(const std::string& text) { write(std::as_bytes(std::span(text))); }
  void seekToStart();
  void commit();

 private:
  [[noreturn]] void fail() const;

  std::filesystem::path file_, part_;
  std::FILE* stream_ = nullptr;
};

// Text to a file at once.
void writeText(const std::filesystem::path& file, const std::string& text);

// Checks made before any work: that a file can be written in its folder, or that a folder can be made or
// used. `option` begins the message.
void checkFileTarget(const std::string& option, const std::filesystem::path& file);
void checkFolderTarget(const std::string& option, const std::filesystem::path& folder);
// And that the disk has room for what will be written to a file or folder.
void checkRoom(const std::string& option, const std::filesystem::path& target, double bytes);

}  // namespace skitter::app
