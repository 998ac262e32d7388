#include "skitter/model.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstring>
#include <functional>
#include <limits>

#include "files.h"
#include "glb_builder.h"
#include "skitter/rig_setup.h"

// glTF as people bring it: each oddity is read for what it means, or refused for what it is.
namespace skitter {
namespace {

using test::Glb;
using test::inputFault;
using test::smallestRig;

class Models : public ::testing::Test {
 protected:
  Model load(const Glb& glb) const {
    test::writeBytes(folder_ / "odd.glb", glb.bytes());
    return loadModel(folder_ / "odd.glb");
  }
  // The same as text, its buffer at `uri`.
  std::filesystem::path writeText(const Glb& glb, const std::string& uri) const {
    nlohmann::json json = glb.json;
    json["buffers"][0]["uri"] = uri;
    test::writeText(folder_ / "odd.gltf", json.dump());
    return folder_ / "odd.gltf";
  }
  static bool hasNote(const Model& model, const std::string& words) {
    for (const std::string& note : model.notes) {
      if (note.find(words) != std::string::npos) return true;
    }
    return false;
  }
  static nlohmann::json& attributes(Glb& glb) { return glb.json["meshes"][0]["primitives"][0]["attributes"]; }

  test::TemporaryFolder folder_;
};

TEST_F(Models, CountsWhatTheFileHolds) {
  const Model model = load(smallestRig());
  EXPECT_EQ(model.skins, 1u);
  EXPECT_EQ(model.jointCount(), 4u);
  EXPECT_EQ(model.nodes.size(), 5u);
  EXPECT_EQ(model.vertices.size(), 3u);
  EXPECT_EQ(model.indices, (std::vector<uint32_t>{0, 1, 2}));
  EXPECT_TRUE(model.clips.empty());
}

TEST_F(Models, TextWithBuffersInTheFileAndBeside) {
  Glb glb = smallestRig();
  test::writeBytes(folder_ / "the data.bin", glb.binary);
  const Model beside = loadModel(writeText(glb, "the%20data.bin"));
  EXPECT_EQ(beside.vertices.size(), 3u);
  // Twelve bytes of positions: enough for one vertex of a mesh without a skin.
  glb.json = {{"asset", {{"version", "2.0"}}},
              {"nodes", {{{"mesh", 0}}}},
              {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}}}}}}},
              {"accessors", {{{"bufferView", 0}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}}}},
              {"bufferViews", {{{"buffer", 0}, {"byteLength", 36}}}},
              {"buffers", {{{"byteLength", 36}}}}};
  const std::string zeros(48, 'A');
  EXPECT_EQ(loadModel(writeText(glb, "data:application/octet-stream;base64," + zeros)).vertices.size(), 3u);
}

TEST_F(Models, BuffersThatCannotBeHad) {
  const Glb glb = smallestRig();
  test::writeBytes(folder_ / "short.bin", {1, 2, 3});
  const std::pair<const char*, const char*> cases[] = {
      {"none.bin", "none.bin: no such file"},
      {"short.bin", "has 3 bytes, its byteLength says 96"},
      {"/etc/passwd", "expected a file in its folder"},
      {"http://example.com/a.bin", "expected a file in its folder"},
      {"file:a.bin", "expected a file in its folder"},
      {".", "is a directory"},
      {"data:application/octet-stream,text", "not base64"},
      {"data:application/octet-stream;base64,A*==", "not base64"},
  };
  for (const auto& [uri, expected] : cases) {
    const std::string what = inputFault([&, from = uri] { loadModel(writeText(glb, from)); });
    EXPECT_NE(what.find("odd.gltf: buffers[0]"), std::string::npos) << what;
    EXPECT_NE(what.find(expected), std::string::npos) << what;
  }
}

TEST_F(Models, BuffersOutsideTheFolderAreNotRead) {
  const Glb glb = smallestRig();
  const test::TemporaryFolder outside;
  test::writeBytes(outside / "a.bin", glb.binary);
  test::writeBytes(folder_ / "a.bin", glb.binary);
  std::filesystem::create_directory_symlink(outside.path(), folder_ / "elsewhere");
  std::filesystem::create_symlink(outside / "a.bin", folder_ / "out.bin");
  std::filesystem::create_symlink("a.bin", folder_ / "in.bin");
  const std::string up = "../" + outside.path().filename().string() + "/a.bin";
  for (const std::string& uri : {up, "%2e%2e" + up.substr(2), "elsewhere/../" + up,
                                 std::string("elsewhere/a.bin"), std::string("out.bin")}) {
    const std::string what = inputFault([&] { loadModel(writeText(glb, uri)); });
    EXPECT_NE(what.find("expected a file in its folder"), std::string::npos) << what;
  }
  const std::string back = "../" + folder_.path().filename().string() + "/a.bin";
  for (const std::string& uri : {std::string("in.bin"), std::string("./a.bin"), back}) {
    EXPECT_EQ(loadModel(writeText(glb, uri)).vertices.size(), 3u) << uri;
  }
}

