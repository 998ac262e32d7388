// Materials as files have them: what is read, what is left out with a note, and where tangents point.
#include "skitter/material.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <glm/gtc/quaternion.hpp>
#include <memory>

#include "assets/materials/worn_colours.h"
#include "base/srgb.h"
#include "files.h"
#include "glb_builder.h"
#include "skitter/clip.h"
#include "skitter/rig.h"
#include "skitter/rig_setup.h"
#include "support/image_bytes.h"

namespace skitter {
namespace {

using test::Glb;

Texels oneColour(int r, int g, int b) {
  return test::texelsOf(2, 2, [=](uint32_t, uint32_t) { return glm::ivec4(r, g, b, 255); });
}

class MaterialsTest : public ::testing::Test {
 protected:
  Model load(const Glb& glb) const {
    test::writeBytes(folder_ / "worn.glb", glb.bytes());
    return loadModel(folder_ / "worn.glb");
  }
  Rig rigOf(const Glb& glb) const {
    const std::vector<uint8_t> bytes = glb.bytes();
    return parseRig(bytes, "worn.glb");
  }
  static bool hasNote(const Model& model, const std::string& words) {
    for (const std::string& note : model.notes)
      if (note.find(words) != std::string::npos) return true;
    return false;
  }
  static nlohmann::json& primitive(Glb& glb) { return glb.json["meshes"][0]["primitives"][0]; }
  static nlohmann::json& material(Glb& glb) { return glb.json["materials"][0]; }
  // As the triangle has them, which faces -Z.
  static void addNormals(Glb& glb) {
    primitive(glb)["attributes"]["NORMAL"] =
        glb.append(std::vector<float>{0, 0, -1, 0, 0, -1, 0, 0, -1}, "VEC3");
  }

  // An image in the binary chunk. Returns its index.
  static size_t addImage(Glb& glb, const std::vector<uint8_t>& bytes) {
    glb.append(bytes, "SCALAR");
    glb.json["images"].push_back({{"bufferView", glb.json["bufferViews"].size() - 1}});
    return glb.json["images"].size() - 1;
  }
  // The smallest rig: its triangle (0, 1, 0), (1, 1, 0), (1, 0, 0) faces -Z, and its image is upright as seen
  // from there, with (0, 0) at (1, 1, 0).
  static Glb wornRig() {
    Glb glb = test::smallestRig();
    primitive(glb)["attributes"]["TEXCOORD_0"] = glb.append(std::vector<float>{1, 0, 0, 0, 0, 1}, "VEC2");
    primitive(glb)["material"] = 0;
    addImage(glb, test::pngBytes(oneColour(255, 128, 0)));
    glb.json["textures"] = {{{"source", 0}}};
    glb.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    return glb;
  }

