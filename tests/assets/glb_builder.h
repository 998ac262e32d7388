#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <vector>

namespace skitter::test {

// A glTF binary taken apart, to be changed and put together again.
struct Glb {
  nlohmann::json json;
  std::vector<uint8_t> binary;

  std::vector<uint8_t> bytes() const;
  nlohmann::json& node(const std::string& name);
  // The bytes of an accessor's buffer view, in `binary`.
  uint8_t* data(const nlohmann::json& accessor);
};

Glb readGlb(const std::filesystem::path& file);

// One triangle on a leg of two bones, each 1 m: root at (0, 1, 0), knee at (1, 1, 0), foot at (1, 0, 0).
Glb smallestRig();

}  // namespace skitter::test