TEST_F(Models, ArmatureScaledAndTurned) {
  Glb glb = smallestRig();
  glb.node("body")["scale"] = {100, 100, 100};
  const Model model = load(glb);
  EXPECT_LT(glm::length(model.nodes[4].position() - glm::dvec3(100, -99, 0)), 1e-9);
  EXPECT_TRUE(hasNote(model, "4 joints are scaled"));
}

TEST_F(Models, TransformOfASkinnedMeshNodeIsIgnored) {
  Glb glb = smallestRig();
  const Model plain = load(glb);
  glb.json["nodes"][0]["translation"] = {5, 5, 5};
  const Model moved = load(glb);
  EXPECT_EQ(plain.vertices[0].position, moved.vertices[0].position);
  EXPECT_TRUE(hasNote(moved, "skinning ignores it"));
}

TEST_F(Models, NegativeScaleTurnsTheTrianglesRound) {
  Glb glb = smallestRig();
  glb.node("body")["scale"] = {-1, 1, 1};
  const Model model = load(glb);
  EXPECT_EQ(model.indices, (std::vector<uint32_t>{0, 2, 1}));
  EXPECT_TRUE(hasNote(model, "4 joints are mirrored"));
}

TEST_F(Models, TwelveInfluences) {
  Glb glb = smallestRig();
  const std::vector<uint8_t> joints = {2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1};
  const std::vector<float> weights = {0.5f, 0.25f, 0.125f, 0.0625f, 0.5f, 0, 0, 0, 0.5f, 0, 0, 0};
  const std::vector<float> none(12);
  attributes(glb)["JOINTS_1"] = glb.append(joints, "VEC4");
  attributes(glb)["WEIGHTS_1"] = glb.append(weights, "VEC4");
  attributes(glb)["JOINTS_2"] = glb.append(joints, "VEC4");
  attributes(glb)["WEIGHTS_2"] = glb.append(none, "VEC4");
  const Model model = load(glb);
  EXPECT_EQ(model.vertices[0].influences, 6u);
  double sum = 0;
  for (uint32_t k = 0; k < 6; ++k) sum += model.influences[model.vertices[0].firstInfluence + k].weight;
  EXPECT_NEAR(sum, 1, 1e-12);
  EXPECT_TRUE(hasNote(model, "3 vertices' weights do not sum to 1"));
  EXPECT_TRUE(hasNote(model, "1 vertices have over four joints"));
}

// Some exporters write weights of 0 / 0.
TEST_F(Models, WeightsThatAreNotFiniteCountAsZero) {
  const float nan = std::numeric_limits<float>::quiet_NaN(),
              infinity = std::numeric_limits<float>::infinity();
  Glb glb = smallestRig();
  const float weights[] = {nan, 0.5f, 0, 0, nan, nan, nan, infinity, 0.5f, 0.5f, 0, 0};
  std::memcpy(glb.data(2), weights, sizeof(weights));
  const Model model = load(glb);
  EXPECT_TRUE(hasNote(model, "WEIGHTS_0 has 5 numbers that are not finite: they count as 0"));
  EXPECT_TRUE(hasNote(model, "1 vertices have no weight: each follows the joint that it names first"));
  const auto follows = [&](size_t vertex) {
    const Model::Vertex& v = model.vertices[vertex];
    EXPECT_EQ(v.influences, 1u);
    EXPECT_EQ(model.influences[v.firstInfluence].weight, 1);
    return model.nodes[model.influences[v.firstInfluence].node].name;
  };
  EXPECT_EQ(follows(0), "hip");
  EXPECT_EQ(follows(1), "hip");  // it names hip, then knee
}

TEST_F(Models, SparsePositions) {
  Glb glb = smallestRig();
  glb.append(std::vector<uint16_t>{2}, "SCALAR");
  glb.append(std::vector<float>{7, 8, 9}, "VEC3");
  glb.json["accessors"][0]["sparse"] = {{"count", 1},
                                        {"indices", {{"bufferView", 3}, {"componentType", 5123}}},
                                        {"values", {{"bufferView", 4}}}};
  glb.json["nodes"][0].erase("skin");
  EXPECT_EQ(load(glb).vertices[2].position, glm::dvec3(7, 8, 9));
  // Without data of its own the accessor is zeros but for the sparse ones.
  glb.json["accessors"][0].erase("bufferView");
  const Model model = load(glb);
  EXPECT_EQ(model.vertices[0].position, glm::dvec3(0));
  EXPECT_EQ(model.vertices[2].position, glm::dvec3(7, 8, 9));
}

