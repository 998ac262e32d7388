// tinygltf is compiled here.
#include <fstream>
#define TINYGLTF_IMPLEMENTATION
#include "assets/models/gltf_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <string_view>

#include "assets/files/json.h"
#include "assets/models/gltf_file.h"
#include "skitter/error.h"

namespace skitter::gltf {
namespace {

constexpr size_t maxJoints = size_t{1} << 20;  // of all skins

// Extensions that a file may require and that are read, or without which its creature still moves and shows:
// names or their beginnings, and what is lost. "": nothing, or the reader of it says so.
struct Dispensable {
  std::string_view name, lost;
};
constexpr std::string_view plainer = "its surfaces look plainer", unread = "what it describes is left out";
constexpr Dispensable dispensable[] = {
    {"KHR_mesh_quantization", ""},
    {"KHR_texture_transform", ""},
    {"KHR_animation_pointer", ""},
    {"KHR_materials_", plainer},
    {"EXT_materials_", plainer},
    {"ADOBE_materials_", plainer},
    {"VRMC_materials_", plainer},
    {"KHR_techniques_webgl", plainer},
    {"KHR_blend", plainer},
    {"KHR_texture_", "only PNG and JPEG are drawn"},
    {"EXT_texture_", "only PNG and JPEG are drawn"},
    {"MSFT_texture_dds", "only PNG and JPEG are drawn"},
    {"MSFT_packing_", plainer},
    {"KHR_lights_", "its lights are left out"},
    {"EXT_lights_", "its lights are left out"},
    {"KHR_audio", "its sounds are left out"},
    {"KHR_xmp", "it says who made the file"},
    {"KHR_node_", "hidden nodes are drawn, too"},
    {"KHR_interactivity", unread},
    {"KHR_physics_", unread},
    {"KHR_implicit_shapes", unread},
    {"KHR_collision_shapes", unread},
    {"KHR_rigid_bodies", unread},
    {"EXT_mesh_gpu_instancing", "each mesh is placed once"},
    {"EXT_mesh_features", unread},
    {"EXT_instance_features", unread},
    {"EXT_structural_metadata", unread},
    {"EXT_feature_metadata", unread},
    {"MSFT_lod", "the finest level is drawn"},
    {"MSFT_physics", unread},
    {"VRM", unread},
    {"OMI_", unread},
    {"FB_", unread},
    {"AGI_", unread},
    {"CESIUM_", unread},
    {"GODOT_", unread},
    {"GOOGLE_", unread},
    {"NV_", unread},
};

void checkRequired(const nlohmann::json& json, const std::string& name, std::vector<std::string>& notes) {
  const auto required = json.find("extensionsRequired");
  if (required == json.end()) return;
  std::set<std::string> told;
  for (const auto& entry : *required) {
    const std::string extension = entry.is_string() ? entry.get<std::string>() : describeJson(entry);
    if (extension == "KHR_draco_mesh_compression" || extension.ends_with("_meshopt_compression"))
      throw inputError(fmt::format("{}: {}", name, unpackHint(extension)));
    const auto* known =
        std::find_if(std::begin(dispensable), std::end(dispensable),
                     [&](const Dispensable& each) { return extension.starts_with(each.name); });
    if (known == std::end(dispensable)) {
      throw inputError(fmt::format("{}: requires extension {}, which is not supported: export it without",
                                   name, describeJson(entry)));
    }
    if (known->lost.empty() || !told.insert(extension).second) continue;
    notes.push_back(
        fmt::format("requires extension {}, which is not read: {}", describeJson(entry), known->lost));
  }
}

// JSON has no word for numbers that are not finite, so that exporters write null. tinygltf would take such a
// list for missing, without a word.
void dropNumberless(nlohmann::json& node, size_t index, Notes& notes) {
  for (const char* key : {"matrix", "translation", "rotation", "scale"}) {
    const auto list = node.find(key);
    const auto isNumber = [](const nlohmann::json& each) { return each.is_number(); };
    if (list == node.end() || (list->is_array() && std::all_of(list->begin(), list->end(), isNumber)))
      continue;
    const nlohmann::json* odd = &*list;
    if (list->is_array()) odd = &*std::find_if_not(list->begin(), list->end(), isNumber);
    notes.add(key, fmt::format("{}.{} holds {}, expected numbers: left out", nodeLabel(index, node), key,
                               describeJson(*odd)));
    node.erase(key);
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

// Checks that a primitive's positions are anywhere but in what an extension packs, and moves its indices.
void preparePrimitive(nlohmann::json& primitive, const nlohmann::json& accessors, const std::string& what) {
  const auto attributes = primitive.is_object() ? primitive.find("attributes") : primitive.end();
  if (!primitive.is_object() || attributes == primitive.end() || !attributes->is_object()) return;
  const auto indices = primitive.find("indices");
  if (indices != primitive.end() && indices->is_number_integer()) {
    (*attributes)[indexAttribute] = *indices;
    primitive.erase("indices");
  }
  constexpr const char* packer = "KHR_draco_mesh_compression";
  const auto extensions = primitive.find("extensions");
  if (extensions == primitive.end() || !extensions->contains(packer)) return;
  const auto positions = attributes->find("POSITION");
  if (positions == attributes->end() || !positions->is_number_unsigned()) return;
  const size_t index = positions->get<size_t>();
  if (!accessors.is_array() || index >= accessors.size()) return;
  if (!accessors[index].contains("bufferView") && !accessors[index].contains("sparse"))
    throw inputError(fmt::format("{} {}", what, unpackHint(packer)));
}

}  // namespace

std::string nodeLabel(size_t index, const nlohmann::json& node) {
  const auto name = node.find("name");
  const bool named = name != node.end() && name->is_string() && !name->get_ref<const std::string&>().empty();
  return fmt::format("nodes[{}]{}", index, named ? fmt::format(" ({})", describeJson(*name)) : "");
}

tinygltf::Model loadModel(const nlohmann::json& whole, const std::string& name, Notes& notes) {
  checkRequired(whole, name, notes.lines);
  checkLists(whole, name);
  nlohmann::json json = whole;
  for (const char* key :
       {"buffers", "images", "textures", "samplers", "animations", "cameras", "extensions"}) {
    json.erase(key);
  }
  json["asset"] = {{"version", "2.0"}};
  for (const char* key : {"nodes", "materials", "scenes"}) {
    const auto list = json.find(key);
    if (list == json.end()) continue;
    for (size_t i = 0; i < list->size(); ++i) {
      nlohmann::json& object = (*list)[i];
      if (!object.is_object()) continue;
      object.erase("extensions");  // none is read here, and what is malformed in them refuses no file
      if (std::string_view(key) == "nodes") dropNumberless(object, i, notes);
    }
  }
  const nlohmann::json accessors = json.value("accessors", nlohmann::json());
  const auto meshes = json.find("meshes");
  for (size_t i = 0; meshes != json.end() && i < meshes->size(); ++i) {
    nlohmann::json& mesh = (*meshes)[i];
    const auto primitives = mesh.is_object() ? mesh.find("primitives") : mesh.end();
    const bool isList = mesh.is_object() && primitives != mesh.end() && primitives->is_array();
    for (size_t k = 0; isList && k < primitives->size(); ++k)
      preparePrimitive((*primitives)[k], accessors, fmt::format("{}: meshes[{}].primitives[{}]", name, i, k));
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
