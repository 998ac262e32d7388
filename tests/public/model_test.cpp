#include "skitter/model.h"

#include "public/public.h"

namespace skitter::test {
namespace {

TEST(PublicModel, KnowsItsNodes) {
  const Model model = loadModel(assetFile("quadruped.glb"));
  EXPECT_GT(model.jointCount(), 0u);
  EXPECT_LE(model.jointCount(), model.nodes.size());
  ASSERT_EQ(model.parentsFirst.size(), model.nodes.size());
  for (size_t i = 0; i < model.nodes.size(); ++i) {
    const auto node = static_cast<int>(i);
    const Model::Node& of = model.nodes[i];
    EXPECT_EQ(of.position(), glm::dvec3(of.modelFromNode[3]));
    EXPECT_FALSE(model.isAncestor(node, node));
    if (of.parent >= 0) {
      EXPECT_TRUE(model.isAncestor(of.parent, node));
      EXPECT_FALSE(model.isAncestor(node, of.parent));
    }
    const std::string name = model.reference(node);
    EXPECT_TRUE(name == of.name || name == "#" + std::to_string(node)) << name;
  }
}

TEST(PublicModel, SharedNamesAreNumbers) {
  Model model;
  model.nodes.resize(3);
  model.nodes[0].name = model.nodes[2].name = "leg";
  model.nodes[1].name = "body";
  EXPECT_EQ(model.reference(0), "#0");
  EXPECT_EQ(model.reference(1), "body");
  EXPECT_FALSE(model.isAncestor(0, -1));
}

TEST(PublicModel, RefusesNodesThatItDoesNotHave) {
  Model model;
  model.name = "own";
  model.nodes.resize(2);
  expectRefused("own: node 2, expected one of 2 nodes", [&] { model.reference(2); });
  expectRefused("own: node -1", [&] { model.reference(-1); });
  expectRefused("own: node 2", [&] { model.isAncestor(0, 2); });
}

TEST(PublicModel, RefusesFilesByTheirNames) {
  const OwnFolder folder;
  expectRefused("nowhere.glb", [&] { loadModel(folder / "nowhere.glb"); });
  expectRefused("own.glb", [&] { loadModel(folder.with("own.glb", "no model")); });
}

}  // namespace
}  // namespace skitter::test
