#include "glb_builder.h"

#include <cstring>
#include <map>
#include <stdexcept>

#include "files.h"

namespace skitter::test {
namespace {

void appendBytes(std::vector<uint8_t>& to, const void* from, size_t size) {
  const auto* bytes = static_cast<const uint8_t*>(from);
  to.insert(to.end(), bytes, bytes + size);
}

void appendWord(std::vector<uint8_t>& to, size_t word) {
  const auto narrow = static_cast<uint32_t>(word);
  appendBytes(to, &narrow, 4);
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
  appendBytes(bytes, "JSON", 4);
  appendBytes(bytes, text.data(), text.size());
  appendWord(bytes, padded.size());
  appendBytes(bytes, "BIN\0", 4);
  appendBytes(bytes, padded.data(), padded.size());
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

size_t Glb::append(std::span<const std::byte> bytes, int component, const std::string& type, size_t numbers) {
  const std::map<std::string, size_t> widths = {
      {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}};
  binary.resize((binary.size() + 3) / 4 * 4);
  json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", bytes.size()}});
  appendBytes(binary, bytes.data(), bytes.size());
  json["buffers"][0]["byteLength"] = binary.size();
  json["accessors"].push_back({{"bufferView", json["bufferViews"].size() - 1},
                               {"componentType", component},
                               {"count", numbers / widths.at(type)},
                               {"type", type}});
  return json["accessors"].size() - 1;
}

void Glb::animate(size_t node, const std::string& path, const std::string& interpolation,
                  const std::vector<float>& times, const std::vector<float>& values) {
  auto& clips = json["animations"];
  if (clips.empty()) clips.push_back({{"name", "clip"}});
  const size_t input = append(times, "SCALAR");
  const size_t output = append(values, path == "rotation" ? "VEC4" : "VEC3");
  auto& clip = clips.back();
  clip["channels"].push_back(
      {{"sampler", clip["samplers"].size()}, {"target", {{"node", node}, {"path", path}}}});
  clip["samplers"].push_back({{"input", input}, {"output", output}, {"interpolation", interpolation}});
}

void Glb::write(const std::filesystem::path& file) const {
  if (file.extension() == ".glb") return writeBytes(file, bytes());
  const std::filesystem::path buffer = std::filesystem::path(file).replace_extension(".bin");
  nlohmann::json text = json;
  text["buffers"][0]["uri"] = buffer.filename().string();
  writeText(file, text.dump());
  writeBytes(buffer, binary);
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
  appendBytes(glb.binary, positions, sizeof(positions));
  appendBytes(glb.binary, joints, sizeof(joints));
  appendBytes(glb.binary, weights, sizeof(weights));
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
