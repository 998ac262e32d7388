#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

// Every file that includes tinygltf must see it configured alike.
#define TINYGLTF_NO_FS
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_INCLUDE_JSON
#include <tiny_gltf.h>

namespace skitter::gltf {

inline constexpr size_t maxObjects = size_t{1} << 16;  // nodes, meshes, skins, clips and the like, of each

// The attribute as which a primitive has its index accessor: tinygltf refuses those that have no buffer view,
// though they may be sparse or empty, and files whose unused meshes name one that is not there.
inline constexpr const char* indexAttribute = "_INDICES";

// The oddities of a file, a line each.
struct Notes {
  std::vector<std::string> lines = {};

  // Keeps the first note of a kind, and counts the others, which it names in the end.
  void add(const std::string& kind, std::string line);
  std::vector<std::string> finished() const;

 private:
  struct Kind {
    size_t line = 0, more = 0;
  };
  std::map<std::string, Kind> kinds_;
};

// A node as messages call it: nodes[3] ("eyes").
std::string nodeLabel(size_t index, const nlohmann::json& node);

// What tinygltf reads of a file: nodes, meshes, skins, materials and accessors. Buffers are the caller's,
// clips and textures are read apart, and no image is decoded.
// Throws Error(input) that begins with `name` where the JSON requires an extension without which it means
// nothing, or tinygltf refuses it; what it refers to is not checked.
tinygltf::Model loadModel(const nlohmann::json& json, const std::string& name, Notes& notes);

}  // namespace skitter::gltf
