#include "assets/models/gltf.h"

#include <fmt/format.h>

#include <cstring>
#include <new>

#include "assets/models/gltf_clips.h"
#include "assets/models/gltf_materials.h"
#include "assets/models/gltf_meshes.h"
#include "assets/models/gltf_nodes.h"
#include "assets/models/gltf_source.h"
#include "skitter/error.h"

namespace skitter::gltf {
namespace {

void checkSkinning(const Source& source, const Document& document, const Node& node) {
  if (node.mesh == -1 || node.skin == -1) return;
  const size_t joints = document.skins[static_cast<size_t>(node.skin)].joints.size();
  const uint32_t highest = document.meshes[static_cast<size_t>(node.mesh)].highestJoint;
  if (highest >= joints) {
    source.fail("meshes[{}] uses joint {}, but skins[{}] has {}", node.mesh, highest, node.skin, joints);
  }
}

Document read(Source source) {
  Document document;
  readNodes(source, document);
  document.materials = readMaterials(source);
  for (size_t i = 0; i < source.model.meshes.size(); ++i)
    document.meshes.push_back(readMesh(source, document.materials, i));
  for (size_t i = 0; i < source.model.skins.size(); ++i) document.skins.push_back(readSkin(source, i));
  for (const Node& node : document.nodes) checkSkinning(source, document, node);
  readClips(source, document);
  document.notes = std::move(source.notes);
  return document;
}

nlohmann::json findExtras(const nlohmann::json& json) {
  const auto extrasOf = [](const nlohmann::json& object) -> const nlohmann::json* {
    if (!object.is_object()) return nullptr;
    const auto extras = object.find("extras");
    if (extras == object.end() || !extras->is_object()) return nullptr;
    const auto found = extras->find("skitter");
    return found == extras->end() ? nullptr : &*found;
  };
  for (const char* key : {"scenes", "nodes"}) {
    const auto list = json.find(key);
    if (list == json.end() || !list->is_array()) continue;
    if (std::strcmp(key, "scenes") == 0) {
      const auto scene = json.find("scene");
      const size_t index = scene != json.end() && scene->is_number_unsigned() ? scene->get<size_t>() : 0;
      if (index < list->size()) {
        if (const auto* extras = extrasOf((*list)[index])) return *extras;
      }
      continue;
    }
    for (const auto& object : *list) {
      if (const auto* extras = extrasOf(object)) return *extras;
    }
  }
  return nullptr;
}

}  // namespace

Document parse(std::span<const uint8_t> bytes, const std::string& name, const std::filesystem::path& folder) {
  try {
    const File file = openFile(bytes, name, folder);
    const tinygltf::Model model = loadModel(file.json, name);
    Document document = read({.model = model, .file = file, .name = name});
    document.extras = findExtras(file.json);
    return document;
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw inputError(fmt::format("{}: does not fit into memory", name));
  } catch (const std::exception& exception) {
    // tinygltf lets exceptions of the JSON library and of containers through.
    throw inputError(fmt::format("{}: is not valid glTF: {}", name, exception.what()));
  }
}

}  // namespace skitter::gltf
