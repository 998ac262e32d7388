#include "gltf.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <glm/gtc/quaternion.hpp>
#include <map>
#include <new>

#include "gltf_file.h"
#include "json.h"
#include "skitter/error.h"

#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_FS
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_INCLUDE_JSON
#include <tiny_gltf.h>

namespace skitter::gltf {
namespace {

constexpr size_t maxElements = size_t{1} << 24;  // of an accessor
constexpr size_t maxZeros = size_t{1} << 20;     // elements of an accessor without data
constexpr size_t maxNumbers = size_t{1} << 26;   // of all accessors, each as often as it is used
constexpr size_t maxObjects = size_t{1} << 16;   // nodes, meshes, skins, clips and the like, of each
constexpr size_t maxJoints = size_t{1} << 20;    // of all skins

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

// What tinygltf reads of the file: nodes, meshes, skins, materials and accessors. Buffers are the caller's,
// clips are read apart, and pictures are not read at all, so that there is nothing to decode and to miss.
tinygltf::Model loadModel(nlohmann::json json, const std::string& name) {
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

// tinygltf checks few of the references between objects, so nothing below trusts an index, a size or a
// number.
class Reader {
 public:
  Reader(const tinygltf::Model& model, const File& file, const std::string& name)
      : model_(model), file_(file), name_(name) {}

  Document document() {
    Document document;
    readNodes(document);
    for (size_t i = 0; i < model_.meshes.size(); ++i) document.meshes.push_back(mesh(i));
    for (size_t i = 0; i < model_.skins.size(); ++i) document.skins.push_back(skin(i));
    for (const Node& node : document.nodes) checkSkinning(document, node);
    readClips(document);
    notePictures();
    document.notes = std::move(notes_);
    return document;
  }

 private:
  template <typename... Arguments>
  [[noreturn]] void fail(fmt::format_string<Arguments...> format, Arguments&&... arguments) const {
    throw inputError(name_ + ": " + fmt::format(format, std::forward<Arguments>(arguments)...));
  }

  void checkIndex(int index, size_t count, const std::string& what) const {
    if (index < 0 || static_cast<size_t>(index) >= count) {
      fail("{} is {}, but there are {} of these", what, index, count);
    }
  }

  void checkFinite(const std::vector<double>& values, size_t expected, const std::string& what) const {
    if (!values.empty() && values.size() != expected) {
      fail("{} has {} numbers, expected {}", what, values.size(), expected);
    }
    for (double value : values) {
      if (!std::isfinite(value) || std::fabs(value) > 1e15) fail("{} holds {}", what, value);
    }
  }

  void readTransform(size_t index, Node& to) const {
    const tinygltf::Node& node = model_.nodes[index];
    const std::string what = fmt::format("nodes[{}]", index);
    checkFinite(node.matrix, 16, what + ".matrix");
    checkFinite(node.translation, 3, what + ".translation");
    checkFinite(node.rotation, 4, what + ".rotation");
    checkFinite(node.scale, 3, what + ".scale");
    glm::dmat4& local = to.parentFromNode;
    to.hasMatrix = !node.matrix.empty();
    if (to.hasMatrix) {
      for (int k = 0; k < 16; ++k) local[k / 4][k % 4] = node.matrix[static_cast<size_t>(k)];
      return;
    }
    if (!node.scale.empty()) to.scale = {node.scale[0], node.scale[1], node.scale[2]};
    if (!node.rotation.empty()) {
      const glm::dquat q(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]);
      if (std::fabs(glm::length(q) - 1) > 0.01)
        fail("{}.rotation has length {}, expected 1", what, glm::length(q));
      to.rotation = glm::normalize(q);
      local = glm::mat4_cast(to.rotation);
    }
    for (int k = 0; k < 3; ++k) local[k] *= to.scale[k];
    if (!node.translation.empty()) {
      to.translation = {node.translation[0], node.translation[1], node.translation[2]};
      local[3] = glm::dvec4(to.translation, 1);
    }
  }

  void readNodes(Document& document) const {
    const size_t count = model_.nodes.size();
    document.nodes.resize(count);
    for (size_t i = 0; i < count; ++i) {
      const tinygltf::Node& from = model_.nodes[i];
      Node& node = document.nodes[i];
      node.name = from.name;
      node.mesh = from.mesh;
      node.skin = from.skin;
      if (node.mesh != -1) checkIndex(node.mesh, model_.meshes.size(), fmt::format("nodes[{}].mesh", i));
      if (node.skin != -1) checkIndex(node.skin, model_.skins.size(), fmt::format("nodes[{}].skin", i));
      for (int child : from.children) {
        checkIndex(child, count, fmt::format("a child of nodes[{}]", i));
        int& parent = document.nodes[static_cast<size_t>(child)].parent;
        if (parent != -1) fail("nodes[{}] is a child of nodes[{}] and of nodes[{}]", child, parent, i);
        parent = static_cast<int>(i);
      }
    }
    auto& order = document.parentsFirst;
    for (size_t i = 0; i < count; ++i) {
      if (document.nodes[i].parent == -1) order.push_back(static_cast<int>(i));
    }
    for (size_t k = 0; k < order.size(); ++k) {
      const auto& children = model_.nodes[static_cast<size_t>(order[k])].children;
      order.insert(order.end(), children.begin(), children.end());
    }
    if (order.size() != count) fail("{} nodes are their own ancestors", count - order.size());

    markScene(document);
    for (int i : order) {
      Node& node = document.nodes[static_cast<size_t>(i)];
      readTransform(static_cast<size_t>(i), node);
      node.modelFromNode = node.parentFromNode;
      if (node.parent == -1) continue;
      const Node& parent = document.nodes[static_cast<size_t>(node.parent)];
      node.modelFromNode = parent.modelFromNode * node.modelFromNode;
      node.inScene = node.inScene || parent.inScene;
    }
  }

  void markScene(Document& document) const {
    if (model_.scenes.empty()) {
      for (Node& node : document.nodes) node.inScene = true;
      return;
    }
    const int scene = model_.defaultScene == -1 ? 0 : model_.defaultScene;
    checkIndex(scene, model_.scenes.size(), "scene");
    for (int node : model_.scenes[static_cast<size_t>(scene)].nodes) {
      checkIndex(node, document.nodes.size(), fmt::format("a node of scenes[{}]", scene));
      document.nodes[static_cast<size_t>(node)].inScene = true;
    }
  }

  // `size` bytes of a buffer view from `offset`, whole.
  const uint8_t* view(int index, uint64_t offset, uint64_t size, const std::string& what) const {
    checkIndex(index, model_.bufferViews.size(), what + ".bufferView");
    const tinygltf::BufferView& from = model_.bufferViews[static_cast<size_t>(index)];
    const std::string viewName = fmt::format("bufferViews[{}]", index);
    checkIndex(from.buffer, file_.buffers.size(), viewName + ".buffer");
    const auto& data = file_.buffers[static_cast<size_t>(from.buffer)];
    if (data.empty()) fail("{} is of buffers[{}], which has no data", viewName, from.buffer);
    if (from.byteOffset > data.size() || from.byteLength > data.size() - from.byteOffset) {
      fail("{} reaches past the {} bytes of its buffer", viewName, data.size());
    }
    if (offset > from.byteLength || size > from.byteLength - offset) {
      fail("{} reaches past the {} bytes of {}", what, from.byteLength, viewName);
    }
    return data.data() + from.byteOffset + offset;
  }

  static double component(const uint8_t* at, int type, bool normalized) {
    const auto as = [at](auto value) {
      std::memcpy(&value, at, sizeof(value));
      return value;
    };
    switch (type) {
      case TINYGLTF_COMPONENT_TYPE_BYTE:
        return normalized ? std::max(as(int8_t{}) / 127.0, -1.0) : as(int8_t{});
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return normalized ? *at / 255.0 : *at;
      case TINYGLTF_COMPONENT_TYPE_SHORT:
        return normalized ? std::max(as(int16_t{}) / 32767.0, -1.0) : as(int16_t{});
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return normalized ? as(uint16_t{}) / 65535.0 : as(uint16_t{});
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        return as(uint32_t{});
      default:
        return static_cast<double>(as(float{}));
    }
  }

  struct Values {
    std::vector<double> numbers;
    size_t components = 1, count = 0;
  };

  // All numbers of an accessor whose type has one of the given component counts.
  Values accessor(int index, std::initializer_list<int> types, bool integers, const std::string& use) {
    checkIndex(index, model_.accessors.size(), use);
    const tinygltf::Accessor& from = model_.accessors[static_cast<size_t>(index)];
    const std::string what = fmt::format("accessors[{}] ({})", index, use);
    if (std::find(types.begin(), types.end(), from.type) == types.end()) fail("{} has the wrong type", what);
    const int width = tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(from.componentType));
    const bool isInteger = from.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                           from.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                           from.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    if (width <= 0 || from.componentType == TINYGLTF_COMPONENT_TYPE_DOUBLE ||
        from.componentType == TINYGLTF_COMPONENT_TYPE_INT || (integers && !isInteger) ||
        (from.type == TINYGLTF_TYPE_MAT4 && from.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT)) {
      fail("{} has component type {}, which does not fit", what, from.componentType);
    }
    if (from.count < 1 || from.count > maxElements) {
      fail("{} has {} elements, expected 1 to {}", what, from.count, maxElements);
    }
    Values values;
    values.count = from.count;
    values.components =
        static_cast<size_t>(tinygltf::GetNumComponentsInType(static_cast<uint32_t>(from.type)));
    const size_t size = values.components * static_cast<size_t>(width);
    const uint8_t* data = nullptr;
    size_t stride = size;
    if (from.bufferView != -1) {
      checkIndex(from.bufferView, model_.bufferViews.size(), what + ".bufferView");
      const size_t given = model_.bufferViews[static_cast<size_t>(from.bufferView)].byteStride;
      if (given != 0) stride = given;
      if (stride < size || stride > 252 + size)
        fail("{} has a stride of {}, its elements {} bytes", what, stride, size);
      data = view(from.bufferView, from.byteOffset, stride * (values.count - 1) + size, what);
    } else if (values.count > maxZeros) {
      // Nothing in the file stands behind these elements, so their number is limited apart.
      fail("{} has {} elements without data, expected at most {}", what, values.count, maxZeros);
    }
    numbersRead_ += values.count * values.components;
    if (numbersRead_ > maxNumbers) fail("its accessors are read as over {} numbers in all", maxNumbers);
    values.numbers.resize(values.count * values.components);
    const auto decode = [&](const uint8_t* at, size_t element) {
      for (size_t k = 0; k < values.components; ++k) {
        const double number =
            component(at + k * static_cast<size_t>(width), from.componentType, from.normalized);
        if (!std::isfinite(number)) fail("{} holds {} in element {}", what, number, element);
        values.numbers[element * values.components + k] = number;
      }
    };
    for (size_t i = 0; data && i < values.count; ++i) decode(data + i * stride, i);
    if (from.sparse.isSparse) readSparse(from, what, size, decode, values.count);
    return values;
  }

