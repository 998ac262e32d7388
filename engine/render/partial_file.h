#pragma once

#include <filesystem>

namespace skitter::render {

// A file in the making: NAME.part, which becomes NAME when it is kept and is removed otherwise.
class PartialFile {
 public:
  explicit PartialFile(std::filesystem::path file);
  ~PartialFile();
  PartialFile(const PartialFile&) = delete;
  PartialFile& operator=(const PartialFile&) = delete;

  const std::filesystem::path& name() const { return file_; }
  const std::filesystem::path& part() const { return part_; }
  // Throws Error(input).
  void keep();

 private:
  std::filesystem::path file_, part_;
  bool kept_ = false;
};

}  // namespace skitter::render