TEST_F(Models, StridedPositions) {
  Glb glb = smallestRig();
  const size_t accessor = glb.append(std::vector<float>{1, 2, 3, 99, 4, 5, 6, 99, 7, 8, 9, 99}, "VEC4");
  glb.json["accessors"].back()["type"] = "VEC3";
  glb.json["bufferViews"].back()["byteStride"] = 16;
  attributes(glb)["POSITION"] = accessor;
  glb.json["nodes"][0].erase("skin");
  EXPECT_EQ(load(glb).vertices[2].position, glm::dvec3(7, 8, 9));
}

TEST_F(Models, SeveralMeshesAndSkinsBecomeOne) {
  Glb glb = smallestRig();
  glb.json["skins"].push_back({{"joints", {4, 3, 2, 1}}});
  glb.json["meshes"].push_back(glb.json["meshes"][0]);
  glb.json["nodes"].push_back({{"mesh", 1}, {"skin", 1}});
  glb.json["scenes"][0]["nodes"].push_back(5);
  const Model model = load(glb);
  EXPECT_EQ(model.skins, 2u);
  EXPECT_EQ(model.primitives, 2u);
  EXPECT_EQ(model.vertices.size(), 6u);
  EXPECT_EQ(model.indices, (std::vector<uint32_t>{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(model.influences[model.vertices[3].firstInfluence].node, 4u);
}

TEST_F(Models, MissingImagesAndBadClipsAreNotFatal) {
  Glb glb = smallestRig();
  glb.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
  glb.json["meshes"][0]["primitives"][0]["material"] = 0;
  glb.json["images"] = {{{"uri", "none.png"}}};
  glb.json["textures"] = {{{"source", 0}}};
  glb.json["animations"] = {
      {{"samplers", {{{"input", 77}, {"output", 0}}}},
       {"channels", {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}}}}},
      {{"name", "odd"}}};
  const Model model = load(glb);
  EXPECT_TRUE(model.clips.empty());
  EXPECT_TRUE(hasNote(model, "none.png: no such file: drawn as a flat colour"));
  EXPECT_TRUE(hasNote(model, "animations[0].samplers[0].input is 77"));
  EXPECT_TRUE(hasNote(model, "animations[1] is malformed"));
}

TEST_F(Models, ClipsAreNamedAndTimed) {
  Glb glb = smallestRig();
  const size_t input = glb.append(std::vector<float>{0, 0.5f, 1.25f}, "SCALAR");
  glb.json["animations"] = {
      {{"name", "walk"},
       {"samplers", {{{"input", input}, {"output", 0}}}},
       {"channels", {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}}}}}};
  const Model model = load(glb);
  ASSERT_EQ(model.clips.size(), 1u);
  EXPECT_EQ(model.clips[0].name, "walk");
  EXPECT_EQ(model.clips[0].seconds, 1.25);
  EXPECT_EQ(model.clips[0].channels, 1u);
}

TEST_F(Models, NamesSharedOrMissingBecomeIndices) {
  Glb glb = smallestRig();
  glb.node("knee")["name"] = "hip";
  glb.node("foot").erase("name");
  const Model model = load(glb);
  EXPECT_EQ(model.reference(1), "body");
  EXPECT_EQ(model.reference(2), "#2");
  EXPECT_EQ(model.reference(3), "#3");
  EXPECT_EQ(model.reference(4), "#4");
}

TEST_F(Models, StrangeHierarchiesEndSoon) {
  // A comb of joints, each with a tooth, and a mesh placed by each of many nodes.
  Glb glb = smallestRig();
  for (int i = 0; i < 10000; ++i) {
    const size_t next = glb.json["nodes"].size();
    glb.json["nodes"].back()["children"] = {next, next + 1};
    glb.json["nodes"].push_back({{"mesh", 0}, {"skin", 0}});
    glb.json["nodes"].push_back({{"translation", {0, 0, 1}}});
  }
  const auto start = std::chrono::steady_clock::now();
  const Model model = load(glb);
  EXPECT_EQ(model.primitives, 10001u);
  EXPECT_TRUE(hasNote(model, "10000 skinned meshes' nodes are placed"));
  EXPECT_TRUE(proposeRig(model).setup.legs.empty());
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
}

TEST_F(Models, WholeNumbersMayBeWrittenAsFloats) {
  Glb glb = smallestRig();
  glb.json["nodes"][0]["mesh"] = 0.0;
  glb.json["accessors"][0]["count"] = 3.0;
  EXPECT_EQ(load(glb).vertices.size(), 3u);
  glb.json["accessors"][0]["count"] = 2.5;
  EXPECT_NE(inputFault([&] { load(glb); }).find("odd.glb: "), std::string::npos);
}

