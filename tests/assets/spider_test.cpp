#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <glm/gtc/constants.hpp>
#include <set>

#include "files.h"
#include "skitter/rig.h"

namespace skitter {
namespace {

const Rig& spider() {
  static const Rig rig = spiderRig();
  return rig;
}

TEST(Spider, EightLegsOfFourBones) {
  EXPECT_EQ(spider().name, "spider");
  ASSERT_EQ(spider().legCount(), 8);
  EXPECT_EQ(spider().maxBones(), 4);
  EXPECT_EQ(spider().paletteSize(), 33);
  EXPECT_FLOAT_EQ(spider().legLength, 1);
  const float lengths[] = {0.10f, 0.35f, 0.32f, 0.23f};
  for (const Leg& leg : spider().legs) {
    SCOPED_TRACE(leg.name);
    ASSERT_EQ(leg.bones.size(), 4u);
    EXPECT_FLOAT_EQ(leg.reach, 1);
    for (size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(leg.bones[i].length, lengths[i], 1e-6);
      EXPECT_NEAR(glm::length(leg.bones[i].direction), 1, 1e-6);
      const glm::vec3 end = leg.bones[i].start + leg.bones[i].length * leg.bones[i].direction;
      EXPECT_LT(glm::length(end - (i < 3 ? leg.bones[i + 1].start : leg.home)), 1e-6);
    }
    EXPECT_EQ(leg.bones[0].joint, leg.name + "_coxa");
    EXPECT_FLOAT_EQ(leg.bones[0].coneHalfAngle, glm::radians(60.0f));
    EXPECT_FLOAT_EQ(leg.bones[3].coneHalfAngle, glm::radians(65.0f));
  }
}

TEST(Spider, StandsOnTheGroundWithItsKneesUp) {
  float top = 0;
  for (const SkinVertex& vertex : spider().vertices) {
    EXPECT_GE(vertex.position.y, -1e-6f);
    if (vertex.bones[0] == 0 && vertex.weights[0] == 1) top = std::max(top, vertex.position.y);
  }
  EXPECT_GT(spider().bodyHeight, 0.2f);
  for (const Leg& leg : spider().legs) {
    SCOPED_TRACE(leg.name);
    EXPECT_NEAR(leg.home.y, 0, 1e-6);
    EXPECT_GT(leg.bones[2].start.y, top + 0.05f);
    // All joints in one vertical plane.
    const glm::vec3 out = leg.home - leg.root();
    for (const Bone& bone : leg.bones) {
      const glm::vec3 to = bone.start - leg.root();
      EXPECT_NEAR(out.x * to.z - out.z * to.x, 0, 1e-5);
    }
  }
}

TEST(Spider, LeftIsPlusXAndGroupsAlternate) {
  const std::set<std::string> inA{"L1", "R2", "L3", "R4"};
  ASSERT_EQ(spider().groups, (std::vector<std::string>{"A", "B"}));
  float forwardOfLast[2] = {10, 10};
  for (const Leg& leg : spider().legs) {
    const bool left = leg.name[0] == 'L';
    EXPECT_EQ(leg.home.x > 0, left) << leg.name;
    EXPECT_EQ(leg.group, inA.count(leg.name) ? 0 : 1) << leg.name;
    EXPECT_LT(leg.home.z, forwardOfLast[left]) << leg.name;
    forwardOfLast[left] = leg.home.z;
  }
}

TEST(Spider, SkinIsSound) {
  const Rig& rig = spider();
  ASSERT_EQ(rig.indices.size() % 3, 0u);
  EXPECT_GE(rig.indices.size() / 3, 600u);
  EXPECT_LE(rig.indices.size() / 3, 1500u);
  std::set<uint16_t> used;
  for (const SkinVertex& vertex : rig.vertices) {
    float sum = 0;
    for (int k = 0; k < 4; ++k) {
      sum += vertex.weights[k];
      EXPECT_GE(vertex.weights[k], 0);
      ASSERT_LT(vertex.bones[k], rig.paletteSize());
      if (vertex.weights[k] > 0) used.insert(vertex.bones[k]);
    }
    EXPECT_NEAR(sum, 1, 1e-6);
    EXPECT_NEAR(glm::length(vertex.normal), 1, 1e-5);
    EXPECT_GE(vertex.colour.r, 0);
    EXPECT_LE(vertex.colour.r, 1);
  }
  EXPECT_EQ(used.size(), 33u);
}

TEST(Spider, FacesTurnOutward) {
  const Rig& rig = spider();
  double volume = 0;
  size_t against = 0;
  for (size_t t = 0; t < rig.indices.size(); t += 3) {
    const SkinVertex *a = &rig.vertices[rig.indices[t]], *b = &rig.vertices[rig.indices[t + 1]],
                     *c = &rig.vertices[rig.indices[t + 2]];
    const glm::vec3 face = glm::cross(b->position - a->position, c->position - a->position);
    EXPECT_GT(glm::length(face), 1e-8f);
    volume += glm::dot(face, a->position) / 6;
    against += glm::dot(face, a->normal + b->normal + c->normal) <= 0;
  }
  EXPECT_GT(volume, 0.01);  // cubic metres; inside out it would be negative
  EXPECT_EQ(against, 0u);
}

TEST(Spider, IsItsOwnMirrorImage) {
  const Rig& rig = spider();
  for (size_t i = 0; i < rig.legs.size(); i += 2) {
    const glm::vec3 left = rig.legs[i].home, right = rig.legs[i + 1].home;
    EXPECT_LT(glm::length(left - glm::vec3(-right.x, right.y, right.z)), 1e-6);
  }
}

TEST(Spider, GeneratorWritesTheCommittedBytes) {
  test::TemporaryFolder folder;
  const std::string command =
      std::string("\"" SKITTER_PYTHON "\" \"" SKITTER_ROOT "/assets/spider/generate.py\" \"") +
      (folder / "spider.glb").string() + "\" > /dev/null";
  ASSERT_EQ(std::system(command.c_str()), 0);
  EXPECT_TRUE(test::readBytes(folder / "spider.glb") == test::readBytes(SKITTER_ROOT "/assets/spider.glb"))
      << "assets/spider.glb is not what assets/spider/generate.py writes";
}

TEST(ShippedModels, KhronosValidatorFindsNothing) {
  if (!std::filesystem::exists(SKITTER_ROOT "/build/gltf-validator/node_modules/gltf-validator")) {
    GTEST_SKIP() << "Needs the Khronos glTF validator, which `scripts/validate-gltf --install` puts into "
                    "build/gltf-validator.";
  }
  test::TemporaryFolder folder;
  size_t models = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(SKITTER_ROOT "/assets")) {
    if (entry.path().extension() != ".glb") continue;
    SCOPED_TRACE(entry.path());
    ++models;
    const std::string report = (folder / "report").string();
    const std::string command =
        "\"" SKITTER_ROOT "/scripts/validate-gltf\" \"" + entry.path().string() + "\"";
    EXPECT_EQ(std::system((command + " > \"" + report + "\"").c_str()), 0);
    const std::vector<uint8_t> bytes = test::readBytes(report);
    // No errors, no warnings.
    EXPECT_EQ(std::string(bytes.begin(), bytes.end()), "GOOD " + entry.path().string() + " 0 0\n");
  }
  EXPECT_GE(models, 2u);
}

}  // namespace
}  // namespace skitter
