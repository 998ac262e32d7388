#include "skitter/rig.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <random>

#include "files.h"
#include "glb_builder.h"
#include "made_models.h"

namespace skitter {
namespace {

using test::Glb;
using test::inputFault;
using test::smallestRig;

Rig parse(const Glb& glb) { return parseRig(glb.bytes(), "small.glb"); }

std::string faultOf(const std::function<void(Glb&)>& change) {
  Glb glb = smallestRig();
  change(glb);
  const std::string what = inputFault([&] { parse(glb); });
  EXPECT_EQ(what.rfind("small.glb: ", 0), 0u) << what;
  return what;
}

nlohmann::json& extras(Glb& glb) { return glb.json["scenes"][0]["extras"]["skitter"]; }
nlohmann::json& leg(Glb& glb) { return extras(glb)["legs"][0]; }

TEST(Rig, Smallest) {
  const Rig rig = parse(smallestRig());
  EXPECT_EQ(rig.name, "small");
  ASSERT_EQ(rig.legCount(), 1);
  const Leg& only = rig.legs[0];
  ASSERT_EQ(only.bones.size(), 2u);
  EXPECT_EQ(only.root(), glm::vec3(0, 1, 0));
  EXPECT_EQ(only.bones[1].direction, glm::vec3(0, -1, 0));
  EXPECT_EQ(only.home, glm::vec3(1, 0, 0));
  EXPECT_EQ(only.reach, 2);
  EXPECT_EQ(rig.legLength, 2);
  EXPECT_EQ(only.bones[0].coneHalfAngle, Bone{}.coneHalfAngle);
  EXPECT_EQ(rig.indices, (std::vector<uint32_t>{0, 1, 2}));
  EXPECT_EQ(rig.vertices[0].normal, glm::vec3(0, 0, -1));  // none in the file
  // Body and hip; hip and knee; the foot joint moves with the last bone, so its weight is the knee's.
  EXPECT_EQ(rig.vertices[0].bones[0], 0);
  EXPECT_EQ(rig.vertices[0].bones[1], 1);
  EXPECT_EQ(rig.vertices[1].bones[0], 2);
  EXPECT_FLOAT_EQ(rig.vertices[1].weights[0], 0.75f);
  EXPECT_EQ(rig.vertices[2].bones[0], 2);
  EXPECT_FLOAT_EQ(rig.vertices[2].weights[0], 1);
  EXPECT_FLOAT_EQ(rig.vertices[2].weights[1], 0);
}

TEST(Rig, VerticesRestWhereTheNodesRest) {
  // Without inverse bind matrices a vertex is in joint space, so a moved joint takes it along.
  Glb glb = smallestRig();
  const float all[] = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
  std::memcpy(glb.data(2), all, sizeof(all));
  const Rig rig = parse(glb);
  EXPECT_EQ(rig.vertices[0].position, glm::vec3(0, 2, 0));
  EXPECT_EQ(rig.vertices[1].position, glm::vec3(1, 2, 0));
  EXPECT_EQ(rig.vertices[2].position, glm::vec3(2, 1, 0));
}

TEST(Rig, NodeTransformsOfEveryKind) {
  Glb glb = smallestRig();
  // Scaled by 100 in one node and back in its child, turned a quarter about y by a matrix.
  glb.node("body")["scale"] = {100, 100, 100};
  auto& hip = glb.node("hip");
  hip["matrix"] = {0, 0, -0.01, 0, 0, 0.01, 0, 0, 0.01, 0, 0, 0, 0, 0, 0, 1};
  const Rig rig = parse(glb);
  EXPECT_LT(glm::length(rig.legs[0].home - glm::vec3(0, 0, -1)), 1e-6);
  EXPECT_FLOAT_EQ(rig.legs[0].reach, 2);
  glb = smallestRig();
  glb.node("hip")["rotation"] = {0, std::sqrt(0.5), 0, std::sqrt(0.5)};
  EXPECT_LT(glm::length(parse(glb).legs[0].home - glm::vec3(0, 0, -1)), 1e-6);
}

TEST(Rig, ExtrasMayBeOnANode) {
  Glb glb = smallestRig();
  glb.node("body")["extras"]["skitter"] = extras(glb);
  glb.json["scenes"][0].erase("extras");
  EXPECT_EQ(parse(glb).legCount(), 1);
}

TEST(Rig, WeightsThatDoNotSumToOneAreScaled) {
  Glb glb = smallestRig();
  const float weights[] = {2, 2, 0, 0, 0.1f, 0.1f, 0, 0, 1, 0, 0, 0};
  std::memcpy(glb.data(2), weights, sizeof(weights));
  for (const SkinVertex& vertex : parse(glb).vertices) {
    EXPECT_FLOAT_EQ(vertex.weights[0] + vertex.weights[1] + vertex.weights[2] + vertex.weights[3], 1);
  }
}

TEST(Rig, ColoursFloatAndNormalised) {
  Glb glb = smallestRig();
  const std::vector<uint8_t> colours = {255, 0, 51, 255, 0, 255, 0, 255, 0, 0, 255, 255};
  glb.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = glb.append(colours, "VEC4");
  glb.json["accessors"].back()["normalized"] = true;
  EXPECT_LT(glm::length(parse(glb).vertices[0].colour - glm::vec3(1, 0, 0.2f)), 1e-6);
}

TEST(Rig, FaultsOfTheExtras) {
  const std::pair<std::function<void(Glb&)>, const char*> cases[] = {
      {[](Glb& g) { g.json["scenes"][0].erase("extras"); }, "docs/rig.md"},
      {[](Glb& g) { extras(g)["legs"] = nlohmann::json::array(); }, "skitter.legs is an array of 0"},
      {[](Glb& g) { extras(g)["legs"] = std::vector<nlohmann::json>(25, leg(g)); },
       "skitter.legs is an array of 25"},
      {[](Glb& g) { extras(g).erase("groups"); }, "skitter.groups is missing"},
      {[](Glb& g) {
         extras(g)["groups"] = {"A", "A"};
       },
       "twice"},
      {[](Glb& g) {
         extras(g)["groups"] = {"A", "B"};
       },
       "no leg is in group \"B\""},
      {[](Glb& g) { extras(g)["bodyHeight"] = 0; }, "skitter.bodyHeight is 0"},
      {[](Glb& g) { extras(g)["bodyHigh"] = 0; }, "unknown key \"bodyHigh\""},
      {[](Glb& g) { leg(g)["group"] = "C"; }, "skitter.legs[0].group is \"C\""},
      {[](Glb& g) { leg(g)["group"] = 7; }, "skitter.legs[0].group is 7"},
      {[](Glb& g) { leg(g)["joints"] = {"hip"}; }, "joints is an array of 1"},
      {[](Glb& g) { leg(g)["joints"] = std::vector<std::string>(17, "hip"); }, "joints is an array of 17"},
      {[](Glb& g) { leg(g)["joints"][1] = "ankle"; }, "joints[1]: no node is named \"ankle\""},
      {[](Glb& g) {
         leg(g)["joints"] = {"knee", "hip", "foot"};
       },
       "\"hip\" is above \"knee\""},
      {[](Glb& g) { leg(g)["joints"][2] = "knee"; }, "\"knee\" is named twice"},
      {[](Glb& g) { g.node("knee")["name"] = "hip"; }, "two nodes are named \"hip\""},
      {[](Glb& g) { leg(g)["coneHalfAngleDegrees"] = {40}; }, "1 angles, the leg 2 bones"},
      {[](Glb& g) {
         leg(g)["coneHalfAngleDegrees"] = {40, 181};
       },
       "coneHalfAngleDegrees[1] is 181"},
      {[](Glb& g) { g.node("knee").erase("translation"); }, "the bone at \"hip\" has length 0"},
      {[](Glb& g) { extras(g)["legs"].push_back(leg(g)); }, "two legs are named"},
      {[](Glb& g) {
         extras(g)["legs"].push_back(leg(g));
         extras(g)["legs"][1]["name"] = "other";
       },
       "is a joint of leg leg already"},
  };
  for (const auto& [change, expected] : cases) {
    const std::string what = faultOf(change);
    EXPECT_NE(what.find(expected), std::string::npos) << what << "\nexpected: " << expected;
  }
}

TEST(Rig, FaultsOfTheFile) {
  const std::pair<std::function<void(Glb&)>, const char*> cases[] = {
      {[](Glb& g) { g.json["accessors"][0]["count"] = 4; }, "reaches past"},
      {[](Glb& g) { g.json["accessors"][0]["count"] = 4000000000u; }, "4000000000 elements"},
      {[](Glb& g) { g.json["accessors"][0]["byteOffset"] = 4; }, "reaches past"},
      {[](Glb& g) { g.json["accessors"][0]["bufferView"] = 9; }, "bufferView is 9"},
      {[](Glb& g) { g.json["accessors"][0]["type"] = "VEC2"; }, "wrong type"},
      {[](Glb& g) { g.json["accessors"][1]["componentType"] = 5130; }, "component type 5130"},
      {[](Glb& g) { g.json["bufferViews"][0]["buffer"] = 3; }, "buffer"},
      {[](Glb& g) { g.json["bufferViews"][2]["byteLength"] = 64; }, "bufferViews[2] reaches past"},
      {[](Glb& g) { g.json["bufferViews"][2]["byteOffset"] = 4294967290u; }, "small.glb"},
      {[](Glb& g) { g.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 12; }, "POSITION is 12"},
      {[](Glb& g) { g.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = -2; }, "POSITION is -2"},
      {[](Glb& g) { g.json["meshes"][0]["primitives"][0]["attributes"].erase("WEIGHTS_0"); }, "alone"},
      {[](Glb& g) { g.json["meshes"][0]["primitives"][0]["mode"] = 1; }, "no mesh with triangles"},
      {[](Glb& g) { g.json["meshes"][0]["primitives"][0]["indices"] = 1; }, "indices"},
      {[](Glb& g) { g.json["nodes"][0]["mesh"] = 5; }, "nodes[0].mesh is 5"},
      {[](Glb& g) { g.json["nodes"][0]["skin"] = 5; }, "nodes[0].skin is 5"},
      {[](Glb& g) { g.json["nodes"][0].erase("mesh"); }, "no mesh with triangles"},
      {[](Glb& g) { g.json["nodes"][4]["children"] = {99}; }, "a child of nodes[4] is 99"},
      {[](Glb& g) { g.json["nodes"][4]["children"] = {2}; }, "nodes[2] is a child of"},
      {[](Glb& g) { g.json["nodes"][4]["children"] = {1}; }, "their own ancestors"},
      {[](Glb& g) {
         g.json["nodes"][1]["translation"] = {0, 1};
       },
       "translation has 2 numbers"},
      {[](Glb& g) {
         g.json["nodes"][1]["translation"] = {0, 1e300, 0};
       },
       "translation holds"},
      {[](Glb& g) { g.json["scenes"][0]["nodes"] = {77}; }, "scenes[0] is 77"},
      {[](Glb& g) { g.json["scene"] = 3; }, "scene is 3"},
      {[](Glb& g) {
         g.json["skins"][0]["joints"] = {1, 2, 3};
       },
       "uses joint 3, but skins[0] has 3"},
      {[](Glb& g) {
         g.json["skins"][0]["joints"] = {1, 2, 3, 40};
       },
       "a joint of skins[0] is 40"},
      {[](Glb& g) { g.json["skins"][0]["inverseBindMatrices"] = 0; }, "wrong type"},
      {[](Glb& g) { g.json["buffers"][0]["byteLength"] = 97000; }, "byteLength says 97000"},
      {[](Glb& g) { g.json["buffers"][0]["uri"] = "other.bin"; }, "refers to \"other.bin\""},
      {[](Glb& g) { g.json["extensionsRequired"] = {"KHR_draco_mesh_compression"}; },
       "KHR_draco_mesh_compression"},
      {[](Glb& g) { g.json = nlohmann::json::array(); }, "not an object"},
      {[](Glb& g) {
         const float nan = std::numeric_limits<float>::quiet_NaN();
         std::memcpy(g.data(0), &nan, 4);
       },
       "holds nan in element 0"},
      {[](Glb& g) {
         const float negative = -1;
         std::memcpy(g.data(2), &negative, 4);
       },
       "weight -1 at vertex 0"},
  };
  for (const auto& [change, expected] : cases) {
    const std::string what = faultOf(change);
    EXPECT_NE(what.find(expected), std::string::npos) << what << "\nexpected: " << expected;
  }
}

TEST(Rig, EveryTruncationIsRefused) {
  const std::vector<uint8_t> whole = smallestRig().bytes();
  for (size_t size = 0; size < whole.size(); ++size) {
    inputFault([&] { parseRig(std::span(whole).first(size), "cut.glb"); });
  }
}

TEST(Rig, DamagedFilesAreRefusedOrReadButNeverWorse) {
  const std::vector<uint8_t> whole = test::readBytes(SKITTER_ROOT "/assets/spider.glb");
  const std::vector<uint8_t> small = smallestRig().bytes();
  std::mt19937 random(1);
  size_t refused = 0;
  for (int round = 0; round < 400; ++round) {
    std::vector<uint8_t> bytes = round % 20 == 0 ? whole : small;
    for (int k = 0; k < 1 + round % 4; ++k) bytes[random() % bytes.size()] = static_cast<uint8_t>(random());
    try {
      const Rig rig = parseRig(bytes, "damaged.glb");
      for (uint32_t index : rig.indices) ASSERT_LT(index, rig.vertices.size());
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), Error::Kind::input);
      ++refused;
    }
  }
  EXPECT_GT(refused, 100u);
}

TEST(Rig, FilesAreRefusedByName) {
  test::TemporaryFolder folder;
  EXPECT_NE(inputFault([&] { loadRig(folder / "none.glb"); }).find("none.glb: no such file"),
            std::string::npos);
  EXPECT_NE(inputFault([&] { loadRig(folder.path()); }).find("is a directory"), std::string::npos);
  test::writeText(folder / "text.glb", "{\"asset\": {\"version\": \"2.0\"}}");
  EXPECT_NE(inputFault([&] { loadRig(folder / "text.glb"); }).find("has no legs"), std::string::npos);
}

TEST(Rig, ModelsThatNobodyPreparedAreRefusedForTheirLegs) {
  test::TemporaryFolder folder;
  test::writeMadeModels(folder.path());
  for (const test::MadeModel& model : test::madeModels()) {
    const std::string what = inputFault([&] { loadRig(folder / model.file); });
    EXPECT_NE(what.find("skitter rig"), std::string::npos) << what;
  }
}

}  // namespace
}  // namespace skitter
