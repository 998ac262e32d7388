#include <gtest/gtest.h>

#include "render/mesh.h"

namespace skitter::render {
namespace {

TEST(Mesh, everyLevelIsCoarserAndWithinItsRange) {
  const Rig rig = spiderRig();
  const MeshData mesh = makeMesh(rig);
  EXPECT_EQ(mesh.lods[0].indexCount, rig.indices.size());
  for (size_t i = 0; i < mesh.lods.size(); ++i) {
    const MeshLod& lod = mesh.lods[i];
    EXPECT_GT(lod.indexCount, 0u);
    EXPECT_EQ(lod.indexCount % 3, 0u);
    if (i > 0) {
      EXPECT_LT(float(lod.indexCount), 0.6f * float(mesh.lods[i - 1].indexCount)) << "level " << i;
    }
    for (uint32_t k = 0; k < lod.indexCount; ++k)
      ASSERT_LT(uint32_t(lod.firstVertex) + mesh.indices[lod.firstIndex + k], mesh.vertices.size());
  }
}

TEST(Mesh, verticesAtRestAreWhereTheRigHasThem) {
  const Rig rig = spiderRig();
  const MeshData mesh = makeMesh(rig);
  const auto restStart = [&](uint32_t entry) {
    if (entry == 0) return glm::vec3(0);
    return rig.legs[(entry - 1) / uint32_t(rig.maxBones())]
        .bones[(entry - 1) % uint32_t(rig.maxBones())]
        .start;
  };
  // Level 0 keeps the rig's triangles, in an order of its own: the sums over all corners agree.
  glm::dvec3 expected(0), found(0);
  for (const uint32_t index : rig.indices) expected += glm::dvec3(glm::abs(rig.vertices[index].position));
  for (uint32_t k = 0; k < mesh.lods[0].indexCount; ++k) {
    const MeshVertex& vertex = mesh.vertices[mesh.indices[mesh.lods[0].firstIndex + k]];
    glm::vec3 position(0);
    float weight = 0;
    for (int i = 0; i < 4; ++i) {
      position += vertex.influences[i].w * (glm::vec3(vertex.influences[i]) + restStart(vertex.bones[i]));
      weight += vertex.influences[i].w;
    }
    ASSERT_NEAR(weight, 1.0f, 1e-3f);
    found += glm::dvec3(glm::abs(position));
  }
  EXPECT_LT(glm::length(found - expected), 1e-4 * glm::length(expected));
}

TEST(Mesh, aRigWithoutSkinIsLegal) {
  Rig rig = spiderRig();
  rig.vertices.clear();
  rig.indices.clear();
  EXPECT_EQ(makeMesh(rig).lods[0].indexCount, 0u);
}

}  // namespace
}  // namespace skitter::render
