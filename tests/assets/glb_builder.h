#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <type_traits>
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

  // Adds numbers (float, uint8_t or uint16_t) at the buffer's end and returns the index of their accessor.
  template <typename Number>
  size_t append(const std::vector<Number>& numbers, const std::string& type) {
    static_assert(std::is_same_v<Number, float> || std::is_unsigned_v<Number>);
    const int component = std::is_same_v<Number, float> ? 5126 : sizeof(Number) == 1 ? 5121 : 5123;
    return append(std::as_bytes(std::span(numbers)), component, type, numbers.size());
  }
  // Adds a channel to the last clip, or to a first one.
  void animate(size_t node, const std::string& path, const std::string& interpolation,
               const std::vector<float>& times, const std::vector<float>& values);
  // Writes it as .glb, or as .gltf with its buffer beside it.
  void write(const std::filesystem::path& file) const;

 private:
  size_t append(std::span<const std::byte> bytes, int component, const std::string& type, size_t numbers);
};

Glb readGlb(const std::filesystem::path& file);

// One triangle on a leg of two bones, each 1 m: root at (0, 1, 0), knee at (1, 1, 0), foot at (1, 0, 0).
Glb smallestRig();

}  // namespace skitter::test