  template <typename Decode>
  void readSparse(const tinygltf::Accessor& from, const std::string& what, size_t size, const Decode& decode,
                  size_t count) const {
    const auto& sparse = from.sparse;
    const int type = sparse.indices.componentType;
    if (sparse.count < 1 || static_cast<size_t>(sparse.count) > count || sparse.indices.byteOffset < 0 ||
        sparse.values.byteOffset < 0 ||
        (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE && type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
         type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)) {
      fail("{} has malformed sparse values", what);
    }
    const size_t width = static_cast<size_t>(tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(type)));
    const size_t entries = static_cast<size_t>(sparse.count);
    const uint8_t* indices = view(sparse.indices.bufferView, static_cast<uint64_t>(sparse.indices.byteOffset),
                                  entries * width, what + ".sparse.indices");
    const uint8_t* data = view(sparse.values.bufferView, static_cast<uint64_t>(sparse.values.byteOffset),
                               entries * size, what + ".sparse.values");
    for (size_t i = 0; i < entries; ++i) {
      const double element = component(indices + i * width, type, false);
      if (element >= static_cast<double>(count)) fail("{} replaces element {} of {}", what, element, count);
      decode(data + i * size, static_cast<size_t>(element));
    }
  }

  static std::vector<glm::dvec3> toVectors(const Values& values) {
    std::vector<glm::dvec3> vectors(values.count);
    for (size_t i = 0; i < values.count; ++i) {
      const double* at = values.numbers.data() + i * values.components;
      vectors[i] = {at[0], at[1], at[2]};
    }
    return vectors;
  }

