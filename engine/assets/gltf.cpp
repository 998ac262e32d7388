#include "gltf.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <glm/gtc/quaternion.hpp>
#include <new>

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

uint32_t readWord(std::span<const uint8_t> bytes, size_t offset) {
  return static_cast<uint32_t>(bytes[offset]) | static_cast<uint32_t>(bytes[offset + 1]) << 8 |
         static_cast<uint32_t>(bytes[offset + 2]) << 16 | static_cast<uint32_t>(bytes[offset + 3]) << 24;
}

// The chunks of a binary file (glTF 2.0 specification, section 4.4).
struct Chunks {
  std::string_view json;
  std::span<const uint8_t> binary;
};

Chunks splitChunks(std::span<const uint8_t> glb, const std::string& name) {
  constexpr uint32_t jsonType = 0x4e4f534a, binaryType = 0x004e4942;
  if (glb.size() < 4 || std::memcmp(glb.data(), "glTF", 4) != 0) {
    throw inputError(fmt::format("{}: is not a glTF binary (.glb): wrong signature", name));
  }
  if (glb.size() < 20)
    throw inputError(fmt::format("{}: ends after {} bytes, within its header", name, glb.size()));
  if (readWord(glb, 4) != 2) {
    throw inputError(fmt::format("{}: is glTF binary version {}, expected 2", name, readWord(glb, 4)));
  }
  const size_t length = readWord(glb, 8);
  if (length < 20 || length > glb.size()) {
    throw inputError(fmt::format("{}: its header says {} bytes, the file has {}", name, length, glb.size()));
  }
  Chunks chunks;
  for (size_t offset = 12; offset < length;) {
    if (length - offset < 8) throw inputError(fmt::format("{}: ends within a chunk header", name));
    const size_t size = readWord(glb, offset);
    const uint32_t type = readWord(glb, offset + 4);
    const bool first = offset == 12;
    offset += 8;
    if (size > length - offset) {
      throw inputError(fmt::format("{}: a chunk of {} bytes has only {} left", name, size, length - offset));
    }
    if (first != (type == jsonType)) {
      throw inputError(fmt::format("{}: its first chunk, and only that, must be JSON", name));
    }
    if (first) chunks.json = {reinterpret_cast<const char*>(glb.data()) + offset, size};
    if (type == binaryType && chunks.binary.empty()) chunks.binary = glb.subspan(offset, size);
    offset += size;
  }
  return chunks;
}

void refuseUnsupported(const nlohmann::json& json, const std::string& name) {
  if (!json.is_object()) throw inputError(fmt::format("{}: its JSON is not an object", name));
  if (const auto required = json.find("extensionsRequired"); required != json.end()) {
    for (const auto& entry : *required) {
      const std::string extension = entry.is_string() ? entry.get<std::string>() : describeJson(entry);
      // These change how a surface looks or how numbers are packed, both of which are taken as they come.
      if (extension.rfind("KHR_materials_", 0) != 0 && extension.rfind("KHR_texture_", 0) != 0 &&
          extension != "KHR_mesh_quantization") {
        throw inputError(fmt::format("{}: requires extension {}, which is not supported", name, extension));
      }
    }
  }
  const auto buffers = json.find("buffers");
  if (buffers == json.end() || !buffers->is_array()) return;
  for (size_t i = 0; i < buffers->size(); ++i) {
    const auto& buffer = (*buffers)[i];
    const auto uri = buffer.is_object() ? buffer.find("uri") : buffer.end();
    if (!buffer.is_object() || uri == buffer.end()) {
      if (i > 0) throw inputError(fmt::format("{}: buffers[{}] has no data", name, i));
    } else if (!uri->is_string() || uri->get_ref<const std::string&>().rfind("data:", 0) != 0) {
      throw inputError(fmt::format("{}: buffers[{}] refers to {}, expected everything in one file", name, i,
                                   describeJson(*uri)));
    }
  }
}

void appendWord(std::vector<uint8_t>& bytes, size_t word) {
  for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<uint8_t>(word >> shift));
}

tinygltf::Model loadModel(nlohmann::json json, std::span<const uint8_t> binary, const std::string& name) {
  // Without pictures and motion, which a rig does not hold: there is then nothing to decode and nothing to
  // miss.
  for (const char* key : {"images", "textures", "samplers", "animations", "cameras", "extensions"})
    json.erase(key);
  std::string text = json.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::vector<uint8_t> glb{'g', 'l', 'T', 'F'};
  const size_t binarySize = (binary.size() + 3) / 4 * 4;
  const size_t total = 20 + text.size() + (binarySize ? 8 + binarySize : 0);
  glb.reserve(total);
  appendWord(glb, 2);
  appendWord(glb, total);
  appendWord(glb, text.size());
  appendWord(glb, 0x4e4f534a);
  glb.insert(glb.end(), text.begin(), text.end());
  if (binarySize) {
    appendWord(glb, binarySize);
    appendWord(glb, 0x004e4942);
    glb.insert(glb.end(), binary.begin(), binary.end());
    glb.resize(total, 0);
  }

  tinygltf::TinyGLTF loader;
  tinygltf::Model model;
  std::string error, warning;
  // The error string is filled on success too, so the return value decides.
  if (!loader.LoadBinaryFromMemory(&model, &error, &warning, glb.data(), static_cast<unsigned>(glb.size()))) {
    for (char& c : error) c = c == '\n' || c == '\r' ? ' ' : c;
    while (!error.empty() && error.back() == ' ') error.pop_back();
    throw inputError(fmt::format("{}: is not valid glTF: {}", name, error));
  }
  return model;
}

