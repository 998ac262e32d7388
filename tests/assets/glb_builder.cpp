#include "glb_builder.h"

#include <cstring>
#include <stdexcept>

#include "files.h"

namespace skitter::test {
namespace {

void append(std::vector<uint8_t>& to, const void* from, size_t size) {
  const auto* bytes = static_cast<const uint8_t*>(from);
  to.insert(to.end(), bytes, bytes + size);
}

void appendWord(std::vector<uint8_t>& to, size_t word) {
  const auto narrow = static_cast<uint32_t>(word);
  append(to, &narrow, 4);
}

}  // namespace

std::vector<uint8_t> Glb::bytes() const {
  std::string text = json.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::vector<uint8_t> padded = binary;
  padded.resize((padded.size() + 3) / 4 * 4);
  std::vector<uint8_t> bytes{'g', 'l', 'T', 'F'};
  appendWord(bytes, 2);
  appendWord(bytes, 12 + 8 + text.size() + 8 + padded.size());
  appendWord(bytes, text.size());
  append(bytes, "JSON", 4);
  append(bytes, text.data(), text.size());
  appendWord(bytes, padded.size());
  append(bytes, "BIN\0", 4);
  append(bytes, padded.data(), padded.size());
  return bytes;
}

nlohmann::json& Glb::node(const std::string& name) {
  for (auto& node : json["nodes"]) {
    if (node.value("name", "") == name) return node;
  }
  throw std::runtime_error("no node " + name);
}

uint8_t* Glb::data(const nlohmann::json& accessor) {
  const size_t view = json["accessors"][accessor.get<size_t>()]["bufferView"].get<size_t>();
  return binary.data() + json["bufferViews"][view].value("byteOffset", size_t{0});
}

Glb readGlb(const std::filesystem::path& file) {
  const std::vector<uint8_t> bytes = readBytes(file);
  uint32_t length = 0;
  std::memcpy(&length, bytes.data() + 12, 4);
  Glb glb;
  glb.json = nlohmann::json::parse(bytes.begin() + 20, bytes.begin() + 20 + length);
  glb.binary.assign(bytes.begin() + 28 + length, bytes.end());
  return glb;
}

Glb smallestRig() {
  Glb glb;
  const float positions[] = {0, 1, 0, 1, 1, 0, 1, 0, 0};
  const uint8_t joints[] = {0, 1, 0, 0, 1, 2, 0, 0, 2, 3, 0, 0};
  const float weights[] = {0.5f, 0.5f, 0, 0, 0.25f, 0.75f, 0, 0, 0.5f, 0.5f, 0, 0};
  append(glb.binary, positions, sizeof(positions));
  append(glb.binary, joints, sizeof(joints));
  append(glb.binary, weights, sizeof(weights));
  glb.json = nlohmann::json::parse(R"({
    "asset": {"version": "2.0"},
    "scenes": [{"nodes": [0, 1], "extras": {"skitter": {
      "groups": ["A"], "bodyHeight": 1, "bodyRadius": 0.5,
      "legs": [{"name": "leg", "group": "A", "joints": ["hip", "knee", "foot"]}]}}}],
    "nodes": [
      {"mesh": 0, "skin": 0},
      {"name": "body", "translation": [0, 1, 0], "children": [2]},
      {"name": "hip", "children": [3]},
      {"name": "knee", "translation": [1, 0, 0], "children": [4]},
      {"name": "foot", "translation": [0, -1, 0]}],
    "skins": [{"joints": [1, 2, 3, 4]}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "JOINTS_0": 1, "WEIGHTS_0": 2}}]}],
    "accessors": [
      {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
      {"bufferView": 1, "componentType": 5121, "count": 3, "type": "VEC4"},
      {"bufferView": 2, "componentType": 5126, "count": 3, "type": "VEC4"}],
    "bufferViews": [
      {"buffer": 0, "byteOffset": 0, "byteLength": 36},
      {"buffer": 0, "byteOffset": 36, "byteLength": 12},
      {"buffer": 0, "byteOffset": 48, "byteLength": 48}],
    "buffers": [{"byteLength": 96}]
  })");
  return glb;
}

}  // namespace skitter::test
