#include "cpu_reference/stages/pose.h"

#include <gtest/gtest.h>

#include <random>

#include "cpu_reference/ik/kinematics.h"
#include "spider.h"

namespace skitter::test {
namespace {

// The shortest rotation of unit vector a onto unit vector b (Rodrigues).
glm::dmat3 shortestArc(const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 v = glm::cross(a, b);
  const glm::dmat3 k{glm::dvec3(0, v.z, -v.y), glm::dvec3(-v.z, 0, v.x), glm::dvec3(v.y, -v.x, 0)};
  return glm::dmat3(1) + k + k * k / (1 + glm::dot(a, b));
}

TEST(Pose, obeysTheShortestArcRecursion) {
  const reference::Creature creature = spiderCreature();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> spread(-0.5, 0.5);
  reference::AgentBody body = bodyAt(3, 4, 1);
  body.orientation = glm::normalize(glm::dquat(0.9, 0.1, -0.3, 0.2));
  for (int trial = 0; trial < 200; ++trial) {
    const reference::Limb& limb = creature.limbs[static_cast<size_t>(trial) % 8];
    std::vector<glm::dvec2> directions(4);
    for (auto& xy : directions) xy = {spread(random), spread(random)};
    const auto entries = reference::pose(limb, body, directions);
    const reference::Posture posture(limb, directions);
    const glm::dmat3 r0 = glm::mat3_cast(body.orientation);
    glm::dmat3 rotation = r0;
    glm::dvec3 joint = r0 * limb.root;
    for (size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(glm::length(entries[i].position - joint), 0, 1e-6);
      const glm::dvec3 end = r0 * (limb.root + limb.reach * posture.joint(i + 1));
      const glm::dvec3 u = glm::normalize(end - joint);
      EXPECT_NEAR(glm::length(end - joint), limb.bones[i].length * limb.reach, 1e-6);
      rotation = shortestArc(glm::normalize(rotation * limb.bones[i].frame[2]), u) * rotation;
      const glm::dmat3 got = glm::mat3_cast(entries[i].rotation);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(glm::length(got[c] - rotation[c]), 0, 1e-6);
      joint = end;
    }
  }
}

TEST(Pose, restIsTheBodysRotation) {
  const reference::Creature creature = spiderCreature();
  const reference::AgentBody body = bodyAt(3, 4, 1);
  const auto entries = reference::pose(creature.limbs[0], body, std::vector<glm::dvec2>(4));
  for (size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(entries[i].rotation.w, 1, 1e-12);
    EXPECT_NEAR(glm::length(entries[i].position - creature.limbs[0].bones[i].start), 0, 1e-6);
  }
}

}  // namespace
}  // namespace skitter::test
