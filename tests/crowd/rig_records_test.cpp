// The rig's records: rest frames that two numbers a bone tell (docs/stages/ik.md).
#include "crowd/rig_records.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/glm.hpp>

#include "skitter/records.h"

namespace skitter::test {
namespace {

// By the half turn about the middle of z and d, as the shaders do not do it.
glm::dmat3 shortestFromZ(const glm::dvec2& s) {
  const glm::dvec3 d = glm::dvec3(2.0 * s, 1 - glm::dot(s, s)) / (1 + glm::dot(s, s));
  const glm::dvec3 axis(-d.y, d.x, 0);  // times the sine of the angle
  const auto turned = [&](const glm::dvec3& v) {
    return d.z * v + glm::cross(axis, v) + axis * (glm::dot(axis, v) / (1 + d.z));
  };
  return {turned({1, 0, 0}), turned({0, 1, 0}), d};
}

Rig rigOf(const std::vector<glm::vec3>& directions) {
  Rig rig;
  Leg leg;
  glm::vec3 at(0.1f, 0.2f, 0.3f);
  for (const glm::vec3& direction : directions) {
    leg.bones.push_back({"", at, glm::normalize(direction), 0.25f, 1.2f});
    at += 0.25f * leg.bones.back().direction;
    leg.reach += 0.25f;
  }
  leg.home = at;
  rig.legs.push_back(leg);
  return rig;
}

void expectFrames(const Rig& rig, double tolerance) {
  const std::vector<float> records = crowd::rigRecords(rig);
  const auto at = [&](size_t leg, size_t bone, size_t i) {
    const float* r = &records[4 * (leg * static_cast<size_t>(shared::rigStride(rig.maxBones())) +
                                   shared::RIG_LEG_STRIDE + shared::RIG_BONE_STRIDE * bone + i)];
    return glm::dvec4(r[0], r[1], r[2], r[3]);
  };
  for (size_t l = 0; l < rig.legs.size(); ++l) {
    glm::dmat3 before(1);
    for (size_t b = 0; b < rig.legs[l].bones.size(); ++b) {
      const Bone& bone = rig.legs[l].bones[b];
      const glm::dvec4 coordinates = at(l, b, 7);
      const glm::dmat3 carry = shortestFromZ(coordinates), frame = before * carry;
      const glm::dvec3 x(at(l, b, 0)), z(at(l, b, 1)), carryX(at(l, b, 5)), carryZ(at(l, b, 6));
      EXPECT_LT(glm::distance(z, glm::dvec3(bone.direction)), tolerance) << l << ", " << b;
      EXPECT_LT(glm::distance(frame[0], x), tolerance) << l << ", " << b;
      EXPECT_LT(glm::distance(frame[2], z), tolerance) << l << ", " << b;
      EXPECT_LT(glm::distance(carry[0], carryX), tolerance) << l << ", " << b;
      EXPECT_LT(glm::distance(carry[2], carryZ), tolerance) << l << ", " << b;
      EXPECT_NEAR(coordinates.z, bone.length / rig.legs[l].reach, 1e-6);
      EXPECT_NEAR(coordinates.w, std::cos(std::min(bone.coneHalfAngle, 3.0f)), 1e-6);
      before = glm::dmat3(x, glm::cross(z, x), z);
    }
  }
}

// The other numbers, as include/skitter/records.h lists them; a leg shorter than the longest is
// padded.
TEST(RigRecords, HoldWhatTheRigSays) {
  constexpr size_t stride = 3 + 4 * 8;
  Rig rig = spiderRig();
  rig.legs[3].bones.pop_back();
  rig.legs[3].reach = 0.77f;
  rig.legs[5].bones[1].coneHalfAngle = 3.1415927f;  // unlimited
  const std::vector<float> records = crowd::rigRecords(rig);
  ASSERT_EQ(records.size(), 8 * stride * 4);
  const auto expect = [&](size_t place, size_t number, double expected) {
    EXPECT_NEAR(records[4 * place + number], expected, 1e-6 * (1 + std::abs(expected)))
        << "number " << number << " of vec4 " << place % stride;
  };
  const auto expectAll = [&](size_t place, const glm::dvec3& xyz, double w) {
    for (size_t i = 0; i < 3; ++i) expect(place, i, xyz[static_cast<int>(i)]);
    expect(place, 3, w);
  };
  for (size_t l = 0; l < 8; ++l) {
    const Leg& leg = rig.legs[l];
    SCOPED_TRACE(leg.name);
    expectAll(l * stride, leg.bones[0].start, leg.reach);
    expectAll(l * stride + 1, leg.home, leg.group);
    expect(l * stride + 2, 2, 1 / leg.reach);
    for (size_t b = 0; b < 4; ++b) {
      const size_t bone = l * stride + 3 + 8 * b;
      const bool padding = b == leg.bones.size();
      // 3 radians stand for no limit: tan(pi / 2) is no number.
      const double half = padding ? 0 : std::min<double>(leg.bones[b].coneHalfAngle, 3) / 2;
      const double length = padding ? 0 : leg.bones[b].length / leg.reach;
      expect(bone, 3, length);
      expect(bone + 1, 3, std::tan(half));
      expectAll(bone + 2, padding ? leg.home : leg.bones[b].start, b == 0 ? 0.2 : 1);
      expectAll(bone + 3, glm::dvec3(0), 0);
      expectAll(bone + 4, {1, 0, 0}, 0);  // a cone, without a twist
      expect(bone + 5, 3, length);
      expect(bone + 6, 3, std::tan(half));
      expect(bone + 7, 2, length);
      expect(bone + 7, 3, std::cos(2 * half));
    }
  }
}

// Eight roundings of a float, from one frame to the next.
TEST(RigRecords, TwoNumbersTellAFrameFromTheOneBefore) {
  expectFrames(spiderRig(), 5e-7);
  expectFrames(rigOf({{0, 0, 1}, {1, 0, 0}, {0.3f, -1, 0.2f}, {0, -1, 0}, {-1, 2, -3}}), 5e-7);
}

// The opposite of z has no coordinates, and takes those of what is 2e-5 away from it.
TEST(RigRecords, ABoneThatFoldsBackHasAFrame) {
  expectFrames(rigOf({{0, 0, -1}, {0, 0, 1}, {1, 1e-4f, 0}, {-1, 0, 0}}), 5e-5);
}

}  // namespace
}  // namespace skitter::test
