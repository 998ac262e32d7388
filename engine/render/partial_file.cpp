#include "render/partial_file.h"

#include <fmt/format.h>

#include "skitter/error.h"

namespace skitter::render {

PartialFile::PartialFile(std::filesystem::path file) : file_(std::move(file)), part_(file_) {
  part_ += ".part";
}

PartialFile::~PartialFile() {
  std::error_code ignored;
  if (!kept_) std::filesystem::remove(part_, ignored);
}

void PartialFile::keep() {
  std::error_code error;
  std::filesystem::rename(part_, file_, error);
  if (error) throw inputError(fmt::format("{}: cannot be written: {}", file_.string(), error.message()));
  kept_ = true;
}

}  // namespace skitter::render
