#include "assets/models/gltf.h"

#include <fmt/format.h>

#include <cstring>
#include <new>
#include <set>

#include "assets/files/json.h"
#include "assets/models/gltf_clips.h"
#include "assets/models/gltf_materials.h"
#include "assets/models/gltf_meshes.h"
#include "assets/models/gltf_nodes.h"
#include "assets/models/gltf_source.h"
#include "assets/models/reading_notes.h"
#include "skitter/error.h"

namespace skitter::gltf {
namespace {

void checkSkinning(const Source& source, const Document& document, const Node& node) {
  if (!node.inScene || node.mesh == -1 || node.skin == -1) return;
  const size_t joints = document.skins[static_cast<size_t>(node.skin)].joints.size();
  const uint32_t highest = document.meshes[static_cast<size_t>(node.mesh)].highestJoint;
  if (highest >= joints) {
    source.fail("meshes[{}] uses joint {}, but skins[{}] has {}", node.mesh, highest, node.skin, joints);
  }
}

// A part that no node of the scene has need not be right.
template <typename Part, typename Read>
void readPart(Source& source, std::vector<Part>& parts, bool placed, const Read& read) {
  try {
    parts.push_back(read(parts.size()));
  } catch (const Error& error) {
    if (placed) throw;
    source.notes.lines.push_back(error.detail(source.name) + ": left out, no node of the scene has it");
    parts.emplace_back();
  }
}

void noteBackslashes(Source& source) {
  for (const char* key : {"buffers", "images"}) {
    const auto list = source.file.json.find(key);
    if (list == source.file.json.end() || !list->is_array()) continue;
    for (size_t i = 0; i < list->size(); ++i) {
      const nlohmann::json& each = (*list)[i];
      const auto uri = each.is_object() ? each.find("uri") : each.end();
      if (!each.is_object() || uri == each.end() || !uri->is_string()) continue;
      const std::string& text = uri->get_ref<const std::string&>();
      if (text.starts_with("data:") || text.find('\\') == std::string::npos) continue;
      source.notes.add("backslash", fmt::format("{}[{}].uri is {}: its backslashes count as slashes", key, i,
                                                describeJson(*uri)));
    }
  }
}

Document read(Source source) {
  Document document;
  noteBackslashes(source);
  readNodes(source, document);
  document.materials = readMaterials(source);
  std::set<int> meshes, skins;
  for (const Node& node : document.nodes) {
    if (node.inScene && node.mesh != -1) meshes.insert(node.mesh), skins.insert(node.skin);
  }
  for (size_t i = 0; i < source.model.meshes.size(); ++i)
    readPart(source, document.meshes, meshes.contains(static_cast<int>(i)),
             [&](size_t index) { return readMesh(source, document.materials, index); });
  for (size_t i = 0; i < source.model.skins.size(); ++i)
    readPart(source, document.skins, skins.contains(static_cast<int>(i)),
             [&](size_t index) { return readSkin(source, document, index); });
  for (const Node& node : document.nodes) checkSkinning(source, document, node);
  readClips(source, document);
  document.notes = source.notes.finished();
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
    Notes notes;
    notes.lines = file.notes;
    const tinygltf::Model model = loadModel(file.json, name, notes);
    Document document = read({.model = model, .file = file, .name = name, .notes = std::move(notes)});
    document.extras = findExtras(file.json);
    noteReading(name, document.notes);
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