  glm::dvec3 baseColour(int material, const std::string& what) const {
    if (material == -1) return glm::dvec3(1);
    checkIndex(material, model_.materials.size(), what + ".material");
    const auto& factor = model_.materials[static_cast<size_t>(material)].pbrMetallicRoughness.baseColorFactor;
    checkFinite(factor, 4, fmt::format("materials[{}].baseColorFactor", material));
    return factor.empty() ? glm::dvec3(1) : glm::dvec3(factor[0], factor[1], factor[2]);
  }

  Mesh mesh(size_t index) {
    Mesh mesh;
    for (size_t k = 0; k < model_.meshes[index].primitives.size(); ++k) {
      const tinygltf::Primitive& from = model_.meshes[index].primitives[k];
      const std::string what = fmt::format("meshes[{}].primitives[{}]", index, k);
      const int mode = from.mode == -1 ? TINYGLTF_MODE_TRIANGLES : from.mode;
      if (mode < TINYGLTF_MODE_POINTS || mode > TINYGLTF_MODE_TRIANGLE_FAN) {
        fail("{} has mode {}, expected 0 to 6", what, mode);
      }
      if (mode < TINYGLTF_MODE_TRIANGLES) {
        notes_.push_back(fmt::format("{} is points or lines (mode {}): left out", what, mode));
        continue;
      }
      if (!from.targets.empty()) notes_.push_back(what + " has morph targets: not applied");
      mesh.primitives.push_back(primitive(from, what));
      for (const Influence& influence : mesh.primitives.back().influences) {
        mesh.highestJoint = std::max(mesh.highestJoint, influence.joint);
      }
    }
    return mesh;
  }