// tinygltf checks few of the references between objects, so nothing below trusts an index, a size or a
// number.
class Reader {
 public:
  Reader(const tinygltf::Model& model, const std::string& name) : model_(model), name_(name) {}

  Document document() const {
    Document document;
    readNodes(document);
    for (size_t i = 0; i < model_.meshes.size(); ++i) document.meshes.push_back(mesh(i));
    for (size_t i = 0; i < model_.skins.size(); ++i) document.skins.push_back(skin(i));
    for (const Node& node : document.nodes) checkSkinning(document, node);
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

  glm::dmat4 localTransform(size_t index) const {
    const tinygltf::Node& node = model_.nodes[index];
    const std::string what = fmt::format("nodes[{}]", index);
    checkFinite(node.matrix, 16, what + ".matrix");
    checkFinite(node.translation, 3, what + ".translation");
    checkFinite(node.rotation, 4, what + ".rotation");
    checkFinite(node.scale, 3, what + ".scale");
    glm::dmat4 local(1);
    if (!node.matrix.empty()) {
      for (int k = 0; k < 16; ++k) local[k / 4][k % 4] = node.matrix[static_cast<size_t>(k)];
      return local;
    }
    glm::dvec3 scale(1);
    if (!node.scale.empty()) scale = {node.scale[0], node.scale[1], node.scale[2]};
    if (!node.rotation.empty()) {
      const glm::dquat q(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]);
      if (std::fabs(glm::length(q) - 1) > 0.01)
        fail("{}.rotation has length {}, expected 1", what, glm::length(q));
      local = glm::mat4_cast(glm::normalize(q));
    }
    for (int k = 0; k < 3; ++k) local[k] *= scale[k];
    if (!node.translation.empty()) {
      local[3] = glm::dvec4(node.translation[0], node.translation[1], node.translation[2], 1);
    }
    return local;
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
      node.modelFromNode = localTransform(static_cast<size_t>(i));
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
    checkIndex(from.buffer, model_.buffers.size(), viewName + ".buffer");
    const auto& data = model_.buffers[static_cast<size_t>(from.buffer)].data;
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
  Values accessor(int index, std::initializer_list<int> types, bool integers, const std::string& use) const {
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
    values.numbers.resize(values.count * values.components);
    const size_t size = values.components * static_cast<size_t>(width);
    const auto decode = [&](const uint8_t* at, size_t element) {
      for (size_t k = 0; k < values.components; ++k) {
        const double number =
            component(at + k * static_cast<size_t>(width), from.componentType, from.normalized);
        if (!std::isfinite(number)) fail("{} holds {} in element {}", what, number, element);
        values.numbers[element * values.components + k] = number;
      }
    };
    if (from.bufferView != -1) {
      checkIndex(from.bufferView, model_.bufferViews.size(), what + ".bufferView");
      size_t stride = model_.bufferViews[static_cast<size_t>(from.bufferView)].byteStride;
      if (stride == 0) stride = size;
      if (stride < size || stride > 252 + size)
        fail("{} has a stride of {}, its elements {} bytes", what, stride, size);
      const uint8_t* data = view(from.bufferView, from.byteOffset, stride * (values.count - 1) + size, what);
      for (size_t i = 0; i < values.count; ++i) decode(data + i * stride, i);
    }
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

  Mesh mesh(size_t index) const {
    Mesh mesh;
    for (size_t k = 0; k < model_.meshes[index].primitives.size(); ++k) {
      mesh.primitives.push_back(
          primitive(model_.meshes[index].primitives[k], fmt::format("meshes[{}].primitives[{}]", index, k)));
    }
    return mesh;
  }

  Primitive primitive(const tinygltf::Primitive& from, const std::string& what) const {
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
    for (glm::dvec3& colour : primitive.colours) colour = glm::max(colour * base, 0.0);

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
                                  const std::string& what) const {
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
    if (mode != TINYGLTF_MODE_TRIANGLE_STRIP && mode != TINYGLTF_MODE_TRIANGLE_FAN) {
      fail("{} has mode {}, expected triangles (4, 5 or 6)", what, mode);
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

  Skin skin(size_t index) const {
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
    for (const Primitive& part : document.meshes[static_cast<size_t>(node.mesh)].primitives) {
      for (const Influence& influence : part.influences) {
        if (influence.joint >= joints) {
          fail("meshes[{}] uses joint {}, but skins[{}] has {}", node.mesh, influence.joint, node.skin,
               joints);
        }
      }
    }
  }

  const tinygltf::Model& model_;
  const std::string& name_;
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

Document parse(std::span<const uint8_t> glb, const std::string& name) {
  try {
    const Chunks chunks = splitChunks(glb, name);
    const nlohmann::json json = parseJson(chunks.json, name);
    refuseUnsupported(json, name);
    const tinygltf::Model model = loadModel(json, chunks.binary, name);
    Document document = Reader(model, name).document();
    document.extras = findExtras(json);
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
