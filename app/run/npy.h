#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "assets/files/partial_file.h"

namespace skitter::app {

// Streams a NumPy file (format 1.0, C order) entry by entry along its first axis, whose length is written in
// the end, so that a run that stops early still leaves an array of the entries it has.
class NpyWriter {
 public:
  // `type` is NumPy's, e.g. "<f4" or "|u1"; `shape` is that of one entry.
  NpyWriter(const std::filesystem::path& file, std::string type, std::vector<uint64_t> shape);

  // One or more whole entries.
  template <class T>
  void append(std::span<const T> values) {
    file_.write(std::as_bytes(values));
  }
  void finish(uint64_t entries);

 private:
  std::string header(uint64_t entries) const;

  PartialFile file_;
  std::string type_;
  std::vector<uint64_t> shape_;
};

}  // namespace skitter::app
