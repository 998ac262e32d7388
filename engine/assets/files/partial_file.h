#pragma once

#include <cstdio>
#include <filesystem>
#include <span>
#include <string>

namespace skitter {

// Where a file's bytes will lie: the end of the symbolic links that begin at `file`. That it exists is not
// needed. Throws Error(input) where the links lead nowhere.
std::filesystem::path followed(const std::filesystem::path& file);

// The name that a file in the making has, in the same folder: NAME.part, or a shorter one of fixed length
// where no file's name may be that long.
std::filesystem::path partOf(const std::filesystem::path& file);

// Whether a file of that name can be made, without leaving or removing anything. Throws Error(input) that
// names the file.
void checkPart(const std::filesystem::path& file);

// The system's words for an errno of a write, with what to do about it where they do not say.
std::string writeFault(int error);

// A file in the making: it lies beside NAME under partOf's name, becomes NAME when it is kept and is removed
// otherwise. What a killed program left there goes; while another program writes it, it is refused. Every
// failure throws Error(input) that names the file.
class PartialFile {
 public:
  // Makes it, empty.
  explicit PartialFile(std::filesystem::path file);
  ~PartialFile();
  PartialFile(PartialFile&&) noexcept;
  PartialFile& operator=(PartialFile&&) = delete;

  const std::filesystem::path& name() const { return file_; }
  const std::filesystem::path& part() const { return part_; }

  // Another program may write to part() instead.
  void write(std::span<const std::byte> bytes);
  void write(const std::string& text) { write(std::as_bytes(std::span(text))); }
  void seekToStart();
  void sync();  // returns once what was written is on the disk
  void keep();

 private:
  std::FILE* stream();  // opened where it is first asked for

  std::filesystem::path file_, target_, part_;
  int lock_ = -1;  // open as long as the part is ours
  std::FILE* stream_ = nullptr;
};

// A whole file at once.
void writeText(const std::filesystem::path& file, const std::string& text);

}  // namespace skitter
