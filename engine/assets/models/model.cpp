#include "assets/models/model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <new>
#include <set>

#include "assets/files/file.h"
#include "assets/materials/tangents.h"
#include "assets/models/gltf_materials.h"
#include "skitter/error.h"

namespace skitter {
namespace {

constexpr size_t maxVertices = size_t{1} << 22, maxIndices = size_t{1} << 24;  // of all meshes as placed
constexpr size_t maxInfluences = size_t{1} << 24;
constexpr size_t maxMaterials = 64;    // each has a draw for each page and level
constexpr double maxCoordinate = 1e9;  // units of the file, of nodes and vertices at rest

class ModelBuilder {
 public:
  ModelBuilder(const gltf::Document& document, Model& model) : document_(document), model_(model) {}

  void build() {
    chooseLook();
    for (const gltf::Node& node : document_.nodes) {
      model_.nodes.push_back({node.name, node.parent, false, node.modelFromNode});
      checkCoordinates(model_.nodes.back().position(),
                       [&] { return fmt::format("nodes[{}]", model_.nodes.size() - 1); });
    }
    for (const gltf::Skin& skin : document_.skins) {
      std::vector<glm::dmat4>& modelFromBind = modelFromBind_.emplace_back();
      for (size_t k = 0; k < skin.joints.size(); ++k) {
        Model::Node& node = model_.nodes[static_cast<size_t>(skin.joints[k])];
        node.joint = true;
        modelFromBind.push_back(node.modelFromNode * skin.nodeFromBind[k]);
      }
    }
    for (size_t i = 0; i < document_.nodes.size(); ++i) {
      const gltf::Node& node = document_.nodes[i];
      if (!node.inScene || node.mesh == -1) continue;
      for (const gltf::Primitive& part : document_.meshes[static_cast<size_t>(node.mesh)].primitives)
        add(i, part);
    }
    if (look_) model_.look.materials = std::move(look_);
    noteOddities();
  }

 private:
  template <typename... Arguments>
  [[noreturn]] void fail(fmt::format_string<Arguments...> format, Arguments&&... arguments) const {
    throw inputError(model_.name + ": " + fmt::format(format, std::forward<Arguments>(arguments)...));
  }

  template <typename Describe>
  void checkCoordinates(const glm::dvec3& position, const Describe& describe) const {
    for (int k = 0; k < 3; ++k) {
      if (!(std::fabs(position[k]) <= maxCoordinate)) {
        fail("{} rests at {}, expected within {}", describe(), position[k], maxCoordinate);
      }
    }
  }

  void add(size_t nodeIndex, const gltf::Primitive& part) {
    const gltf::Node& node = document_.nodes[nodeIndex];
    const gltf::Skin* skin = node.skin == -1 ? nullptr : &document_.skins[static_cast<size_t>(node.skin)];
    if (skin && part.influencesPerVertex == 0) {
      fail("meshes[{}] is skinned but has no JOINTS_0 and WEIGHTS_0", node.mesh);
    }
    if (part.positions.size() > maxVertices - model_.vertices.size() ||
        part.indices.size() > maxIndices - model_.indices.size() ||
        part.influences.size() > maxInfluences - model_.influences.size()) {
      fail("its meshes have over {} vertices, {} indices or {} weights in all", maxVertices, maxIndices,
           maxInfluences);
    }
    const size_t first = model_.vertices.size();
    std::vector<bool> mirrored(part.positions.size());
    std::vector<glm::dvec3> normals(part.positions.size(), glm::dvec3(0));
    std::vector<glm::dvec4> tangents;
    for (size_t v = 0; v < part.positions.size(); ++v) {
      Model::Vertex vertex;
      vertex.firstInfluence = static_cast<uint32_t>(model_.influences.size());
      glm::dmat4 modelFromVertex = node.modelFromNode;
      if (skin) {
        modelFromVertex = blend(part, v, *skin, modelFromBind_[static_cast<size_t>(node.skin)]);
      } else {
        model_.influences.push_back({static_cast<uint32_t>(nodeIndex), 1.0});
      }
      vertex.influences = static_cast<uint32_t>(model_.influences.size()) - vertex.firstInfluence;
      vertex.position = glm::dvec3(modelFromVertex * glm::dvec4(part.positions[v], 1));
      checkCoordinates(vertex.position, [&] { return fmt::format("vertex {} of meshes[{}]", v, node.mesh); });
      vertex.colour = glm::vec3(part.colours[v]);
      const glm::dmat3 linear(modelFromVertex);
      const double determinant = glm::determinant(linear);
      mirrored[v] = determinant < 0;
      if (!part.normals.empty() && determinant != 0) {
        normals[v] = glm::transpose(glm::inverse(linear)) * part.normals[v];
      }
      // Without the normals that they were made for, tangents count for nothing (glTF 2.0, section 3.7.2.1).
      if (look_ && !part.tangents.empty() && !part.normals.empty())
        tangents.push_back(turnedTangent(linear, part.tangents[v]));
      model_.vertices.push_back(vertex);
    }
    if (skin) weightless_ += part.weightless;
    addTriangles(part, first, mirrored, normals);
    if (look_) addLook(part, first, tangents);
    ++model_.primitives;
  }

