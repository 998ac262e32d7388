#include "skitter/rig.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <new>

#include "embedded/spider_glb.h"
#include "file.h"
#include "gltf.h"
#include "json.h"
#include "skitter/error.h"

namespace skitter {
namespace {

constexpr size_t maxLegs = 24, maxBonesOfLeg = 15;
constexpr double minBoneLength = 1e-6;  // metres
constexpr double maxCoordinate = 1e4;   // metres

// The chains, groups and limits: reads the extras against the file's nodes.
class LegReader {
 public:
  LegReader(const gltf::Document& document, const std::string& name) : document_(document), name_(name) {}

  // The nodes of each leg's joints, foot included, are appended to `chains`.
  void read(Rig& rig, std::vector<std::vector<int>>& chains) {
    const nlohmann::json& extras = document_.extras;
    if (extras.is_null()) {
      throw inputError(fmt::format(
          "{}: has no legs: a rig needs `skitter` in the extras of its scene or of a node (docs/rig.md)",
          name_));
    }
    checkKeys(extras, "skitter", {"groups", "legs", "bodyHeight", "bodyRadius"});
    for (const auto& group : array(extras, "groups", "skitter", 1, maxLegs)) {
      rig.groups.push_back(text(group, fmt::format("skitter.groups[{}]", rig.groups.size())));
      if (std::count(rig.groups.begin(), rig.groups.end(), rig.groups.back()) > 1) {
        throw inputError(fmt::format("{}: skitter.groups names \"{}\" twice", name_, rig.groups.back()));
      }
    }
    rig.bodyHeight =
        static_cast<float>(number(member(extras, "bodyHeight", "skitter"), "skitter.bodyHeight"));
    rig.bodyRadius =
        static_cast<float>(number(member(extras, "bodyRadius", "skitter"), "skitter.bodyRadius"));
    for (const auto& leg : array(extras, "legs", "skitter", 1, maxLegs)) {
      readLeg(leg, fmt::format("skitter.legs[{}]", rig.legs.size()), rig, chains);
    }
    for (size_t group = 0; group < rig.groups.size(); ++group) {
      const auto inGroup = [group](const Leg& leg) { return leg.group == static_cast<int>(group); };
      if (std::none_of(rig.legs.begin(), rig.legs.end(), inGroup)) {
        throw inputError(fmt::format("{}: no leg is in group \"{}\"", name_, rig.groups[group]));
      }
    }
  }

 private:
  [[noreturn]] void fail(const std::string& path, const nlohmann::json& found,
                         const std::string& expected) const {
    throw inputError(fmt::format("{}: {} is {}, expected {}", name_, path, describeJson(found), expected));
  }

  void checkKeys(const nlohmann::json& json, const std::string& path,
                 std::initializer_list<const char*> keys) const {
    if (!json.is_object()) fail(path, json, "an object");
    for (const auto& [key, value] : json.items()) {
      const auto same = [&k = key](const char* known) { return k == known; };
      if (std::none_of(keys.begin(), keys.end(), same)) {
        throw inputError(fmt::format("{}: {} has the unknown key {}, expected one of {}", name_, path,
                                     describeJson(key), fmt::join(keys, ", ")));
      }
    }
  }

  const nlohmann::json& member(const nlohmann::json& json, const char* key, const std::string& path) const {
    const auto found = json.find(key);
    if (found == json.end()) throw inputError(fmt::format("{}: {}.{} is missing", name_, path, key));
    return *found;
  }

  const nlohmann::json& array(const nlohmann::json& json, const char* key, const std::string& path,
                              size_t least, size_t most) const {
    const nlohmann::json& list = member(json, key, path);
    if (!list.is_array() || list.size() < least || list.size() > most) {
      fail(path + "." + key, list, fmt::format("an array of {} to {}", least, most));
    }
    return list;
  }

  double number(const nlohmann::json& json, const std::string& path) const {
    if (!json.is_number() || !(json.get<double>() > 0) || json.get<double>() > maxCoordinate) {
      fail(path, json, fmt::format("a number over 0 and up to {}", maxCoordinate));
    }
    return json.get<double>();
  }

  const std::string& text(const nlohmann::json& json, const std::string& path) const {
    if (!json.is_string() || json.get_ref<const std::string&>().empty())
      fail(path, json, "a string that is not empty");
    return json.get_ref<const std::string&>();
  }

