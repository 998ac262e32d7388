#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ik/limits.h"
#include "skitter/error.h"
#include "skitter/ik.h"

namespace skitter::ik {

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
      throw faultOf(i, fmt::format("its length is {}, expected 0 or more", bone.length));
    if (!hasDirection(bone.direction)) throw faultOf(i, "its rest direction has no length");
    if (!(std::isfinite(bone.stiffness) && bone.stiffness >= 0))
      throw faultOf(i, fmt::format("its stiffness is {}, expected 0 or more", bone.stiffness));
    checkLimits(i, bone);
  }
  const float reach = chain.reach();
  if (!(reach > 0 && std::isfinite(reach)))
    throw inputError(fmt::format("the bones' lengths add up to {}, expected more than 0", reach));
  if (chain.pole && !hasDirection(*chain.pole)) throw inputError("the pole has no direction");
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