  Primitive primitive(const tinygltf::Primitive& from, const std::string& what) {
    Primitive primitive;
    const auto attribute = [&](const std::string& key, std::initializer_list<int> types, bool integers) {
      Values values;
      if (const auto found = from.attributes.find(key); found != from.attributes.end()) {
        values = accessor(found->second, types, integers, what + "." + key);
        if (key != "POSITION" && values.count != primitive.positions.size()) {
          fail("{}.{} has {} vertices, POSITION {}", what, key, values.count, primitive.positions.size());
        }
      }
      return values;
    };
    primitive.positions = toVectors(attribute("POSITION", {TINYGLTF_TYPE_VEC3}, false));
    const size_t count = primitive.positions.size();
    if (count == 0) fail("{} has no POSITION", what);
    primitive.normals = toVectors(attribute("NORMAL", {TINYGLTF_TYPE_VEC3}, false));
    primitive.colours = toVectors(attribute("COLOR_0", {TINYGLTF_TYPE_VEC3, TINYGLTF_TYPE_VEC4}, false));
    primitive.colours.resize(count, glm::dvec3(1));
    const glm::dvec3 base = baseColour(from.material, what);
    // Both are within 0 to 1 (glTF 2.0 specification, sections 3.7.2.1 and 3.9.2).
    for (glm::dvec3& colour : primitive.colours) colour = glm::clamp(colour * base, 0.0, 1.0);

    std::vector<Values> joints, weights;
    for (int set = 0;; ++set) {
      joints.push_back(attribute(fmt::format("JOINTS_{}", set), {TINYGLTF_TYPE_VEC4}, true));
      weights.push_back(attribute(fmt::format("WEIGHTS_{}", set), {TINYGLTF_TYPE_VEC4}, false));
      if (joints.back().count != weights.back().count)
        fail("{} has JOINTS_{} or WEIGHTS_{} alone", what, set, set);
      if (joints.back().count == 0) break;
      primitive.influencesPerVertex += 4;
    }
    for (size_t vertex = 0; vertex < count; ++vertex) {
      for (size_t k = 0; k < primitive.influencesPerVertex; ++k) {
        const size_t at = 4 * vertex + k % 4;
        const double weight = weights[k / 4].numbers[at];
        if (weight < 0) fail("{} has weight {} at vertex {}", what, weight, vertex);
        primitive.influences.push_back({static_cast<uint32_t>(joints[k / 4].numbers[at]), weight});
      }
    }
    primitive.indices = triangles(from, count, what);
    return primitive;
  }