  int findNode(const std::string& joint, const std::string& path) const {
    int found = -1;
    for (size_t i = 0; i < document_.nodes.size(); ++i) {
      if (document_.nodes[i].name != joint) continue;
      if (found != -1)
        throw inputError(fmt::format("{}: {}: two nodes are named \"{}\"", name_, path, joint));
      found = static_cast<int>(i);
    }
    if (found == -1) throw inputError(fmt::format("{}: {}: no node is named \"{}\"", name_, path, joint));
    return found;
  }

  bool isAncestor(int ancestor, int node) const {
    while (node != -1) {
      node = document_.nodes[static_cast<size_t>(node)].parent;
      if (node == ancestor) return true;
    }
    return false;
  }

  glm::dvec3 position(int node, const std::string& path) const {
    const glm::dvec3 p(document_.nodes[static_cast<size_t>(node)].modelFromNode[3]);
    for (int k = 0; k < 3; ++k) {
      if (!(std::fabs(p[k]) <= maxCoordinate)) {
        throw inputError(
            fmt::format("{}: {} rests at {} m, expected within {} m", name_, path, p[k], maxCoordinate));
      }
    }
    return p;
  }

  void readLeg(const nlohmann::json& json, const std::string& path, Rig& rig,
               std::vector<std::vector<int>>& chains) {
    checkKeys(json, path, {"name", "group", "joints", "coneHalfAngleDegrees"});
    Leg leg;
    leg.name = text(member(json, "name", path), path + ".name");
    for (const Leg& other : rig.legs) {
      if (other.name == leg.name)
        throw inputError(fmt::format("{}: two legs are named \"{}\"", name_, leg.name));
    }
    const nlohmann::json& groupJson = member(json, "group", path);
    const std::string& group = text(groupJson, path + ".group");
    const auto found = std::find(rig.groups.begin(), rig.groups.end(), group);
    if (found == rig.groups.end()) {
      fail(path + ".group", groupJson, fmt::format("one of \"{}\"", fmt::join(rig.groups, "\", \"")));
    }
    leg.group = static_cast<int>(found - rig.groups.begin());

    std::vector<int> chain;
    const nlohmann::json& joints = array(json, "joints", path, 2, maxBonesOfLeg + 1);
    for (size_t j = 0; j < joints.size(); ++j) {
      const std::string jointPath = fmt::format("{}.joints[{}]", path, j);
      const std::string& joint = text(joints[j], jointPath);
      const int node = findNode(joint, jointPath);
      for (size_t other = 0; other < chains.size(); ++other) {
        if (std::find(chains[other].begin(), chains[other].end(), node) != chains[other].end()) {
          throw inputError(fmt::format("{}: {}: \"{}\" is a joint of leg {} already", name_, jointPath, joint,
                                       rig.legs[other].name));
        }
      }
      if (j > 0 && !isAncestor(chain.back(), node)) {
        throw inputError(
            fmt::format("{}: {}: \"{}\" is no descendant of \"{}\"; joints run from root to foot", name_,
                        jointPath, joint, leg.bones.back().joint));
      }
      chain.push_back(node);
      if (j + 1 < joints.size()) {
        leg.bones.emplace_back();
        leg.bones.back().joint = joint;
      }
    }

    double reach = 0;
    for (size_t i = 0; i < leg.bones.size(); ++i) {
      Bone& bone = leg.bones[i];
      const glm::dvec3 start = position(chain[i], path), end = position(chain[i + 1], path);
      const double length = glm::length(end - start);
      if (!(length >= minBoneLength)) {
        throw inputError(fmt::format("{}: {}: the bone at \"{}\" has length {}, expected at least {}", name_,
                                     path, bone.joint, length, minBoneLength));
      }
      bone.start = glm::vec3(start);
      bone.direction = glm::vec3((end - start) / length);
      bone.length = static_cast<float>(length);
      reach += length;
    }
    leg.reach = static_cast<float>(reach);
    leg.home = glm::vec3(position(chain.back(), path));
    if (json.contains("coneHalfAngleDegrees")) {
      readCones(array(json, "coneHalfAngleDegrees", path, 0, SIZE_MAX), path + ".coneHalfAngleDegrees", leg);
    }
    rig.legs.push_back(std::move(leg));
    chains.push_back(std::move(chain));
  }