TEST_F(Models, ColoursAreWithinOne) {
  Glb glb = smallestRig();
  attributes(glb)["COLOR_0"] = glb.append(std::vector<float>{-1, 0.5f, 3e38f, 0, 0, 0, 1, 1, 1}, "VEC3");
  EXPECT_EQ(load(glb).vertices[0].colour, glm::vec3(0, 0.5f, 1));
}

TEST_F(Models, ClipsWithIndicesThatNoneCanBe) {
  for (const nlohmann::json& index :
       {nlohmann::json(-1), nlohmann::json(1e300), nlohmann::json(1ull << 32)}) {
    Glb glb = smallestRig();
    glb.json["animations"] = {
        {{"samplers", {{{"input", 0}, {"output", 0}}}},
         {"channels", {{{"sampler", index}, {"target", {{"node", 1}, {"path", "translation"}}}}}}}};
    EXPECT_TRUE(hasNote(load(glb), "animations[0] has a channel whose sampler is " + index.dump())) << index;
  }
}

TEST_F(Models, FaultsAreTrueAndInOneLine) {
  const std::pair<std::function<void(Glb&)>, const char*> cases[] = {
      {[](Glb& g) { g.json["asset"]["version"] = "1.0"; }, "asset.version is \"1.0\""},
      {[](Glb& g) { g.json.erase("asset"); }, "asset.version is missing"},
      {[](Glb& g) { g.json["nodes"] = nlohmann::json::object(); }, "nodes is an object"},
      {[](Glb& g) {
         g.json["skins"].push_back({{"joints", {1, "2"}}});
       },
       "skins[1].joints is an array of 2, expected an array of indices"},
      {[](Glb& g) {
         g.json["nodes"][2]["translation"] = {0, 2e9, 0};
       },
       "nodes[2] rests at 2000000001, expected within 1000000000"},
      {[](Glb& g) { g.json["buffers"][0]["uri"] = "a%0Ab.bin"; }, "a b.bin: no such file"},
      {[](Glb& g) { g.json["extensionsRequired"] = {"A\nB"}; }, "requires extension \"A\\nB\""},
  };
  for (const auto& [change, expected] : cases) {
    Glb glb = smallestRig();
    change(glb);
    const std::string what = inputFault([&] { load(glb); });
    EXPECT_NE(what.find("odd.glb: "), std::string::npos) << what;
    EXPECT_NE(what.find(expected), std::string::npos) << what << "\nexpected: " << expected;
  }
  test::writeText(folder_ / "odd.gltf", "{\"asset\": {\"version\": \"2.0\"}, \"extras\": 1e309}");
  EXPECT_EQ(inputFault([&] { loadModel(folder_ / "odd.gltf"); }).find("valid"), std::string::npos);
  test::writeText(folder_ / "odd.gltf", "{\"asset\": \"" + std::string(1000000, 'a'));
  EXPECT_LT(inputFault([&] { loadModel(folder_ / "odd.gltf"); }).size(), 400u);
}

TEST_F(Models, AbsurdCountsAreRefusedBeforeMemoryIsTaken) {
  const std::pair<std::function<void(Glb&)>, const char*> cases[] = {
      {[](Glb& g) {
         g.json["accessors"][0].erase("bufferView");
         g.json["accessors"][0]["count"] = 1 << 24;
       },
       "elements without data"},
      {[](Glb& g) { g.json["nodes"] = std::vector<nlohmann::json>(70000, nlohmann::json::object()); },
       "nodes is an array of 70000"},
      {[](Glb& g) { g.json["buffers"] = std::vector<nlohmann::json>(2000, nlohmann::json::object()); },
       "buffers is an array of 2000"},
      {[](Glb& g) {
         g.json["buffers"] = std::vector<nlohmann::json>(3, {{"byteLength", 1u << 30}, {"uri", "one.bin"}});
       },
       "byteLengths are over 2147483648 in all"},
      {[](Glb& g) {
         g.json["skins"] = std::vector<nlohmann::json>(20, {{"joints", std::vector<int>(60000, 1)}});
       },
       "its skins have over 1048576 joints"},
      {[](Glb& g) { g.json["extras"] = std::vector<int>(2100000, 1); },
       "JSON has over 2097152 keys and values"},
  };
  for (const auto& [change, expected] : cases) {
    Glb glb = smallestRig();
    change(glb);
    const std::string what = inputFault([&] { load(glb); });
    EXPECT_NE(what.find(expected), std::string::npos) << what;
  }
}

}  // namespace
}  // namespace skitter
