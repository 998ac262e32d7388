#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <string>

#include "assets/files/json.h"
#include "skitter/error.h"

namespace skitter::scenes {

// Where a scene comes from: what messages call it, and what its file names are relative to.
struct Source {
  std::string file;
  std::filesystem::path folder;
};

[[noreturn]] inline void failIn(const std::string& file, const std::string& path, const nlohmann::json& found,
                                const std::string& expected) {
  throw inputError(fmt::format("{}: {} is {}, expected {}", file, path, describeJson(found), expected));
}

}  // namespace skitter::scenes
