#include "skitter/material.h"

#include <functional>
#include <utility>

#include "public/public.h"
#include "skitter/model.h"
#include "skitter/renderer.h"
#include "skitter/rig.h"

namespace skitter::test {
namespace {

using PublicMaterial = PublicTest;

// The spider in one material of a program's own, with an image that is none.
Rig wornRig() {
  Rig rig = spiderRig();
  Materials materials;
  materials.list.emplace_back().texture(TextureRole::baseColour).image = 0;
  materials.images.push_back({.name = "mine", .bytes = {1, 2, 3}, .fault = {}});
  rig.look.vertices.resize(rig.vertices.size());
  rig.look.materials = std::make_shared<const Materials>(std::move(materials));
  return rig;
}

TEST(PublicMaterials, RolesHaveNamesAndAreColoursOrNumbers) {
  int colours = 0;
  for (const TextureRole role : allTextureRoles) colours += isColour(role);
  EXPECT_EQ(colours, 2);
  EXPECT_TRUE(isColour(TextureRole::emissive));
  EXPECT_STREQ(nameOf(TextureRole::metallicRoughness), "metallic-roughness");
  Material material;
  material.texture(TextureRole::normal).image = 3;
  EXPECT_EQ(std::as_const(material).texture(TextureRole::normal).image, 3);
  EXPECT_EQ(material.texture(TextureRole::occlusion).image, -1);
}

TEST(PublicMaterials, ATextureMapsItsCoordinates) {
  const Texture texture{.image = 0, .scale = {2, 3}, .offset = {0.5f, 0.25f}};
  const auto rows = texture.rows();
  EXPECT_EQ(rows[0], glm::vec3(2, 0, 0.5f));
  EXPECT_EQ(rows[1], glm::vec3(0, 3, 0.25f));
}

TEST(PublicMaterials, AModelsLookIsReadAndItsImagesDecoded) {
  const Model model = loadModel(assetFile("piebald.glb"));
  const Look& look = model.look;
  ASSERT_TRUE(look.operator bool());
  EXPECT_FALSE(spiderRig().look.operator bool());
  EXPECT_EQ(look.vertices.size(), model.vertices.size());
  Look copy{look.vertices, std::make_shared<const Materials>(*look.materials)};
  EXPECT_TRUE(copy == look) << "equal by value";
  copy.vertices[0].opacity *= 0.5f;
  EXPECT_FALSE(copy == look);
  ASSERT_EQ(look.materials->images.size(), 4u);
  const Texels coat = decodeImage(look.materials->images[0]);
  EXPECT_EQ(coat.width, 128u);
  EXPECT_EQ(coat.rgba.size(), size_t{4} * coat.width * coat.height);
}

TEST(PublicMaterials, ImagesThatCannotBeDecodedAreRefusedByName) {
  expectRefused("mine: is neither PNG nor JPEG", [] { decodeImage(wornRig().look.materials->images[0]); });
  expectRefused("yours", [] { decodeImage({.name = "yours", .bytes = {}, .fault = {}}); });
  expectRefused("theirs: no such file",
                [] { decodeImage({.name = "theirs", .bytes = {}, .fault = "theirs: no such file"}); });
}

TEST_F(PublicMaterial, ABrokenImageIsANoteOfTheRenderer) {
  Crowd crowd(device(), flatGround(), standingScene(1), {.rigs = {wornRig()}});
  const Renderer renderer(device(), crowd, 64, 48);
  EXPECT_THAT(renderer.notes(), testing::ElementsAre(testing::HasSubstr("mine: is neither PNG nor JPEG")));
}

TEST_F(PublicMaterial, LooksThatLeadNowhereAreRefused) {
  const auto changed = [](const std::function<void(Rig&, Materials&)>& change) {
    Rig rig = wornRig();
    Materials materials = *rig.look.materials;
    change(rig, materials);
    if (rig.look.materials) rig.look.materials = std::make_shared<const Materials>(std::move(materials));
    return rig;
  };
  const std::pair<Rig, const char*> cases[] = {
      {changed([](Rig& rig, Materials&) { rig.look.vertices.pop_back(); }), "expected the skin's"},
      {changed([](Rig& rig, Materials&) { rig.look.materials = nullptr; }),
       "expected none without materials"},
      {changed([](Rig& rig, Materials&) { rig.look.vertices[5].material = 1; }), "is of material 1"},
      {changed([](Rig& rig, Materials& materials) {
         materials.list.emplace_back();
         rig.look.vertices[rig.indices[0]].material = 1;
       }),
       "is of several materials"},
      {changed([](Rig& rig, Materials&) { rig.indices[3] = UINT32_MAX; }),
       "triangle 1 has vertex 4294967295"},
      {changed([](Rig&, Materials& materials) { materials.images.clear(); }),
       "the base colour texture of material 0 is of image 0, but there are 0"},
      {changed([](Rig&, Materials& materials) { materials.list[0].texture(TextureRole::normal).image = -2; }),
       "the normal texture of material 0 is of image -2"},
      {changed([](Rig&, Materials& materials) { materials.list[0].texture(TextureRole::emissive).set = 2; }),
       "uses texture coordinates 2, expected 0 or 1"},
  };
  for (const auto& [rig, text] : cases)
    expectRefused(text,
                  [&, from = rig] { Crowd(device(), flatGround(), standingScene(1), {.rigs = {from}}); });
}

}  // namespace
}  // namespace skitter::test