  std::vector<uint32_t> triangles(const tinygltf::Primitive& from, size_t vertexCount,
                                  const std::string& what) {
    std::vector<uint32_t> indices;
    if (from.indices == -1) {
      indices.resize(vertexCount);
      for (size_t i = 0; i < vertexCount; ++i) indices[i] = static_cast<uint32_t>(i);
    } else {
      const Values values = accessor(from.indices, {TINYGLTF_TYPE_SCALAR}, true, what + ".indices");
      for (double number : values.numbers) {
        if (number >= static_cast<double>(vertexCount)) {
          fail("{}.indices holds {}, but there are {} vertices", what, number, vertexCount);
        }
        indices.push_back(static_cast<uint32_t>(number));
      }
    }
    const int mode = from.mode == -1 ? TINYGLTF_MODE_TRIANGLES : from.mode;
    if (mode == TINYGLTF_MODE_TRIANGLES) {
      if (indices.size() % 3 != 0) fail("{} has {} indices, no multiple of 3", what, indices.size());
      return indices;
    }
    std::vector<uint32_t> list;
    for (size_t i = 0; i + 2 < indices.size(); ++i) {
      if (mode == TINYGLTF_MODE_TRIANGLE_FAN) {
        list.insert(list.end(), {indices[0], indices[i + 1], indices[i + 2]});
      } else {
        list.insert(list.end(), {indices[i], indices[i + 1 + i % 2], indices[i + 2 - i % 2]});
      }
    }
    return list;
  }

  Skin skin(size_t index) {
    const tinygltf::Skin& from = model_.skins[index];
    const std::string what = fmt::format("skins[{}]", index);
    if (from.joints.empty()) fail("{} has no joints", what);
    Skin skin;
    skin.joints = from.joints;
    for (int joint : skin.joints) checkIndex(joint, model_.nodes.size(), "a joint of " + what);
    skin.nodeFromBind.resize(skin.joints.size(), glm::dmat4(1));
    if (from.inverseBindMatrices == -1) return skin;
    const Values values =
        accessor(from.inverseBindMatrices, {TINYGLTF_TYPE_MAT4}, false, what + ".inverseBindMatrices");
    if (values.count < skin.joints.size()) {
      fail("{} has {} inverse bind matrices for {} joints", what, values.count, skin.joints.size());
    }
    for (size_t k = 0; k < skin.joints.size(); ++k) {
      for (size_t e = 0; e < 16; ++e) {
        skin.nodeFromBind[k][static_cast<int>(e / 4)][static_cast<int>(e % 4)] = values.numbers[16 * k + e];
      }
    }
    return skin;
  }