  test::TemporaryFolder folder_;
};

TEST_F(MaterialsTest, AModelWithoutTexturesHasNone) {
  Glb glb = test::smallestRig();
  EXPECT_FALSE(load(glb).look);
  glb.json["materials"] = {
      {{"pbrMetallicRoughness", {{"baseColorFactor", {1, 0.5, 0, 1}}, {"roughnessFactor", 0.3}}}}};
  primitive(glb)["material"] = 0;
  EXPECT_FALSE(load(glb).look);
  EXPECT_FALSE(spiderRig().look);
  EXPECT_FALSE(spiderClips().look);
  EXPECT_FALSE(loadRig(SKITTER_ROOT "/assets/quadruped.glb").look);
  // A textured material that nothing wears does not count.
  glb = wornRig();
  glb.json["materials"].push_back(glb.json["materials"][0]);
  glb.json["materials"][0] = nlohmann::json::object();
  EXPECT_FALSE(load(glb).look);
}

TEST_F(MaterialsTest, EveryPropertyIsRead) {
  Glb glb = wornRig();
  const std::vector<uint8_t> other = test::pngBytes(oneColour(1, 2, 3));
  addImage(glb, other);
  glb.json["samplers"] = {{{"magFilter", 9728}, {"minFilter", 9985}, {"wrapS", 33071}, {"wrapT", 33648}}};
  glb.json["textures"].push_back({{"source", 1}, {"sampler", 0}});
  material(glb) = nlohmann::json::parse(R"({
    "name": "coat", "doubleSided": true, "alphaMode": "MASK", "alphaCutoff": 0.25,
    "emissiveFactor": [0.1, 0.2, 0.3],
    "pbrMetallicRoughness": {
      "baseColorFactor": [1, 0.5, 0.25, 0.5], "metallicFactor": 0.75, "roughnessFactor": 0.5,
      "baseColorTexture": {"index": 0},
      "metallicRoughnessTexture": {"index": 1, "texCoord": 1}},
    "normalTexture": {"index": 1, "scale": 2},
    "occlusionTexture": {"index": 1, "strength": 0.5, "extensions": {"KHR_texture_transform":
      {"offset": [0.5, 0.25], "scale": [2, 3], "rotation": 0.5, "texCoord": 1}}},
    "emissiveTexture": {"index": 0}})");
  const std::vector<uint8_t> colours = {255, 255, 255, 51, 255, 255, 255, 255, 0, 0, 0, 0};
  primitive(glb)["attributes"]["COLOR_0"] = glb.append(colours, "VEC4");
  glb.json["accessors"].back()["normalized"] = true;
  const Model model = load(glb);
  ASSERT_TRUE(model.look);
  ASSERT_EQ(model.look.materials->list.size(), 1u);
  const Material& found = model.look.materials->list[0];
  EXPECT_EQ(found.name, "coat");
  EXPECT_TRUE(found.doubleSided);
  EXPECT_EQ(found.alphaCutoff, 0.25f);
  EXPECT_EQ(found.emissive, glm::vec3(0.1f, 0.2f, 0.3f));
  EXPECT_EQ(found.metallic, 0.75f);
  EXPECT_EQ(found.roughness, 0.5f);
  EXPECT_EQ(found.normalScale, 2);
  EXPECT_EQ(found.occlusionStrength, 0.5f);
  EXPECT_EQ(found.texture(TextureRole::baseColour), (Texture{.image = 0}));
  EXPECT_EQ(found.texture(TextureRole::emissive), (Texture{.image = 0}));
  const TextureSampler sampler{.wrapS = TextureSampler::Wrap::clamp,
                               .wrapT = TextureSampler::Wrap::mirror,
                               .magNearest = true,
                               .mips = TextureSampler::Mips::nearest};
  const Texture plain{.image = 1, .set = 0, .sampler = sampler};
  EXPECT_EQ(found.texture(TextureRole::normal), plain);
  Texture second = plain;
  second.set = 1;
  EXPECT_EQ(found.texture(TextureRole::metallicRoughness), second);
  second.offset = {0.5f, 0.25f};
  second.scale = {2, 3};
  second.rotation = 0.5f;
  EXPECT_EQ(found.texture(TextureRole::occlusion), second);
  ASSERT_EQ(model.look.materials->images.size(), 2u);
  EXPECT_EQ(model.look.materials->images[1].bytes, other);
  // Vertices: colour and opacity are the factor's times COLOR_0's.
  EXPECT_EQ(model.vertices[0].colour, glm::vec3(1, 0.5f, 0.25f));
  EXPECT_FLOAT_EQ(model.look.vertices[0].opacity, 0.1f);
  EXPECT_FLOAT_EQ(model.look.vertices[1].opacity, 0.5f);
  EXPECT_EQ(model.look.vertices[2].opacity, 0);
  EXPECT_EQ(model.look.vertices[0].uv[0], glm::vec2(1, 0));
  EXPECT_EQ(model.look.vertices[2].uv[0], glm::vec2(0, 1));
}

TEST_F(MaterialsTest, WhatAFileLeavesOutIsAsTheSpecificationSays) {
  const Material found = load(wornRig()).look.materials->list.at(0);
  Material expected;
  expected.texture(TextureRole::baseColour).image = 0;
  EXPECT_EQ(found, expected);
}

// The example of the extension's page: the lower left quarter of the image, turned clockwise by 90 degrees.
TEST_F(MaterialsTest, TexturesAreScaledThenTurnedThenMoved) {
  const Texture texture{.image = 0, .scale = {0.5f, 0.5f}, .offset = {0, 1}, .rotation = 1.57079632679f};
  const auto at = [&](float u, float v) {
    return glm::vec2(glm::dot(texture.rows()[0], glm::vec3(u, v, 1)),
                     glm::dot(texture.rows()[1], glm::vec3(u, v, 1)));
  };
  // The surface's upper left corner shows the quarter's lower left one, its upper right the upper left.
  EXPECT_LT(glm::distance(at(0, 0), {0, 1}), 1e-6f);
  EXPECT_LT(glm::distance(at(1, 0), {0, 0.5f}), 1e-6f);
  EXPECT_LT(glm::distance(at(0, 1), {0.5f, 1}), 1e-6f);
}

TEST_F(MaterialsTest, ImagesLieInTheFileBesideItOrInAnUri) {
  const std::vector<uint8_t> png = test::pngBytes(oneColour(255, 128, 0));
  Glb glb = wornRig();
  glb.json["images"][0] = {{"uri", "the%20coat.png"}};
  test::writeBytes(folder_ / "the coat.png", png);
  EXPECT_EQ(load(glb).look.materials->images.at(0).bytes, png);
  // A 1 x 1 PNG of 67 bytes, which is short enough to be written here.
  glb.json["images"][0]["uri"] =
      "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR42mNgAAAAAgAB5Sfe/"
      "AAAAABJRU5E"
      "rkJggg==";
  const Texels texel = decodeImage(load(glb).look.materials->images.at(0));
  EXPECT_EQ(texel.rgba, (std::vector<uint8_t>{0, 0, 0, 255}));
}

TEST_F(MaterialsTest, ImagesThatCannotBeHadAreNotedAndTheModelLoads) {
  test::writeText(folder_ / "text.png", "no image");
  test::writeText(folder_ / "empty.png", "");
  const std::pair<nlohmann::json, const char*> cases[] = {
      {{{"uri", "none.png"}}, "none.png: no such file: drawn as a flat colour"},
      {{{"uri", "text.png"}}, "images[0] (\"text.png\"): is neither PNG nor JPEG: drawn as a flat colour"},
      {{{"uri", "empty.png"}}, "is empty: drawn as a flat colour"},
      {{{"uri", "../out.png"}}, "expected a file in its folder: drawn as a flat colour"},
      {{{"uri", "data:image/png,no"}}, "its data: URI is not base64: drawn as a flat colour"},
      {{{"uri", 3}}, "images[0].uri is 3, expected a string: drawn as a flat colour"},
      {{{"bufferView", 99}}, "images[0].bufferView is 99, but there are "},
      {{{"name", "skin"}}, "images[0] (\"skin\").bufferView is missing, but there are "},
  };
  for (const auto& [image, expected] : cases) {
    Glb glb = wornRig();
    glb.json["images"][0] = image;
    const Model model = load(glb);
    EXPECT_TRUE(hasNote(model, expected))
        << image << ": " << (model.notes.empty() ? "no note" : model.notes[0]);
    ASSERT_TRUE(model.look) << image;
    const ImageFile& file = model.look.materials->images.at(0);
    EXPECT_EQ(test::inputFault([&] { decodeImage(file); }), file.fault);
    EXPECT_EQ(file.fault.rfind((folder_ / "worn.glb").string() + ": images[0]", 0), 0u) << file.fault;
  }
}

TEST_F(MaterialsTest, FaultsLeaveOneTextureOutAndAreNoted) {
  const std::pair<std::function<void(Glb&)>, const char*> cases[] = {
      {[](Glb& g) { g.json["textures"] = nlohmann::json::array(); },
       "materials[0].pbrMetallicRoughness.baseColorTexture.index is 0, but there are 0 of these: left out"},
      {[](Glb& g) { g.json["textures"][0] = nlohmann::json::object(); },
       "textures[0].source is missing, but there are 1 of these: left out"},
      {[](Glb& g) { g.json["textures"][0]["source"] = -1; }, "textures[0].source is -1, "},
      {[](Glb& g) { material(g)["pbrMetallicRoughness"]["baseColorTexture"]["texCoord"] = 2; },
       "uses other texture coordinates than TEXCOORD_0 and TEXCOORD_1: left out"},
  };
  for (const auto& [change, expected] : cases) {
    Glb glb = wornRig();
    material(glb)["doubleSided"] = true;
    change(glb);
    const Model model = load(glb);
    EXPECT_TRUE(hasNote(model, expected)) << (model.notes.empty() ? expected : model.notes[0]);
    ASSERT_TRUE(model.look);
    EXPECT_EQ(model.look.materials->list[0].texture(TextureRole::baseColour).image, -1);
  }
  Glb glb = wornRig();
  material(glb)["pbrMetallicRoughness"]["roughnessFactor"] = 2;
  material(glb)["alphaMode"] = "BLEND";
  const Model model = load(glb);
  EXPECT_TRUE(hasNote(model, "roughnessFactor is 2, expected 0 to 1: counts as 1"));
  EXPECT_TRUE(hasNote(model, "materials[0].alphaMode is BLEND"));
  EXPECT_EQ(model.look.materials->list[0].alphaCutoff, 0.5f);
}

// Tangents of the file go with the mesh, and change sides where it is mirrored.
TEST_F(MaterialsTest, TangentsTurnWithTheirVertices) {
  Glb glb = wornRig();
  addNormals(glb);
  primitive(glb)["attributes"]["TANGENT"] =
      glb.append(std::vector<float>{1, 0, 0, 1, 0, 1, 0, -1, 0, 0, 0, 1}, "VEC4");
  primitive(glb)["attributes"]["NORMAL"] = glb.append(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  glb.json["nodes"][0].erase("skin");
  glb.json["nodes"][0]["scale"] = {2, 1, 1};
  glb.json["nodes"][0]["rotation"] = {0, 0, std::sqrt(0.5), std::sqrt(0.5)};  // from X to Y
  Model model = load(glb);
  EXPECT_LT(glm::distance(model.look.vertices[0].tangent, {0, 1, 0, 1}), 1e-6f);
  EXPECT_LT(glm::distance(model.look.vertices[1].tangent, {-1, 0, 0, -1}), 1e-6f);
  EXPECT_EQ(glm::length(glm::vec3(model.look.vertices[2].tangent)), 1) << "a tangent of no length";
  glb.json["nodes"][0]["scale"] = {-2, 1, 1};
  model = load(glb);
  EXPECT_LT(glm::distance(model.look.vertices[0].tangent, {0, -1, 0, -1}), 1e-6f);
  EXPECT_LT(glm::distance(model.look.vertices[1].tangent, {-1, 0, 0, 1}), 1e-6f);
}

// Tangents were made for normals; without these they count for nothing (glTF 2.0, section 3.7.2.1).
TEST_F(MaterialsTest, TangentsWithoutNormalsAreMadeAnew) {
  Glb glb = wornRig();
  glb.json["nodes"][0].erase("skin");
  material(glb)["normalTexture"] = {{"index", 0}};
  const std::vector<float> up{0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1};
  primitive(glb)["attributes"]["TANGENT"] = glb.append(up, "VEC4");
  const Model made = load(glb);
  for (const MaterialVertex& vertex : made.look.vertices)
    EXPECT_LT(glm::distance(vertex.tangent, {-1, 0, 0, 1}), 1e-6f);
  addNormals(glb);
  const Model kept = load(glb);
  for (const MaterialVertex& vertex : kept.look.vertices)
    EXPECT_LT(glm::distance(vertex.tangent, {0, 1, 0, 1}), 1e-6f);
}

TEST_F(MaterialsTest, MissingTextureCoordinatesAreNoted) {
  Glb glb = wornRig();
  EXPECT_FALSE(hasNote(load(glb), "TEXCOORD"));
  material(glb)["emissiveTexture"] = {{"index", 0}, {"texCoord", 1}};
  const Model model = load(glb);
  EXPECT_TRUE(hasNote(model,
                      "meshes[0].primitives[0] has no TEXCOORD_1, where materials[0] looks textures up: "
                      "(0, 0) counts"));
  EXPECT_EQ(model.look.vertices[0].uv[1], glm::vec2(0));
  EXPECT_EQ(model.look.vertices[0].uv[0], glm::vec2(1, 0));
}

// Without tangents in the file, they are made for normal textures alone.
TEST_F(MaterialsTest, TangentsAreMadeWhereAFileHasNone) {
  Glb glb = wornRig();
  glb.json["nodes"][0].erase("skin");
  material(glb)["normalTexture"] = {{"index", 0}};
  Model model = load(glb);
  // Seen from -Z, -X is to the right and +Y up.
  for (const MaterialVertex& vertex : model.look.vertices)
    EXPECT_LT(glm::distance(vertex.tangent, {-1, 0, 0, 1}), 1e-6f);
  // The texture's own transform counts: turned by 90 degrees, u' = v grows downward.
  material(glb)["normalTexture"]["extensions"] = {{"KHR_texture_transform", {{"rotation", 1.57079632679}}}};
  model = load(glb);
  for (const MaterialVertex& vertex : model.look.vertices)
    EXPECT_LT(glm::distance(vertex.tangent, {0, -1, 0, 1}), 1e-6f);
  // A mirrored image has its top on the other side.
  material(glb)["normalTexture"].erase("extensions");
  primitive(glb)["attributes"]["TEXCOORD_0"] = glb.append(std::vector<float>{0, 0, 1, 0, 1, 1}, "VEC2");
  model = load(glb);
  for (const MaterialVertex& vertex : model.look.vertices)
    EXPECT_LT(glm::distance(vertex.tangent, {1, 0, 0, -1}), 1e-6f);
  // Coordinates that say nothing still give a tangent along the surface.
  primitive(glb)["attributes"].erase("TEXCOORD_0");
  model = load(glb);
  for (size_t v = 0; v < 3; ++v) {
    const glm::vec3 tangent(model.look.vertices[v].tangent);
    EXPECT_NEAR(glm::length(tangent), 1, 1e-6f);
    EXPECT_NEAR(glm::dot(tangent, model.vertices[v].normal), 0, 1e-6f);
  }
}

TEST_F(MaterialsTest, RigsAndClipsWearTheModelsLook) {
  Glb glb = wornRig();
  material(glb)["normalTexture"] = {{"index", 0}};
  glb.animate(2, "rotation", "LINEAR", {0, 1}, {0, 0, 0, 1, 0, 0, 1, 0});
  const Model model = load(glb);
  const Rig rig = loadRig(folder_ / "worn.glb");
  ASSERT_EQ(rig.look.vertices.size(), rig.vertices.size());
  EXPECT_EQ(rig.look, model.look) << "the rig is not turned";
  EXPECT_EQ(rig.look.materials->images.at(0).bytes, test::pngBytes(oneColour(255, 128, 0)));
  const ClipSet clips = loadClips(folder_ / "worn.glb", rig);
  ASSERT_EQ(clips.look.vertices.size(), clips.vertices.size());
  // Bound where it rests.
  for (size_t v = 0; v < clips.vertices.size(); ++v) {
    EXPECT_LT(glm::distance(clips.look.vertices[v].tangent, rig.look.vertices[v].tangent), 1e-6f);
    EXPECT_EQ(clips.look.vertices[v].uv[0], rig.look.vertices[v].uv[0]);
  }
}

TEST_F(MaterialsTest, AProposalLeavesTexturesTheirColours) {
  Glb glb = test::readGlb(SKITTER_ROOT "/assets/quadruped.glb");
  primitive(glb)["attributes"].erase("COLOR_0");
  EXPECT_NE(proposeRig(load(glb)).setup.colour, glm::dvec3(1)) << "it is white";
  addImage(glb, test::pngBytes(oneColour(90, 60, 30)));
  glb.json["textures"] = {{{"source", 0}}};
  material(glb)["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
  EXPECT_EQ(proposeRig(load(glb)).setup.colour, glm::dvec3(1));
  glb.json["images"][0] = {{"uri", "none.png"}};
  EXPECT_NE(proposeRig(load(glb)).setup.colour, glm::dvec3(1)) << "its image cannot be had";
}

// Colours from afar: the vertex's times the texture's, in linear light.
TEST_F(MaterialsTest, WornColoursAreTheTexturesThere) {
  Glb glb = wornRig();
  const Texels halves = test::texelsOf(128, 2, [](uint32_t x, uint32_t) {
    return x < 64 ? glm::ivec4(255, 0, 0, 255) : glm::ivec4(0, 188, 0, 255);
  });
  glb.json["images"].clear();
  addImage(glb, test::pngBytes(halves));
  material(glb)["pbrMetallicRoughness"]["baseColorFactor"] = {0.5, 1, 1, 1};
  primitive(glb)["attributes"]["TEXCOORD_0"] =
      glb.append(std::vector<float>{0.2f, 0.5f, 0.8f, 0.5f, 1.2f, 0.5f}, "VEC2");
  const Rig rig = rigOf(glb);
  const std::vector<glm::vec3> colours = wornColours(rig.vertices, rig.look);
  EXPECT_LT(glm::distance(colours[0], {0.5f, 0, 0}), 1e-6f);
  EXPECT_LT(glm::distance(colours[1], {0, 0.5028865f, 0}), 1e-6f);  // ((188 / 255 + 0.055) / 1.055)^2.4
  EXPECT_LT(glm::distance(colours[2], {0.5f, 0, 0}), 1e-6f) << "images repeat";
  EXPECT_EQ(wornColours(rig.vertices, {})[0], glm::vec3(0.5f, 1, 1));
}

// Texel by texel, as pictures of rigs have them.
TEST(BaseColours, AreTexelsAtALevel) {
  const Texels image = test::texelsOf(
      4, 2, [](uint32_t x, uint32_t y) { return glm::ivec4(60 * x, 120 * y, 255, 100 + 50 * y); });
  Materials materials;
  materials.images.push_back(test::pngFile(image));
  Texture& texture = materials.list.emplace_back().texture(TextureRole::baseColour);
  texture.image = 0;
  texture.sampler = {.wrapS = TextureSampler::Wrap::mirror, .wrapT = TextureSampler::Wrap::clamp};
  materials.list.emplace_back();
  const Look look{{}, std::make_shared<const Materials>(materials)};
  const BaseColours colours(look);
  const auto codes = [&](float u, float v, size_t level = 0, uint16_t from = 0) {
    const glm::vec4 found = colours.at({.uv = {{u, v}, {}}, .material = from}, level);
    return glm::ivec4(base::byteOfLinear(found.r), base::byteOfLinear(found.g), base::byteOfLinear(found.b),
                      std::lround(255 * found.a));
  };
  EXPECT_EQ(codes(0.3f, 0.2f), glm::ivec4(60, 0, 255, 100));
  EXPECT_EQ(codes(0.9f, 0.7f), glm::ivec4(180, 120, 255, 150));
  EXPECT_EQ(codes(1.3f, 7), glm::ivec4(120, 120, 255, 150)) << "mirrored across, ended below";
  EXPECT_EQ(codes(-0.3f, -7), glm::ivec4(60, 0, 255, 100));
  EXPECT_EQ(codes(INFINITY, NAN), glm::ivec4(0, 0, 255, 100));
  EXPECT_EQ(codes(0.3f, 0.2f, 0, 1), glm::ivec4(255)) << "a material without a texture";
  // The level of one row has the light of both, and there is none behind the last.
  EXPECT_EQ(codes(0.3f, 0.2f, 1).a, 125);
  EXPECT_EQ(codes(0.3f, 0.2f, 9), codes(0.3f, 0.2f, 2));
  // A triangle over half of the image, thus 4 texels.
  std::array<MaterialVertex, 3> corners;
  corners[1].uv[0] = {1, 0};
  corners[2].uv[0] = {0, 1};
  EXPECT_EQ(colours.levelOf(corners, 100), 0u);
  EXPECT_EQ(colours.levelOf(corners, 4), 0u);
  EXPECT_EQ(colours.levelOf(corners, 1), 1u);
  EXPECT_EQ(colours.levelOf(corners, 1e-6f), 2u);
  EXPECT_EQ(colours.levelOf(corners, 0), 2u);
  // None of more texels than asked for.
  EXPECT_EQ(BaseColours(look, 2).at({.uv = {{0.3f, 0.2f}, {}}}).a, 125 / 255.0f);
}

// zlib may pack images otherwise elsewhere, so texels are compared, not bytes.
TEST_F(MaterialsTest, PiebaldIsAsItsGeneratorWritesIt) {
  const std::string command =
      std::string("\"" SKITTER_PYTHON "\" \"" SKITTER_ROOT "/assets/quadruped/generate.py\" --textured \"") +
      (folder_ / "piebald.glb").string() + "\" > /dev/null";
  ASSERT_EQ(std::system(command.c_str()), 0);
  const Model made = loadModel(folder_ / "piebald.glb"), kept = loadModel(SKITTER_ROOT "/assets/piebald.glb");
  EXPECT_TRUE(kept.notes.empty()) << kept.notes[0];
  EXPECT_EQ(made.indices, kept.indices);
  ASSERT_EQ(made.vertices.size(), kept.vertices.size());
  for (size_t v = 0; v < made.vertices.size(); ++v)
    ASSERT_EQ(made.vertices[v].position, kept.vertices[v].position) << v;
  EXPECT_EQ(made.look.vertices, kept.look.vertices);
  EXPECT_EQ(made.look.materials->list, kept.look.materials->list);
  ASSERT_EQ(kept.look.materials->images.size(), 4u);
  for (size_t i = 0; i < 4; ++i)
    EXPECT_EQ(decodeImage(made.look.materials->images.at(i)), decodeImage(kept.look.materials->images[i]))
        << i;
  // It walks as the plain one does.
  EXPECT_EQ(loadRig(SKITTER_ROOT "/assets/piebald.glb").legs,
            loadRig(SKITTER_ROOT "/assets/quadruped.glb").legs);
}

}  // namespace
}  // namespace skitter
