#include "skitter/skin_mesh.h"

#include <algorithm>

#include "public/public.h"
#include "skitter/palettes.h"

namespace skitter::test {
namespace {

using PublicSkinMesh = PublicTest;

TEST_F(PublicSkinMesh, IsThatOfTheRigWithLevels) {
  const Crowd crowd(device(), flatGround(), standingScene(1));
  const SkinMesh mesh = skinMeshOf(crowd, 0);
  EXPECT_EQ(mesh.entries, Palettes::entriesOf(crowd, 0));
  EXPECT_GT(mesh.radius, 1);  // a leg reaches 1 m
  ASSERT_FALSE(mesh.levels.empty());
  EXPECT_LE(mesh.levels.front().indexCount, crowd.rig(0).indices.size());
  EXPECT_GT(mesh.levels.front().indexCount, crowd.rig(0).indices.size() / 2);
  EXPECT_EQ(mesh.levels.back().pixels, 0);
  for (const SkinMesh::Level& level : mesh.levels) {
    EXPECT_EQ(level.indexCount % 3, 0u);
    EXPECT_LE(level.firstIndex + level.indexCount, mesh.indices.size());
  }
  for (const uint32_t index : mesh.indices) ASSERT_LT(index, mesh.vertices.size());
  for (const SkinVertex& vertex : mesh.vertices)
    ASSERT_LT(*std::max_element(vertex.bones, vertex.bones + 4), mesh.entries);
}

TEST_F(PublicSkinMesh, IsInTheHostsSpace) {
  const Crowd crowd(device(), flatGround(), standingScene(1));
  const HostSpace space{.axes = Axes::leftZUp, .metresPerUnit = 0.5f};
  const SkinMesh own = skinMeshOf(crowd, 0), theirs = skinMeshOf(crowd, 0, space);
  ASSERT_EQ(own.vertices.size(), theirs.vertices.size());
  EXPECT_EQ(theirs.radius, 2 * own.radius);
  for (size_t i = 0; i < own.vertices.size(); ++i)
    ASSERT_EQ(theirs.vertices[i].position, glm::vec3(space.from(own.vertices[i].position))) << i;
}

TEST_F(PublicSkinMesh, RefusesWhatCannotBe) {
  const Crowd crowd(device(), flatGround(), standingScene(1));
  expectRefused("herd 7", [&] { skinMeshOf(crowd, 7); });
  expectRefused("metresPerUnit -1", [&] { skinMeshOf(crowd, 0, {.metresPerUnit = -1}); });
}

}  // namespace
}  // namespace skitter::test
