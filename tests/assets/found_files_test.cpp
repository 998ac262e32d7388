// glTF as exporters and public models have it, though the format allows less: each file loads and says what
// is odd, or one line says what is wrong and the way out.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>

#include "files.h"
#include "glb_builder.h"
#include "skitter/clip.h"
#include "skitter/rig_setup.h"

namespace skitter {
namespace {

using test::Glb;
using test::inputFault;
using Json = nlohmann::json;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

class FoundFiles : public ::testing::Test {
 protected:
  Model load(const Glb& glb, const char* name = "found.glb") {
    glb.write(folder_ / name);
    return loadModel(folder_ / name);
  }
  ClipSet clips(const Glb& glb) {
    glb.write(folder_ / "found.glb");
    return loadClips(folder_ / "found.glb", loadRig(folder_ / "found.glb"));
  }
  // The notes of the model and of its clips, in one text.
  static std::string all(const std::vector<std::string>& notes) {
    std::string text;
    for (const std::string& note : notes) text += note + "\n";
    return text;
  }
  std::string notes(const Glb& glb, const char* name = "found.glb") { return all(load(glb, name).notes); }
  std::string refusal(const Glb& glb) {
    return inputFault([&] { load(glb); });
  }

  test::TemporaryFolder folder_;
};

#define EXPECT_SAYS(text, part) EXPECT_PRED2(says, text, std::string(part))
bool says(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

// The knee goes from 1 to 2 in a second.
void swingKnee(Glb& glb, std::vector<float> times = {0, 1}, std::vector<float> values = {1, 0, 0, 2, 0, 0}) {
  glb.animate(3, "translation", "LINEAR", times, values);
}
Json& lastChannel(Glb& glb) { return glb.json["animations"][0]["channels"].back(); }

// Where the foot is at the clip's first and last frame.
std::pair<float, float> footX(const ClipSet& set) {
  EXPECT_EQ(set.clips.size(), 1u);
  if (set.clips.empty()) return {};
  return {set.clips[0].feet.front().x, set.clips[0].feet.back().x};
}

TEST_F(FoundFiles, ChannelsByPointerLeaveTheirClipAlone) {
  Glb glb = test::smallestRig();
  swingKnee(glb);
  const float still = footX(clips(glb)).second;
  glb.animate(3, "scale", "LINEAR", {0, 3}, {1, 1, 1, 1, 1, 1});
  const auto point = [&](const char* pointer) {
    lastChannel(glb)["target"] = {{"path", "pointer"},
                                  {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}};
  };
  point("/materials/0/pbrMetallicRoughness/baseColorFactor");
  glb.json["extensionsRequired"] = glb.json["extensionsUsed"] = {"KHR_animation_pointer"};
  EXPECT_SAYS(notes(glb),
              "animations[0] drives \"/materials/0/pbrMetallicRoughness/baseColorFactor\", which is "
              "not played: channel left out");
  const ClipSet set = clips(glb);
  EXPECT_EQ(footX(set).second, still);
  EXPECT_EQ(set.clips[0].seconds, 3);  // as of other channels that are not played
  point("/nodes/3/weights");
  EXPECT_SAYS(notes(glb), "animations[0] has 1 channels of morph weights: left out");
  for (const char* odd :
       {"/nodes/77/scale", "/nodes/x/scale", "/nodes//scale", "/nodes/3", "", "/nodes/3/colour"}) {
    point(odd);
    EXPECT_SAYS(notes(glb), "which is not played: channel left out");
    EXPECT_EQ(footX(clips(glb)).second, still) << odd;
  }
  lastChannel(glb)["target"] = {{"path", "visible"}, {"node", 3}};
  EXPECT_SAYS(notes(glb), "animations[0] drives \"visible\", which is not played: channel left out");
  EXPECT_EQ(footX(clips(glb)).second, still);
}

TEST_F(FoundFiles, AFaultyChannelLeavesItsClipAlone) {
  Glb glb = test::smallestRig();
  swingKnee(glb);
  const auto expected = footX(clips(glb));
  glb.animate(4, "translation", "LINEAR", {0, 1}, {0, -1, 0, 0, -2, 0});
  lastChannel(glb)["target"]["node"] = -1;
  EXPECT_EQ(notes(glb),
            "animations[0] targets a node that is -1, but there are 5 of these: channel left out\n");
  EXPECT_EQ(footX(clips(glb)), expected);
  lastChannel(glb)["target"]["node"] = 4;
  glb.json["animations"][0]["samplers"][1]["output"] = 999;
  EXPECT_SAYS(notes(glb),
              "animations[0].samplers[1].output is 999, but there are 7 of these: channel left out");
  EXPECT_EQ(footX(clips(glb)), expected);
  glb.json["animations"][0]["samplers"][0]["output"] = 999;
  EXPECT_SAYS(notes(glb), "animations[0].samplers[0].output is 999, but there are 7 of these: clip left out");
  EXPECT_TRUE(load(glb).clips.empty());
}

TEST_F(FoundFiles, APointerToANodeIsPlayed) {
  Glb glb = test::smallestRig();
  swingKnee(glb);
  const auto expected = footX(clips(glb));
  lastChannel(glb)["target"] = {
      {"path", "pointer"},
      {"extensions", {{"KHR_animation_pointer", {{"pointer", "/nodes/3/translation"}}}}}};
  EXPECT_EQ(footX(clips(glb)), expected);
  EXPECT_EQ(notes(glb), "");
}

TEST_F(FoundFiles, KeysAtOneTimeAreOne) {
  Glb glb = test::smallestRig();
  swingKnee(glb, {0, 0, 1}, {7, 0, 0, 1, 0, 0, 2, 0, 0});
  EXPECT_SAYS(notes(glb), "animations[0].samplers[0] has 1 keys at the time of a later one: left out");
  const ClipSet found = clips(glb);
  Glb sound = test::smallestRig();
  swingKnee(sound);
  EXPECT_EQ(footX(found), footX(clips(sound)));
}

TEST_F(FoundFiles, KeysOutOfOrderAreSorted) {
  Glb glb = test::smallestRig();
  swingKnee(glb, {1, 0}, {2, 0, 0, 1, 0, 0});
  EXPECT_SAYS(notes(glb), "animations[0].samplers[0] has keys out of order: sorted by time");
  const ClipSet found = clips(glb);
  Glb sound = test::smallestRig();
  swingKnee(sound);
  EXPECT_EQ(footX(found), footX(clips(sound)));
}

TEST_F(FoundFiles, AClipThatBeginsBeforeZeroIsMovedAsAWhole) {
  Glb glb = test::smallestRig();
  swingKnee(glb, {-0.25f, 0.75f});
  glb.animate(4, "translation", "LINEAR", {0, 0.5f}, {0, -1, 0, 0, -2, 0});
  EXPECT_SAYS(notes(glb), "animations[0] begins at -0.25 s: moved to begin at 0");
  const ClipSet found = clips(glb);
  Glb sound = test::smallestRig();
  swingKnee(sound);
  sound.animate(4, "translation", "LINEAR", {0.25f, 0.75f}, {0, -1, 0, 0, -2, 0});
  const ClipSet expected = clips(sound);
  ASSERT_EQ(found.clips.size(), 1u);
  EXPECT_EQ(found.clips[0].seconds, 1);
  EXPECT_EQ(found.clips[0].times, expected.clips[0].times);
  EXPECT_EQ(found.clips[0].feet, expected.clips[0].feet);
}

TEST_F(FoundFiles, KeysWithoutNumbersAreLeftOut) {
  Glb glb = test::smallestRig();
  swingKnee(glb, {0, 0.5f, nan, 1}, {1, 0, 0, nan, 0, 0, 9, 9, 9, 2, 0, 0});
  EXPECT_SAYS(notes(glb), "animations[0].samplers[0] has 2 keys that hold what is no number: left out");
  const ClipSet found = clips(glb);
  Glb sound = test::smallestRig();
  swingKnee(sound);
  EXPECT_EQ(footX(found), footX(clips(sound)));

  glb.animate(4, "translation", "LINEAR", {0, 1}, {nan, nan, nan, nan, nan, nan});
  EXPECT_SAYS(notes(glb), "animations[0].samplers[1] has no keys: its channels are left out");
  EXPECT_EQ(footX(clips(glb)), footX(found));
  Glb none = test::smallestRig();
  swingKnee(none);
  none.animate(4, "translation", "LINEAR", {0}, {0, -1, 0});
  for (Json& accessor : none.json["accessors"])
    if (accessor["count"] == 1) accessor["count"] = 0;
  EXPECT_SAYS(notes(none), "animations[0].samplers[1] has no keys: its channels are left out");
  EXPECT_EQ(footX(clips(none)), footX(found));
}

// A quarter turn about Z, in keys of length 1, 3 and 0.
TEST_F(FoundFiles, RotationKeysNeedNotHaveTheLengthOne) {
  const float s = std::sqrt(0.5f);
  const auto turned = [&](const char* how, std::vector<float> times, std::vector<float> values) {
    Glb glb = test::smallestRig();
    glb.animate(3, "rotation", how, times, values);
    return glb;
  };
  const Glb sound = turned("LINEAR", {0, 1}, {0, 0, 0, 1, 0, 0, s, s});
  const ClipSet expected = clips(sound);
  EXPECT_EQ(notes(sound), "");
  const Glb scaled = turned("LINEAR", {0, 1}, {0, 0, 0, 1, 0, 0, 3 * s, 3 * s});
  EXPECT_SAYS(notes(scaled), "has 1 keys of a rotation that has not the length 1: scaled to it");
  const ClipSet found = clips(scaled);
  ASSERT_EQ(found.clips.size(), 1u);
  EXPECT_NEAR(found.clips[0].feet.back().x, expected.clips[0].feet.back().x, 1e-6);
  const Glb zero = turned("LINEAR", {0, 0.5f, 1}, {0, 0, 0, 1, 0, 0, 0, 0, 0, 0, s, s});
  EXPECT_SAYS(notes(zero), "has 1 keys of a rotation of length 0: left out");
  EXPECT_NEAR(footX(clips(zero)).second, footX(expected).second, 1e-6);
  const std::vector<float> flat = {0, 0, 0, 0, 0, 0, 0,     5,     0, 0, 0, 0,
                                   0, 0, 0, 0, 0, 0, 5 * s, 5 * s, 0, 0, 0, 0};
  const Glb spline = turned("CUBICSPLINE", {0, 1}, flat);
  EXPECT_SAYS(notes(spline), "has 2 keys of a rotation that has not the length 1: scaled to it");
  EXPECT_NEAR(footX(clips(spline)).second, footX(expected).second, 1e-6);
}

TEST_F(FoundFiles, NodesWithoutNumbersRestAsIfTheyWereNotThere) {
  const Model sound = load(test::smallestRig());
  for (const auto& [key, value] : std::initializer_list<std::pair<const char*, Json>>{
           {"rotation", {nullptr, nullptr, nullptr, nullptr}},
           {"rotation", {0, 0, 0, 0}},
           {"rotation", nullptr},
           {"rotation", {0, "NaN", 0, 1}},
           {"scale", {nullptr, nullptr, nullptr}},
           {"matrix", {1, 0, 0, 0, 0, nullptr, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}}) {
    Glb glb = test::smallestRig();
    glb.node("knee")[key] = value;
    const Model model = load(glb);
    ASSERT_EQ(model.notes.size(), 1u) << all(model.notes);
    EXPECT_SAYS(model.notes[0], std::string("nodes[3] (\"knee\").") + key);
    for (size_t n = 0; n < model.nodes.size(); ++n)
      EXPECT_EQ(model.nodes[n].modelFromNode, sound.nodes[n].modelFromNode) << value;
  }
  Glb glb = test::smallestRig();
  for (const char* name : {"hip", "knee", "foot"}) glb.node(name)["rotation"] = {0, 0, 0, 0};
  EXPECT_EQ(notes(glb),
            "nodes[2] (\"hip\").rotation has length 0, expected 1: not turned, and 2 more like it\n");
}

TEST_F(FoundFiles, AScaleOfZeroIsNamed) {
  Glb glb = test::smallestRig();
  glb.json["nodes"].push_back({{"name", "hidden"}, {"scale", {1, 0, 1}}});
  EXPECT_EQ(notes(glb), "nodes[5] (\"hidden\").scale holds 0: what it moves has no size\n");
}

TEST_F(FoundFiles, RotationsAreScaledToOne) {
  Glb glb = test::smallestRig();
  glb.node("knee")["rotation"] = {0, 0, 0.5, 0.5};
  const Model model = load(glb);
  EXPECT_SAYS(all(model.notes), "nodes[3] (\"knee\").rotation has length 0.707, expected 1: scaled to it");
  glb.node("knee")["rotation"] = {0, 0, std::sqrt(0.5), std::sqrt(0.5)};
  const Model sound = load(glb);
  EXPECT_TRUE(sound.notes.empty());
  EXPECT_LT(glm::distance(model.nodes[4].position(), sound.nodes[4].position()), 1e-9);
}

TEST_F(FoundFiles, ExtensionsThatShowOrDescribeAreNotNeeded) {
  for (const auto& [extension, lost] : std::initializer_list<std::pair<const char*, const char*>>{
           {"KHR_lights_punctual", "its lights are left out"},
           {"KHR_xmp_json_ld", "it says who made the file"},
           {"EXT_texture_webp", "only PNG and JPEG are drawn"},
           {"KHR_texture_basisu", "only PNG and JPEG are drawn"},
           {"KHR_materials_unlit", "its surfaces look plainer"},
           {"KHR_materials_pbrSpecularGlossiness", "its surfaces look plainer"},
           {"VRMC_vrm", "what it describes is left out"},
           {"MSFT_lod", "the finest level is drawn"},
           {"EXT_mesh_gpu_instancing", "each mesh is placed once"}}) {
    Glb glb = test::smallestRig();
    glb.json["extensionsRequired"] = glb.json["extensionsUsed"] = {extension};
    EXPECT_EQ(notes(glb),
              std::string("requires extension \"") + extension + "\", which is not read: " + lost + "\n");
  }
  Glb glb = test::smallestRig();
  glb.json["extensionsRequired"] = {"KHR_mesh_quantization", "KHR_texture_transform"};
  glb.json["extensionsRequired"].push_back("KHR_lights_punctual");
  // What is malformed in an extension that is not read refuses no file.
  glb.node("foot")["extensions"] = {{"KHR_lights_punctual", {{"light", "none"}}}};
  EXPECT_EQ(load(glb).notes.size(), 1u);
  glb.json["extensionsRequired"].push_back("ACME_shapes");
  EXPECT_SAYS(refusal(glb), "requires extension \"ACME_shapes\", which is not supported: export it without");
}

TEST_F(FoundFiles, PackedMeshesAreToldHowToUnpack) {
  const std::string wayOut = "which is not read: `gltf-transform cp IN OUT` writes it unpacked";
  for (const char* packer :
       {"KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression"}) {
    Glb glb = test::smallestRig();
    glb.json["extensionsRequired"] = {packer};
    EXPECT_SAYS(refusal(glb), std::string("is packed by ") + packer + ", " + wayOut);
  }
  // Not marked as required, but nothing else has the data.
  Glb draco = test::smallestRig();
  draco.json["meshes"][0]["primitives"][0]["extensions"] = {
      {"KHR_draco_mesh_compression", {{"bufferView", 0}}}};
  EXPECT_EQ(notes(draco), "");
  draco.json["accessors"][0].erase("bufferView");
  EXPECT_SAYS(refusal(draco), "meshes[0].primitives[0] is packed by KHR_draco_mesh_compression, " + wayOut);
  Glb meshopt = test::smallestRig();
  meshopt.json["buffers"].push_back({{"byteLength", 36}});
  meshopt.json["bufferViews"][0]["buffer"] = 1;
  meshopt.json["bufferViews"][0]["extensions"] = {{"EXT_meshopt_compression", {{"buffer", 0}}}};
  EXPECT_SAYS(refusal(meshopt), "bufferViews[0] is packed by EXT_meshopt_compression, " + wayOut);
}

TEST_F(FoundFiles, ImagesOfOtherFormatsAreNamed) {
  const auto textured = [](const char* extension) {
    Glb glb = test::smallestRig();
    glb.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    glb.json["meshes"][0]["primitives"][0]["material"] = 0;
    glb.json["textures"] = {Json::object()};
    if (*extension) glb.json["textures"][0]["extensions"] = {{extension, {{"source", 0}}}};
    return glb;
  };
  for (const auto& [extension, format] :
       std::initializer_list<std::pair<const char*, const char*>>{{"KHR_texture_basisu", "KTX2"},
                                                                  {"EXT_texture_webp", "WebP"},
                                                                  {"EXT_texture_avif", "AVIF"},
                                                                  {"MSFT_texture_dds", "DDS"}})
    EXPECT_SAYS(notes(textured(extension)), std::string("textures[0] has its image as ") + format + " (" +
                                                extension +
                                                ") alone, expected PNG or JPEG: drawn as a flat colour");
  // Where a PNG is there, too, it is drawn, and nothing is said.
  Glb both = textured("EXT_texture_webp");
  both.json["textures"][0]["source"] = 0;
  both.json["images"] = {{{"uri", "skin.png"}}};
  test::writeBytes(folder_ / "skin.png", {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'});
  EXPECT_FALSE(says(notes(both), "WebP")) << notes(both);
  for (const auto& [bytes, format] : std::initializer_list<std::pair<std::string, const char*>>{
           {"\xabKTX 20\xbb\r\n\x1a\n", "KTX2"},
           {"RIFF0000WEBPVP8 ", "WebP"},
           {"GIF89a", "GIF"},
           {std::string("\0\0\0\x1c", 4) + "ftypavif", "AVIF"}}) {
    test::writeText(folder_ / "skin.png", bytes);
    EXPECT_SAYS(notes(both), std::string("images[0] (\"skin.png\"): is ") + format +
                                 ", expected PNG or JPEG: drawn as a flat colour");
  }
}

TEST_F(FoundFiles, BackslashesSeparateFolders) {
  Glb glb = test::smallestRig();
  glb.write(folder_ / "found.gltf");
  std::filesystem::create_directory(folder_ / "parts");
  std::filesystem::rename(folder_ / "found.bin", folder_ / "parts/found.bin");
  const auto loadWith = [&](const std::string& uri) {
    glb.json["buffers"][0]["uri"] = uri;
    test::writeText(folder_ / "found.gltf", glb.json.dump());
    return loadModel(folder_ / "found.gltf");
  };
  EXPECT_EQ(all(loadWith("parts\\found.bin").notes),
            "buffers[0].uri is \"parts\\\\found.bin\": its backslashes count as slashes\n");
  EXPECT_EQ(loadWith(".\\parts%5Cfound.bin").vertices.size(), 3u);
  for (const char* outside : {"..\\found.bin", "parts\\..\\..\\found.bin", "\\found.bin",
                              "\\\\host\\found.bin", "C:\\found.bin", "parts%5C..%5C..%5Cfound.bin"})
    EXPECT_SAYS(inputFault([&] { loadWith(outside); }), "expected a file in its folder");
  // A file of that very name goes first, here and where a name holds what looks like an escape.
  std::filesystem::rename(folder_ / "parts/found.bin", folder_ / "parts\\found.bin");
  EXPECT_EQ(loadWith("parts\\found.bin").vertices.size(), 3u);
  std::filesystem::rename(folder_ / "parts\\found.bin", folder_ / "50%25.bin");
  EXPECT_EQ(loadWith("50%25.bin").vertices.size(), 3u);
  std::filesystem::rename(folder_ / "50%25.bin", folder_ / "F\u00fc\u00dfe 1.bin");
  EXPECT_EQ(loadWith("F%C3%BC%C3%9Fe%201.bin").vertices.size(), 3u);
  EXPECT_EQ(loadWith("F\u00fc\u00dfe 1.bin").vertices.size(), 3u);
}

TEST_F(FoundFiles, GitLfsPointersAreNamed) {
  const std::string pointer = "version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\nsize 12345\n";
  const std::string named = "is a Git LFS pointer; run git lfs pull";
  test::writeText(folder_ / "found.glb", pointer);
  EXPECT_SAYS(inputFault([&] { loadModel(folder_ / "found.glb"); }), "found.glb: " + named);
  Glb glb = test::smallestRig();
  glb.json["materials"] = {{{"emissiveTexture", {{"index", 0}}}}};
  glb.json["meshes"][0]["primitives"][0]["material"] = 0;
  glb.json["textures"] = {{{"source", 0}}};
  glb.json["images"] = {{{"uri", "skin.png"}}};
  test::writeText(folder_ / "skin.png", pointer);
  EXPECT_SAYS(notes(glb, "found.gltf"), "skin.png: " + named);
  test::writeText(folder_ / "found.bin", pointer);
  EXPECT_SAYS(inputFault([&] { loadModel(folder_ / "found.gltf"); }), "found.bin: " + named);
}

TEST_F(FoundFiles, TheFirstFormatIsRefusedByItsVersion) {
  const std::string wayOut = "expected 2.x: gltf-pipeline converts glTF 1.0 to 2.0";
  const auto fault = [&](const std::string& text) {
    test::writeText(folder_ / "old.gltf", text);
    return inputFault([&] { loadModel(folder_ / "old.gltf"); });
  };
  const std::string lists = "\"buffers\": {\"b\": {\"byteLength\": 4}}, \"nodes\": {\"n\": {}}}";
  EXPECT_SAYS(fault("{\"asset\": {\"version\": \"1.0\"}, " + lists),
              "its asset.version is \"1.0\", " + wayOut);
  EXPECT_SAYS(fault("{\"asset\": {\"version\": 1.1}, " + lists), "its asset.version is 1.1, " + wayOut);
  EXPECT_SAYS(fault("{" + lists), "its asset.version is missing, " + wayOut);
  EXPECT_SAYS(fault("{\"asset\": {\"version\": \"3.0\"}}"), "its asset.version is \"3.0\", expected 2.x");
  std::vector<uint8_t> bytes = test::smallestRig().bytes();
  bytes[4] = 1;
  test::writeBytes(folder_ / "old.glb", bytes);
  EXPECT_SAYS(inputFault([&] { loadModel(folder_ / "old.glb"); }),
              "is glTF binary version 1, expected 2: gltf-pipeline converts glTF 1.0 to 2.0");
  // A number is no string, but says the same.
  Glb glb = test::smallestRig();
  glb.json["asset"]["version"] = 2.0;
  EXPECT_EQ(notes(glb), "");
}

TEST_F(FoundFiles, EmptyAndUnusedPartsRefuseNothing) {
  const auto addAccessor = [](Glb& glb, const char* type) {
    glb.json["accessors"].push_back({{"componentType", 5126}, {"count", 0}, {"type", type}});
    return glb.json["accessors"].size() - 1;
  };
  const auto addMesh = [](Glb& glb, const Json& attributes) {
    glb.json["meshes"].push_back({{"primitives", {{{"attributes", attributes}}}}});
  };
  Glb empty = test::smallestRig();
  addMesh(empty, {{"POSITION", addAccessor(empty, "VEC3")}});
  EXPECT_EQ(notes(empty), "meshes[1].primitives[0] has no vertices: left out\n");
  empty.json["nodes"][1]["mesh"] = 1;
  EXPECT_EQ(notes(empty), "meshes[1].primitives[0] has no vertices: left out\n");
  EXPECT_EQ(load(empty).vertices.size(), 3u);

  Glb bare = test::smallestRig();
  addMesh(bare, {{"NORMAL", 0}});
  EXPECT_EQ(notes(bare), "meshes[1].primitives[0] has no POSITION: left out\n");

  Glb indices = test::smallestRig();
  indices.json["meshes"][0]["primitives"].push_back(indices.json["meshes"][0]["primitives"][0]);
  indices.json["accessors"].push_back({{"componentType", 5125}, {"count", 0}, {"type", "SCALAR"}});
  indices.json["meshes"][0]["primitives"][1]["indices"] = indices.json["accessors"].size() - 1;
  EXPECT_EQ(notes(indices), "meshes[0].primitives[1] has no triangles: left out\n");

  // What is wrong with a mesh or a skin matters only where the scene has it.
  Glb broken = test::smallestRig();
  addMesh(broken, {{"POSITION", 1}});
  broken.json["skins"].push_back({{"joints", Json::array()}});
  const std::string why = ": left out, no node of the scene has it\n";
  EXPECT_EQ(notes(broken), "accessors[1] (meshes[1].primitives[0].POSITION) has the wrong type" + why +
                               "skins[1] has no joints" + why);
  broken.json["nodes"][1]["mesh"] = 1;
  EXPECT_SAYS(refusal(broken), "accessors[1] (meshes[1].primitives[0].POSITION) has the wrong type");

  Glb buffer = test::smallestRig();
  buffer.json["buffers"].push_back({{"byteLength", 0}});
  EXPECT_EQ(notes(buffer), "");
}

TEST_F(FoundFiles, BindMatricesWithoutNumbersBindAtRest) {
  const Model sound = load(test::smallestRig());
  for (const float odd : {nan, 0.0f}) {
    Glb glb = test::smallestRig();
    std::vector<float> matrices(64, odd);
    for (size_t k = 0; k < 16; ++k) matrices[k] = k % 5 == 0 ? 1 : 0;
    glb.json["skins"][0]["inverseBindMatrices"] = glb.append(matrices, "MAT4");
    const Model model = load(glb);
    EXPECT_SAYS(all(model.notes),
                "skins[0] has 3 inverse bind matrices of zeros or of what is no number: their "
                "joints are bound as they rest");
    // A joint that is bound as it rests leaves its vertex where the mesh has it.
    EXPECT_LT(glm::distance(model.vertices[2].position, glm::dvec3(1, 0, 0)), 1e-6);
  }
}

TEST_F(FoundFiles, NormalsAndTheLikeNeedNotBeFinite) {
  Glb glb = test::smallestRig();
  glb.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
      glb.append(std::vector<float>{nan, nan, nan, 0, 0, 1, 0, 0, 1}, "VEC3");
  const Model model = load(glb);
  EXPECT_EQ(all(model.notes),
            "meshes[0].primitives[0].NORMAL has 3 numbers that are not finite: they count as 0\n");
  EXPECT_NEAR(glm::length(model.vertices[0].normal), 1, 1e-6);
}

// The joints that a vertex has without weight are padding.
TEST_F(FoundFiles, JointsWithoutWeightMayBeAny) {
  Glb glb = test::smallestRig();
  glb.data(1)[2] = 200;
  EXPECT_EQ(notes(glb), "");
}

TEST_F(FoundFiles, JointsMayBeFloats) {
  const Model sound = load(test::smallestRig());
  Glb glb = test::smallestRig();
  Json& attributes = glb.json["meshes"][0]["primitives"][0]["attributes"];
  std::vector<float> joints = {0, 1, 0, 0, 1, 2, 0, 0, 2, 3, 0, 0};
  attributes["JOINTS_0"] = glb.append(joints, "VEC4");
  const Model model = load(glb);
  for (size_t v = 0; v < 3; ++v) EXPECT_EQ(model.vertices[v].position, sound.vertices[v].position);
  joints[1] = 0.5f;
  attributes["JOINTS_0"] = glb.append(joints, "VEC4");
  EXPECT_SAYS(refusal(glb), "meshes[0].primitives[0].JOINTS_0 holds 0.5, expected the number of a joint");
}

TEST_F(FoundFiles, OtherKindsOfFilesAreNamed) {
  for (const auto& [start, kind] : std::initializer_list<std::pair<const char*, const char*>>{
           {"\x1f\x8b\x08", "gzip: unpack it"},
           {"PK\x03\x04", "ZIP: unpack it"},
           {"Kaydara FBX Binary  ", "FBX: Blender or FBX2glTF converts it"},
           {"\n<!DOCTYPE html>", "HTML or XML, as a download may be that failed"}}) {
    test::writeText(folder_ / "found.glb", start);
    EXPECT_SAYS(inputFault([&] { loadModel(folder_ / "found.glb"); }),
                std::string("is not glTF but ") + kind);
  }
}

TEST_F(FoundFiles, OfScenesWithoutADefaultTheFirstWithAMeshCounts) {
  Glb glb = test::smallestRig();
  glb.json["nodes"].push_back({{"name", "camera"}});
  const Json scene = glb.json["scenes"][0];
  glb.json["scenes"] = {{{"nodes", {5}}}, scene};
  EXPECT_EQ(notes(glb), "has 2 scenes and names none of them: scenes[1] counts\n");
  EXPECT_EQ(load(glb).vertices.size(), 3u);
  glb.json["scene"] = 0;
  EXPECT_EQ(load(glb).vertices.size(), 0u);
  glb.json.erase("scene");
  glb.json["scenes"] = {scene, {{"nodes", {5}}}};
  EXPECT_SAYS(notes(glb), "scenes[0] counts");
}

TEST_F(FoundFiles, AContainerOfAnotherLengthIsReadByItsChunks) {
  const std::vector<uint8_t> sound = test::smallestRig().bytes();
  const auto with = [&](size_t length, size_t more) {
    std::vector<uint8_t> bytes = sound;
    const auto word = static_cast<uint32_t>(length);
    std::memcpy(bytes.data() + 8, &word, 4);
    bytes.insert(bytes.end(), more, 0);
    test::writeBytes(folder_ / "found.glb", bytes);
    const Model model = loadModel(folder_ / "found.glb");
    EXPECT_EQ(model.vertices.size(), 3u);
    return all(model.notes);
  };
  EXPECT_EQ(with(sound.size(), 0), "");
  EXPECT_EQ(with(sound.size(), 5), "");
  EXPECT_SAYS(with(sound.size() + 100, 0), "its header says ");
  EXPECT_SAYS(with(sound.size() + 5, 5), ": the chunks count");
  EXPECT_SAYS(with(0, 0), "its header says 0 bytes");
}

TEST_F(FoundFiles, ExtensionsMayBeInCapitals) {
  test::writeBytes(folder_ / "FOUND.GLB", test::smallestRig().bytes());
  EXPECT_EQ(loadRig(folder_ / "FOUND.GLB").legs.size(), 1u);
}

// An armature that the clip scales by 100 and the rest pose does not, or the other way round.
TEST_F(FoundFiles, AClipOfAnotherUnitIsPlayedInTheSizeAtRest) {
  const auto walking = [](float rest, const std::vector<float>& scale) {
    Glb glb = test::smallestRig();
    glb.node("body")["scale"] = {rest, rest, rest};
    swingKnee(glb);
    if (!scale.empty()) glb.animate(1, "scale", "LINEAR", {0, 1}, scale);
    return glb;
  };
  const ClipSet expected = clips(walking(1, {}));
  for (const auto& [rest, scale] : {std::pair{1.0f, 100.0f}, {1.0f, 0.01f}, {1.0f, 2.54f}, {1.0f, 1000.0f}}) {
    const ClipSet set = clips(walking(rest, std::vector<float>(6, scale)));
    ASSERT_EQ(set.clips.size(), 1u);
    EXPECT_SAYS(all(set.notes), "clip 0 \"clip\": its scale shows the skin");
    EXPECT_SAYS(all(set.notes), "times as large as at rest: played in the size at rest");
    for (size_t f = 0; f < expected.clips[0].feet.size(); ++f)
      EXPECT_LT(glm::distance(set.clips[0].feet[f], expected.clips[0].feet[f]), 1e-5f) << scale;
  }
  // A scale that the rest has as well is no other unit, and a creature may grow or breathe.
  for (const auto& [rest, scale] :
       std::initializer_list<std::pair<float, std::vector<float>>>{{2.0f, std::vector<float>(6, 2.0f)},
                                                                   {1.0f, {1, 1, 1, 100, 100, 100}},
                                                                   {1.0f, std::vector<float>(6, 1.2f)}}) {
    const ClipSet set = clips(walking(rest, scale));
    EXPECT_EQ(all(set.notes), "");
  }
}

// Translations in centimetres of a skin in metres: nothing says which is meant.
TEST_F(FoundFiles, AClipWhoseJointsAreFarApartSaysSo) {
  Glb glb = test::smallestRig();
  swingKnee(glb, {0, 1}, {100, 0, 0, 100, 0, 0});
  glb.animate(4, "translation", "LINEAR", {0, 1}, {0, -100, 0, 0, -100, 0});
  EXPECT_SAYS(all(clips(glb).notes),
              "times as far apart as at rest: its translations may be in another unit");
  Glb root = test::smallestRig();
  root.animate(1, "translation", "LINEAR", {0, 1}, {0, 100, 0, 0, 100, 50});
  EXPECT_SAYS(all(clips(root).notes),
              "clip 0 \"clip\": its root is 100 times as far from its parent as at rest");
  Glb away = test::smallestRig();
  away.animate(1, "translation", "LINEAR", {0, 1}, {0, 1, 0, 0, 1, 50});
  EXPECT_EQ(all(clips(away).notes), "");
}

}  // namespace
}  // namespace skitter
