#include "ik/chains.h"

#include <cmath>

#include "cpu_reference/rotation.h"

namespace skitter::test {
namespace {

constexpr double degree = 0.017453292519943295;

float angle(Random& random, double low, double high) {
  return static_cast<float>(degree * uniform(random, low, high));
}

// Unit, `theta` away from the unit `from`, to a random side.
glm::dvec3 besides(const glm::dvec3& from, double theta, Random& random) {
  return std::cos(theta) * from + std::sin(theta) * reference::perpendicular(randomDirection(random), from);
}

ik::Cone randomCone(Random& random) { return {angle(random, 20, 100)}; }

ik::Ellipse randomEllipse(Random& random) {
  return {angle(random, 15, 100), angle(random, 15, 100), angle(random, 15, 100), angle(random, 15, 100)};
}

ik::Hinge randomHinge(const glm::dvec3& bone, double square, Random& random) {
  const float low = angle(random, -110, 20), wide = angle(random, 30, 120);
  return {besides(bone, degree * square, random), low, low + wide};
}

void limit(ik::Bone& bone, const std::string& kind, Random& random) {
  if (kind == "cone") bone.limit = randomCone(random);
  if (kind == "ellipse") bone.limit = randomEllipse(random);
  if (kind == "hinge") bone.limit = randomHinge(bone.direction, 90, random);
  if (kind == "oblique") bone.limit = randomHinge(bone.direction, uniform(random, 50, 130), random);
  if (kind == "twist") {
    bone.limit = randomCone(random);
    bone.twistMin = -angle(random, 5, 90);
    bone.twistMax = angle(random, 5, 90);
  }
}

std::string kindOfBone(const std::string& limits, size_t bone) {
  if (limits == "free-base") return bone == 0 ? "free" : "cone";
  if (limits != "mixed") return limits;
  const char* kinds[] = {"ellipse", "hinge", "cone", "oblique", "twist"};
  return kinds[bone % 5];
}

}  // namespace

const std::vector<std::string> limitKinds = {"free",    "cone",  "ellipse", "hinge",
                                             "oblique", "twist", "mixed",   "free-base"};

double uniform(Random& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
}

glm::dvec3 randomDirection(Random& random) {
  const double z = uniform(random, -1, 1), around = uniform(random, 0, 360 * degree);
  const double s = std::sqrt(1 - z * z);
  return {s * std::cos(around), s * std::sin(around), z};
}

ik::Chain randomChain(const std::string& limits, size_t joints, Random& random) {
  ik::Chain chain;
  glm::dvec3 direction = randomDirection(random);
  for (size_t i = 0; i + 1 < joints; ++i) {
    ik::Bone bone{.length = static_cast<float>(uniform(random, 0.3, 0.9)), .direction = direction};
    limit(bone, kindOfBone(limits, i), random);
    chain.bones.push_back(bone);
    direction = besides(direction, degree * uniform(random, 5, 40), random);
  }
  return chain;
}

ik::Chain randomRig(const std::vector<std::string>& kinds, Random& random) {
  ik::Chain chain = randomChain("free", kinds.size() + 1, random);
  for (size_t i = 0; i < kinds.size(); ++i) {
    ik::Bone& bone = chain.bones[i];
    if (kinds[i] == "cone") bone.limit = ik::Cone{angle(random, 15, 100)};
    if (kinds[i] == "ellipse") bone.limit = randomEllipse(random);
    if (kinds[i] != "hinge") continue;
    const double wide = uniform(random, 20, 150), low = uniform(random, -130, 130 - wide);
    bone.limit = ik::Hinge{besides(bone.direction, 90 * degree, random), static_cast<float>(degree * low),
                           static_cast<float>(degree * (low + wide))};
  }
  return chain;
}

ik::Chain evenChain(size_t joints, double bend, const ik::Limit& limit) {
  ik::Chain chain;
  for (size_t i = 0; i + 1 < joints; ++i) {
    const double lean = i % 2 == 0 ? bend / 2 : -bend / 2;
    chain.bones.push_back({.length = 1 / static_cast<float>(joints - 1),
                           .direction = {std::sin(lean), std::cos(lean), 0},
                           .limit = limit});
  }
  return chain;
}

reference::IkState randomState(const reference::IkChain& chain, Random& random) {
  return reference::stateAt(chain, reference::randomLegalPose(chain.bones, random));
}

glm::dvec3 legalTarget(const reference::IkChain& chain, Random& random) {
  return randomState(chain, random).joints.back();
}

}  // namespace skitter::test