  void readCones(const nlohmann::json& cones, const std::string& path, Leg& leg) const {
    if (cones.size() != leg.bones.size()) {
      throw inputError(
          fmt::format("{}: {} has {} angles, the leg {} bones", name_, path, cones.size(), leg.bones.size()));
    }
    for (size_t i = 0; i < cones.size(); ++i) {
      const double degrees = cones[i].is_number() ? cones[i].get<double>() : -1;
      if (!(degrees > 0 && degrees <= 180)) {
        fail(fmt::format("{}[{}]", path, i), cones[i], "a number over 0 and up to 180");
      }
      // 180 keeps the exact value that means unlimited.
      if (degrees < 180)
        leg.bones[i].coneHalfAngle = static_cast<float>(degrees * 3.14159265358979323846 / 180);
    }
  }

  const gltf::Document& document_;
  const std::string& name_;
};

// Brings every mesh of the scene into model space at rest, weighted onto the pose palette.
class SkinBuilder {
 public:
  SkinBuilder(const gltf::Document& document, const std::vector<uint16_t>& paletteOfNode,
              const std::string& name, Rig& rig)
      : document_(document), paletteOfNode_(paletteOfNode), name_(name), rig_(rig) {}

  void build() {
    for (size_t i = 0; i < document_.nodes.size(); ++i) {
      const gltf::Node& node = document_.nodes[i];
      if (!node.inScene || node.mesh == -1) continue;
      for (const gltf::Primitive& part : document_.meshes[static_cast<size_t>(node.mesh)].primitives)
        add(i, part);
    }
    if (rig_.indices.empty()) throw inputError(fmt::format("{}: has no mesh with triangles", name_));
  }

 private:
  void add(size_t nodeIndex, const gltf::Primitive& part) {
    const gltf::Node& node = document_.nodes[nodeIndex];
    const gltf::Skin* skin = node.skin == -1 ? nullptr : &document_.skins[static_cast<size_t>(node.skin)];
    if (skin && part.influencesPerVertex == 0) {
      throw inputError(
          fmt::format("{}: meshes[{}] is skinned but has no JOINTS_0 and WEIGHTS_0", name_, node.mesh));
    }
    std::vector<glm::dmat4> modelFromBind;
    if (skin) {
      for (size_t k = 0; k < skin->joints.size(); ++k) {
        modelFromBind.push_back(document_.nodes[static_cast<size_t>(skin->joints[k])].modelFromNode *
                                skin->nodeFromBind[k]);
      }
    }

    const size_t first = rig_.vertices.size();
    std::vector<bool> mirrored(part.positions.size());
    std::vector<glm::dvec3> normals(part.positions.size(), glm::dvec3(0));
    for (size_t v = 0; v < part.positions.size(); ++v) {
      SkinVertex vertex;
      glm::dmat4 modelFromVertex = node.modelFromNode;
      if (skin) {
        modelFromVertex = blend(part, v, *skin, modelFromBind, vertex);
      } else {
        vertex.bones[0] = paletteOfNode_[nodeIndex];
      }
      const glm::dvec3 position(modelFromVertex * glm::dvec4(part.positions[v], 1));
      for (int k = 0; k < 3; ++k) {
        if (!(std::fabs(position[k]) <= maxCoordinate)) {
          throw inputError(fmt::format("{}: vertex {} of meshes[{}] rests at {} m, expected within {} m",
                                       name_, v, node.mesh, position[k], maxCoordinate));
        }
      }
      vertex.position = glm::vec3(position);
      vertex.colour = glm::vec3(part.colours[v]);
      const glm::dmat3 linear(modelFromVertex);
      const double determinant = glm::determinant(linear);
      mirrored[v] = determinant < 0;
      if (!part.normals.empty() && determinant != 0) {
        normals[v] = glm::transpose(glm::inverse(linear)) * part.normals[v];
      }
      rig_.vertices.push_back(vertex);
    }

    std::vector<glm::dvec3> faceSums(part.positions.size(), glm::dvec3(0));
    for (size_t t = 0; t + 2 < part.indices.size(); t += 3) {
      uint32_t a = part.indices[t], b = part.indices[t + 1], c = part.indices[t + 2];
      if (mirrored[a]) std::swap(b, c);
      for (uint32_t index : {a, b, c}) rig_.indices.push_back(static_cast<uint32_t>(first + index));
      const auto at = [&](uint32_t index) { return glm::dvec3(rig_.vertices[first + index].position); };
      const glm::dvec3 face = glm::cross(at(b) - at(a), at(c) - at(a));  // its length weighs by area
      for (uint32_t index : {a, b, c}) faceSums[index] += face;
    }
    for (size_t v = 0; v < normals.size(); ++v) {
      for (const glm::dvec3& normal : {normals[v], faceSums[v]}) {
        const double length = glm::length(normal);
        if (!(length > 1e-30) || !std::isfinite(length)) continue;
        rig_.vertices[first + v].normal = glm::vec3(normal / length);
        break;
      }
    }
  }

