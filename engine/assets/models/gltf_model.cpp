// tinygltf is compiled here.
#include <fstream>
#define TINYGLTF_IMPLEMENTATION
#include "assets/models/gltf_model.h"

#include <fmt/format.h>

#include <algorithm>

#include "assets/files/json.h"
#include "skitter/error.h"

namespace skitter::gltf {
namespace {

constexpr size_t maxJoints = size_t{1} << 20;  // of all skins

void refuseUnsupported(const nlohmann::json& json, const std::string& name) {
  const auto asset = json.find("asset");
  const auto version = asset != json.end() && asset->is_object() ? asset->find("version") : json.end();
  const bool has = asset != json.end() && asset->is_object() && version != asset->end();
  if (!has || !version->is_string() || version->get_ref<const std::string&>().rfind("2.", 0) != 0) {
    throw inputError(fmt::format("{}: its asset.version is {}, expected 2.x", name,
                                 has ? describeJson(*version) : "missing"));
  }
  const auto required = json.find("extensionsRequired");
  if (required == json.end()) return;
  for (const auto& entry : *required) {
    const std::string extension = entry.is_string() ? entry.get<std::string>() : describeJson(entry);
    // These change how a surface looks or how numbers are packed, both of which are taken as they come.
    if (extension.rfind("KHR_materials_", 0) != 0 && extension.rfind("KHR_texture_", 0) != 0 &&
        extension != "KHR_mesh_quantization") {
      throw inputError(
          fmt::format("{}: requires extension {}, which is not supported", name, describeJson(entry)));
    }
  }
}

// tinygltf ignores lists that are something else, and says nothing of what it misses in a skin.
void checkLists(const nlohmann::json& json, const std::string& name) {
  for (const char* key : {"nodes", "meshes", "skins", "accessors", "bufferViews", "scenes", "materials"}) {
    const auto list = json.find(key);
    if (list == json.end()) continue;
    if (!list->is_array() || list->size() > maxObjects) {
      throw inputError(fmt::format("{}: {} is {}, expected an array of up to {}", name, key,
                                   describeJson(*list), maxObjects));
    }
  }
  const auto skins = json.find("skins");
  size_t total = 0;
  for (size_t i = 0; skins != json.end() && i < skins->size(); ++i) {
    const nlohmann::json& skin = (*skins)[i];
    const auto joints = skin.is_object() ? skin.find("joints") : skin.end();
    const auto isIndex = [](const nlohmann::json& joint) { return joint.is_number_integer(); };
    if (!skin.is_object() || joints == skin.end() || !joints->is_array() ||
        !std::all_of(joints->begin(), joints->end(), isIndex)) {
      throw inputError(
          fmt::format("{}: skins[{}].joints is {}, expected an array of indices", name, i,
                      skin.is_object() && joints != skin.end() ? describeJson(*joints) : "missing"));
    }
    total += joints->size();
    if (total > maxJoints)
      throw inputError(fmt::format("{}: its skins have over {} joints", name, maxJoints));
  }
}

}  // namespace

tinygltf::Model loadModel(const nlohmann::json& whole, const std::string& name) {
  refuseUnsupported(whole, name);
  checkLists(whole, name);
  nlohmann::json json = whole;
  for (const char* key :
       {"buffers", "images", "textures", "samplers", "animations", "cameras", "extensions"}) {
    json.erase(key);
  }
  const std::string text = json.dump();
  tinygltf::TinyGLTF loader;
  tinygltf::Model model;
  std::string error, warning;
  // The error string is filled on success too, so the return value decides.
  if (!loader.LoadASCIIFromString(&model, &error, &warning, text.data(), static_cast<unsigned>(text.size()),
                                  "")) {
    // Before the fault come lines on what is legal, such as missing inverse bind matrices.
    while (!error.empty() && error.back() == '\n') error.pop_back();
    error.erase(0, error.rfind('\n') + 1);
    throw inputError(fmt::format("{}: is not valid glTF: {}", name,
                                 error.empty() ? "a property is missing or has the wrong type" : error));
  }
  return model;
}

}  // namespace skitter::gltf
