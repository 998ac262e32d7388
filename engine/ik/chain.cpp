#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "skitter/error.h"
#include "skitter/ik.h"

namespace skitter::ik {
namespace {

constexpr float kWidest = 3.1f, kAlmostAlong = 0.999f;

bool finite(const glm::vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

[[noreturn]] void refuse(size_t bone, const std::string& fault) {
  throw inputError(fmt::format("bone {}: {}", bone, fault));
}

void checkRange(size_t bone, const char* what, float least, float greatest) {
  if (!(least <= greatest && least >= -kWidest && greatest <= kWidest))
    refuse(bone, fmt::format("its {} goes from {} to {} rad, expected a range within -3.1 to 3.1", what,
                             least, greatest));
}

void checkAngle(size_t bone, float angle, float most) {
  if (!(angle > 0 && angle <= most))
    refuse(bone, fmt::format("a half-angle is {} rad, expected more than 0 and at most {}", angle, most));
}

void checkLimit(size_t bone, const Bone& b) {
  if (const auto* cone = std::get_if<Cone>(&b.limit)) checkAngle(bone, cone->halfAngle, 3.15f);
  if (const auto* ellipse = std::get_if<Ellipse>(&b.limit))
    for (const float angle : {ellipse->px, ellipse->py, ellipse->nx, ellipse->ny})
      checkAngle(bone, angle, kWidest);
  if (const auto* hinge = std::get_if<Hinge>(&b.limit)) {
    if (!finite(hinge->axis) || glm::length(hinge->axis) < 1e-6f)
      refuse(bone, "its hinge has an axis without direction");
    if (std::fabs(glm::dot(glm::normalize(hinge->axis), glm::normalize(b.direction))) > kAlmostAlong)
      refuse(bone, "its hinge's axis lies along the bone, which it could not turn");
    checkRange(bone, "hinge", hinge->min, hinge->max);
    if (b.twistMin != 0 || b.twistMax != 0) refuse(bone, "a hinge has no twist range");
  }
}

}  // namespace

bool Chain::isFree() const {
  for (const Bone& bone : bones)
    if (!std::holds_alternative<Free>(bone.limit) || bone.twistMin != 0 || bone.twistMax != 0) return false;
  return true;
}

float Chain::reach() const {
  double sum = 0;
  for (const Bone& bone : bones) sum += bone.length;
  return static_cast<float>(sum);
}

std::vector<glm::vec3> Chain::rest() const {
  std::vector<glm::vec3> joints = {glm::vec3(0)};
  glm::dvec3 p(0);
  for (const Bone& bone : bones) {
    p += static_cast<double>(bone.length) * glm::normalize(glm::dvec3(bone.direction));
    joints.emplace_back(p);
  }
  return joints;
}

void check(const Chain& chain) {
  if (chain.bones.empty() || chain.bones.size() > Chain::maxBones)
    throw inputError(fmt::format("a chain of {} bones, expected 1 to {} (2 to {} joints)", chain.bones.size(),
                                 Chain::maxBones, Chain::maxBones + 1));
  for (size_t i = 0; i < chain.bones.size(); ++i) {
    const Bone& bone = chain.bones[i];
    if (!(std::isfinite(bone.length) && bone.length >= 0))
      refuse(i, fmt::format("its length is {}, expected 0 or more", bone.length));
    if (!finite(bone.direction) || glm::length(bone.direction) < 1e-6f)
      refuse(i, "its rest direction has no length");
    if (!(std::isfinite(bone.stiffness) && bone.stiffness >= 0))
      refuse(i, fmt::format("its stiffness is {}, expected 0 or more", bone.stiffness));
    checkRange(i, "twist", bone.twistMin, bone.twistMax);
    checkLimit(i, bone);
  }
  const float reach = chain.reach();
  if (!(reach > 0 && std::isfinite(reach)))
    throw inputError(fmt::format("the bones' lengths add up to {}, expected more than 0", reach));
  if (chain.pole && (!finite(*chain.pole) || glm::length(*chain.pole) < 1e-6f))
    throw inputError("the pole has no direction");
}

Solver solverFor(const Chain& chain, const Options& options) {
  if (options.solver != Solver::automatic) return options.solver;
  return chain.isFree() ? Solver::stretchAlign : Solver::activeSet;
}

uint32_t defaultIterations(const Chain& chain, const Options& options) {
  if (options.start == Start::previous) return 4;
  return chain.isFree() ? 20 : 64;
}

float restPullOf(const Chain& chain, const Options& options) {
  if (options.restPull) return *options.restPull;
  if (options.start != Start::previous || solverFor(chain, options) != Solver::activeSet) return 0;
  const bool hinged = std::any_of(chain.bones.begin(), chain.bones.end(),
                                  [](const Bone& bone) { return std::holds_alternative<Hinge>(bone.limit); });
  return hinged ? 0.02f : 0;
}

}  // namespace skitter::ik