  void checkSkinning(const Document& document, const Node& node) const {
    if (node.mesh == -1 || node.skin == -1) return;
    const size_t joints = document.skins[static_cast<size_t>(node.skin)].joints.size();
    const uint32_t highest = document.meshes[static_cast<size_t>(node.mesh)].highestJoint;
    if (highest >= joints) {
      fail("meshes[{}] uses joint {}, but skins[{}] has {}", node.mesh, highest, node.skin, joints);
    }
  }

  // A fault in a clip costs the clip, not the file: nothing else depends on it.
  void readClips(Document& document) {
    const auto animations = file_.json.find("animations");
    if (animations == file_.json.end()) return;
    if (!animations->is_array() || animations->size() > maxObjects) {
      fail("animations is {}, expected an array of up to {}", describeJson(*animations), maxObjects);
    }
    for (size_t i = 0; i < animations->size(); ++i) {
      const std::string what = fmt::format("animations[{}]", i);
      try {
        document.clips.push_back(clip((*animations)[i], what, document.nodes));
      } catch (const Error& error) {
        notes_.push_back(std::string(error.what()).substr(name_.size() + 2) + ": clip left out");
      } catch (const nlohmann::json::exception&) {
        notes_.push_back(what + " is malformed: clip left out");
      }
    }
  }

  int indexAt(const nlohmann::json& json, const char* key, size_t count, const std::string& what) const {
    const nlohmann::json& index = json.at(key);
    if (!index.is_number_unsigned() || index.get<uint64_t>() >= count) {
      fail("{} is {}, but there are {} of these", what, describeJson(index), count);
    }
    return index.get<int>();
  }

  int accessorAt(const nlohmann::json& sampler, const char* key, const std::string& part) const {
    return indexAt(sampler, key, model_.accessors.size(), part + "." + key);
  }

  Clip clip(const nlohmann::json& json, const std::string& what, const std::vector<Node>& nodes) {
    Clip clip;
    clip.name = json.value("name", std::string());
    const nlohmann::json& samplers = json.at("samplers");
    const nlohmann::json& channels = json.at("channels");
    clip.channelCount = channels.size();
    std::map<std::pair<size_t, std::string>, size_t> samplerOf;  // read once for each path that it drives
    std::map<std::pair<int, Path>, size_t> channelOf;
    std::vector<std::string> notes;
    size_t morphs = 0;
    for (const nlohmann::json& channel : channels) {
      const int index = indexAt(channel, "sampler", samplers.size(), what + " has a channel whose sampler");
      const nlohmann::json& target = channel.at("target");
      int node = -1;
      if (target.contains("node"))
        node = indexAt(target, "node", model_.nodes.size(), what + " targets a node that");
      const std::string path = target.at("path").get<std::string>();
      const auto [known, isNew] =
          samplerOf.try_emplace({static_cast<size_t>(index), path}, clip.samplers.size());
      if (isNew) {
        const nlohmann::json& from = samplers.at(static_cast<size_t>(index));
        clip.samplers.push_back(sampler(from, path, fmt::format("{}.samplers[{}]", what, index)));
        clip.seconds = std::max(clip.seconds, clip.samplers.back().times.back());
      }
      if (path == "weights") {
        ++morphs;
        continue;
      }
      if (node == -1) continue;  // nothing in the file that it moves
      if (nodes[static_cast<size_t>(node)].hasMatrix) {
        notes.push_back(fmt::format("{} moves nodes[{}], which has a matrix: not moved", what, node));
        continue;
      }
      const auto [place, first] =
          channelOf.try_emplace({node, clip.samplers[known->second].path}, clip.moving.size());
      if (first) {
        clip.moving.push_back({node, known->second});
        continue;
      }
      clip.moving[place->second].sampler = known->second;
      notes.push_back(
          fmt::format("{} has two channels of the {} of nodes[{}]: the later counts", what, path, node));
    }
    if (morphs > 0)
      notes.push_back(fmt::format("{} has {} channels of morph weights: left out", what, morphs));
    // One line a clip: a file may have very many channels.
    if (notes.size() > 1) notes[0] += fmt::format(", and {} more like it", notes.size() - 1);
    if (!notes.empty()) notes_.push_back(notes[0]);
    return clip;
  }

