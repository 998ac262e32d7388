#pragma once

#include <nlohmann/json.hpp>
#include <string>

// Every file that includes tinygltf must see it configured alike.
#define TINYGLTF_NO_FS
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_INCLUDE_JSON
#include <tiny_gltf.h>

namespace skitter::gltf {

inline constexpr size_t maxObjects = size_t{1} << 16;  // nodes, meshes, skins, clips and the like, of each

// What tinygltf reads of a file: nodes, meshes, skins, materials and accessors. Buffers are the caller's,
// clips and textures are read apart, and no image is decoded.
// Throws Error(input) that begins with `name` where the JSON is no glTF 2.0, requires an extension that is
// not supported, or tinygltf refuses it; what it refers to is not checked.
tinygltf::Model loadModel(const nlohmann::json& json, const std::string& name);

}  // namespace skitter::gltf