  // The materials of what is placed in the scene, where one of them takes more than colours at vertices.
  void chooseLook() {
    std::set<int> worn;
    for (const gltf::Node& node : document_.nodes) {
      if (!node.inScene || node.mesh == -1) continue;
      for (const gltf::Primitive& part : document_.meshes[static_cast<size_t>(node.mesh)].primitives)
        worn.insert(part.material);
    }
    const auto isPlain = [&](int material) {
      return material == -1 || gltf::isPlain(document_.materials.list[static_cast<size_t>(material)]);
    };
    if (std::all_of(worn.begin(), worn.end(), isPlain)) return;
    if (worn.size() > maxMaterials) {
      model_.notes.push_back(
          fmt::format("{} materials are drawn, expected at most {}: colour is COLOR_0 "
                      "times the material's base colour",
                      worn.size(), maxMaterials));
      return;
    }
    look_ = std::make_shared<Materials>();
    look_->images = document_.materials.images;
    for (const int material : worn) {
      places_[material] = static_cast<uint16_t>(look_->list.size());
      look_->list.push_back(material == -1 ? Material()
                                           : document_.materials.list[static_cast<size_t>(material)]);
    }
  }

  void addLook(const gltf::Primitive& part, size_t first, const std::vector<glm::dvec4>& tangents) {
    const uint16_t place = places_.at(part.material);
    std::vector<MaterialVertex>& vertices = model_.look.vertices;
    for (size_t v = 0; v < part.positions.size(); ++v) {
      MaterialVertex& vertex = vertices.emplace_back();
      for (size_t set = 0; set < part.uvs.size(); ++set)
        if (!part.uvs[set].empty()) vertex.uv[set] = glm::vec2(part.uvs[set][v]);
      vertex.opacity = static_cast<float>(part.opacities[v]);
      vertex.material = place;
      if (!tangents.empty()) vertex.tangent = glm::vec4(tangents[v]);
    }
    const Texture& normal = look_->list[place].texture(TextureRole::normal);
    if (tangents.empty() && normal.image != -1) makeTangents(model_, first, part.indices.size(), normal);
  }

  void addTriangles(const gltf::Primitive& part, size_t first, const std::vector<bool>& mirrored,
                    const std::vector<glm::dvec3>& normals) {
    std::vector<glm::dvec3> faceSums(part.positions.size(), glm::dvec3(0));
    for (size_t t = 0; t + 2 < part.indices.size(); t += 3) {
      uint32_t a = part.indices[t], b = part.indices[t + 1], c = part.indices[t + 2];
      if (mirrored[a]) std::swap(b, c);
      for (uint32_t index : {a, b, c}) model_.indices.push_back(static_cast<uint32_t>(first + index));
      const auto at = [&](uint32_t index) { return model_.vertices[first + index].position; };
      const glm::dvec3 face = glm::cross(at(b) - at(a), at(c) - at(a));  // its length weighs by area
      for (uint32_t index : {a, b, c}) faceSums[index] += face;
    }
    for (size_t v = 0; v < normals.size(); ++v) {
      for (const glm::dvec3& normal : {normals[v], faceSums[v]}) {
        const double length = glm::length(normal);
        if (!(length > 1e-30) || !std::isfinite(length)) continue;
        model_.vertices[first + v].normal = glm::vec3(normal / length);
        break;
      }
    }
  }

  // The blended matrix of all influences, which are kept, scaled to a sum of 1.
  glm::dmat4 blend(const gltf::Primitive& part, size_t v, const gltf::Skin& skin,
                   const std::vector<glm::dmat4>& modelFromBind) {
    glm::dmat4 blended(0);
    double total = 0;
    const size_t first = model_.influences.size();
    for (size_t k = 0; k < part.influencesPerVertex; ++k) {
      const gltf::Influence& influence = part.influences[v * part.influencesPerVertex + k];
      if (influence.weight == 0) continue;
      total += influence.weight;
      blended += modelFromBind[influence.joint] * influence.weight;
      model_.influences.push_back({static_cast<uint32_t>(skin.joints[influence.joint]), influence.weight});
    }
    if (std::fabs(total - 1) > 1e-3) ++unscaled_;
    if (model_.influences.size() - first > 4) ++crowded_;
    for (size_t k = first; k < model_.influences.size(); ++k) model_.influences[k].weight /= total;
    return blended / total;
  }