  // The blended matrix of all influences; the vertex keeps the four heaviest palette entries.
  glm::dmat4 blend(const gltf::Primitive& part, size_t v, const gltf::Skin& skin,
                   const std::vector<glm::dmat4>& modelFromBind, SkinVertex& vertex) const {
    struct Entry {
      uint16_t bone;
      double weight;
    };
    std::vector<Entry> entries;
    glm::dmat4 blended(0);
    double total = 0;
    for (size_t k = 0; k < part.influencesPerVertex; ++k) {
      const gltf::Influence& influence = part.influences[v * part.influencesPerVertex + k];
      if (influence.weight == 0) continue;
      total += influence.weight;
      blended += modelFromBind[influence.joint] * influence.weight;
      const uint16_t bone = paletteOfNode_[static_cast<size_t>(skin.joints[influence.joint])];
      const auto same =
          std::find_if(entries.begin(), entries.end(), [&](const Entry& e) { return e.bone == bone; });
      if (same == entries.end()) {
        entries.push_back({bone, influence.weight});
      } else {
        same->weight += influence.weight;
      }
    }
    if (!(total > 0)) throw inputError(fmt::format("{}: vertex {} has no weight on any joint", name_, v));
    std::stable_sort(entries.begin(), entries.end(),
                     [](const Entry& a, const Entry& b) { return a.weight > b.weight; });
    if (entries.size() > 4) entries.resize(4);
    double kept = 0;
    for (const Entry& entry : entries) kept += entry.weight;
    for (size_t k = 0; k < entries.size(); ++k) {
      vertex.bones[k] = entries[k].bone;
      vertex.weights[k] = static_cast<float>(entries[k].weight / kept);
    }
    return blended / total;
  }

  const gltf::Document& document_;
  const std::vector<uint16_t>& paletteOfNode_;
  const std::string& name_;
  Rig& rig_;
};

// A node that is no joint of a leg moves with its nearest ancestor that is one, else with the body.
std::vector<uint16_t> mapPalette(const gltf::Document& document, const std::vector<std::vector<int>>& chains,
                                 const Rig& rig) {
  std::vector<int> own(document.nodes.size(), -1);
  for (size_t leg = 0; leg < chains.size(); ++leg) {
    const size_t bones = rig.legs[leg].bones.size();
    for (size_t j = 0; j < chains[leg].size(); ++j) {
      own[static_cast<size_t>(chains[leg][j])] =
          1 + static_cast<int>(leg) * rig.maxBones() + static_cast<int>(std::min(j, bones - 1));
    }
  }
  std::vector<uint16_t> palette(document.nodes.size(), 0);
  for (int i : document.parentsFirst) {
    const auto node = static_cast<size_t>(i);
    const int parent = document.nodes[node].parent;
    palette[node] = own[node] != -1 ? static_cast<uint16_t>(own[node])
                    : parent == -1  ? uint16_t{0}
                                    : palette[static_cast<size_t>(parent)];
  }
  return palette;
}

}  // namespace

int Rig::maxBones() const {
  size_t most = 0;
  for (const Leg& leg : legs) most = std::max(most, leg.bones.size());
  return static_cast<int>(most);
}

Rig parseRig(std::span<const uint8_t> glb, const std::string& name) {
  const gltf::Document document = gltf::parse(glb, name);
  try {
    Rig rig;
    rig.name = std::filesystem::path(name).stem().string();
    std::vector<std::vector<int>> chains;
    LegReader(document, name).read(rig, chains);
    rig.legLength = 0;
    for (const Leg& leg : rig.legs) rig.legLength = std::max(rig.legLength, leg.reach);
    SkinBuilder(document, mapPalette(document, chains, rig), name, rig).build();
    return rig;
  } catch (const std::bad_alloc&) {
    throw inputError(fmt::format("{}: does not fit into memory", name));
  }
}

Rig loadRig(const std::filesystem::path& file) { return parseRig(readFile(file), file.string()); }

Rig spiderRig() { return parseRig(embedded::spider_glb(), "spider.glb"); }

}  // namespace skitter