  Sampler sampler(const nlohmann::json& from, const std::string& path, const std::string& part) {
    Sampler sampler;
    Values times = accessor(accessorAt(from, "input", part), {TINYGLTF_TYPE_SCALAR}, false, part + ".input");
    for (size_t k = 0; k < times.count; ++k) {
      if (times.numbers[k] < 0 || (k > 0 && times.numbers[k] <= times.numbers[k - 1])) {
        fail("{} has the time {} at key {}, expected times that rise from 0", part, times.numbers[k], k);
      }
    }
    sampler.times = std::move(times.numbers);
    const std::string interpolation = from.value("interpolation", std::string("LINEAR"));
    if (interpolation == "STEP") {
      sampler.interpolation = Interpolation::step;
    } else if (interpolation == "CUBICSPLINE") {
      sampler.interpolation = Interpolation::cubicSpline;
    } else if (interpolation != "LINEAR") {
      fail("{}.interpolation is {}, expected STEP, LINEAR or CUBICSPLINE", part,
           describeJson(from.at("interpolation")));
    }
    const int output = accessorAt(from, "output", part);
    if (path == "weights") {
      accessor(output, {TINYGLTF_TYPE_SCALAR}, false, part + ".output");
      return sampler;
    }
    if (path == "rotation") {
      sampler.path = Path::rotation;
    } else if (path == "scale") {
      sampler.path = Path::scale;
    } else if (path != "translation") {
      fail("{} drives {}, expected translation, rotation, scale or weights", part, describeJson(path));
    }
    const bool turns = sampler.path == Path::rotation;
    Values values =
        accessor(output, {turns ? TINYGLTF_TYPE_VEC4 : TINYGLTF_TYPE_VEC3}, false, part + ".output");
    const size_t each = sampler.interpolation == Interpolation::cubicSpline ? 3 : 1;
    if (values.count != each * sampler.times.size()) {
      fail("{} has {} outputs for {} keys, expected {}", part, values.count, sampler.times.size(),
           each * sampler.times.size());
    }
    sampler.values = std::move(values.numbers);
    for (size_t k = 0; turns && k < sampler.times.size(); ++k) {
      double* key = sampler.values.data() + 4 * (each == 3 ? 3 * k + 1 : k);
      const double length = std::sqrt(key[0] * key[0] + key[1] * key[1] + key[2] * key[2] + key[3] * key[3]);
      if (!(std::fabs(length - 1) <= 0.1)) {
        fail("{} has a rotation of length {} at key {}, expected 1", part, length, k);
      }
      for (int i = 0; each == 1 && i < 4; ++i) key[i] /= length;
    }
    return sampler;
  }

  void notePictures() {
    const auto images = file_.json.find("images");
    if (images != file_.json.end() && images->is_array() && !images->empty()) {
      notes_.push_back(fmt::format(
          "{} pictures are not read: colour is COLOR_0 times the material's base colour", images->size()));
    }
  }

  const tinygltf::Model& model_;
  const File& file_;
  const std::string& name_;
  std::vector<std::string> notes_;
  size_t numbersRead_ = 0;
};

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
    refuseUnsupported(file.json, name);
    checkLists(file.json, name);
    const tinygltf::Model model = loadModel(file.json, name);
    Document document = Reader(model, file, name).document();
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