  void noteOddities() {
    auto& notes = model_.notes;
    if (unscaled_ > 0)
      notes.push_back(fmt::format("{} vertices' weights do not sum to 1: scaled", unscaled_));
    if (weightless_ > 0) {
      notes.push_back(
          fmt::format("{} vertices have no weight: each follows the joint that it names first", weightless_));
    }
    if (crowded_ > 0) {
      notes.push_back(
          fmt::format("{} vertices have over four joints: the four heaviest bones count", crowded_));
    }
    size_t roots = 0, mirrored = 0, scaled = 0;
    std::vector<std::string> names;
    for (const Model::Node& node : model_.nodes) {
      if (!node.joint) continue;
      names.push_back(node.name);
      if (node.parent == -1 || !model_.nodes[static_cast<size_t>(node.parent)].joint) ++roots;
      const double volume = glm::determinant(glm::dmat3(node.modelFromNode));
      if (volume < 0) ++mirrored;
      if (std::fabs(std::fabs(volume) - 1) > 1e-3) ++scaled;
    }
    if (roots > 1) notes.push_back(fmt::format("the joints have {} roots", roots));
    if (scaled > 0) notes.push_back(fmt::format("{} joints are scaled", scaled));
    if (mirrored > 0) notes.push_back(fmt::format("{} joints are mirrored", mirrored));
    std::sort(names.begin(), names.end());
    size_t shared = 0, nameless = static_cast<size_t>(std::count(names.begin(), names.end(), ""));
    for (size_t i = nameless; i + 1 < names.size(); ++i) shared += names[i] == names[i + 1];
    if (nameless > 0) notes.push_back(fmt::format("{} joints have no name: #INDEX stands for it", nameless));
    if (shared > 0)
      notes.push_back(fmt::format("{} joint names are taken twice: #INDEX tells them apart", shared));
    size_t moved = 0;
    for (const gltf::Node& node : document_.nodes) {
      moved += node.mesh != -1 && node.skin != -1 && node.inScene && node.modelFromNode != glm::dmat4(1);
    }
    if (moved > 0)
      notes.push_back(fmt::format("{} skinned meshes' nodes are placed: skinning ignores it", moved));
  }

  const gltf::Document& document_;
  Model& model_;
  std::vector<std::vector<glm::dmat4>> modelFromBind_;  // of each skin's joints
  std::shared_ptr<Materials> look_;  // null where no material is drawn by more than colours
  std::map<int, uint16_t> places_;   // of the document's materials in it
  size_t unscaled_ = 0, crowded_ = 0, weightless_ = 0;
};

void expectNode(const Model& model, int node) {
  if (node < 0 || static_cast<size_t>(node) >= model.nodes.size())
    throw inputError(
        fmt::format("{}: node {}, expected one of {} nodes", model.name, node, model.nodes.size()));
}

}  // namespace

size_t Model::jointCount() const {
  return static_cast<size_t>(
      std::count_if(nodes.begin(), nodes.end(), [](const Node& n) { return n.joint; }));
}

bool Model::isAncestor(int ancestor, int node) const {
  if (node != -1) expectNode(*this, node);
  while (node != -1) {
    node = nodes[static_cast<size_t>(node)].parent;
    if (node == ancestor) return true;
  }
  return false;
}

std::string Model::reference(int node) const {
  expectNode(*this, node);
  const std::string& own = nodes[static_cast<size_t>(node)].name;
  const auto same = [&](const Node& other) { return other.name == own; };
  if (own.empty() || std::count_if(nodes.begin(), nodes.end(), same) > 1) return fmt::format("#{}", node);
  return own;
}

Model makeModel(const gltf::Document& document, const std::string& name) {
  Model model;
  model.name = name;
  model.parentsFirst = document.parentsFirst;
  model.skins = document.skins.size();
  model.meshes = document.meshes.size();
  model.notes = document.notes;
  for (const gltf::Clip& clip : document.clips)
    model.clips.push_back({clip.name, clip.seconds, clip.channelCount});
  ModelBuilder(document, model).build();
  return model;
}

Model loadModel(const std::filesystem::path& file) {
  const std::string name = file.string();
  try {
    // A file in the working directory has no folder in its path, and "" would refuse its buffers.
    const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
    return makeModel(gltf::parse(readFile(file), name, folder), name);
  } catch (const std::bad_alloc&) {
    throw inputError(fmt::format("{}: does not fit into memory", name));
  }
}

}  // namespace skitter
