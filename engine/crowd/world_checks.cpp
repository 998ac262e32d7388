#include "crowd/world_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "assets/scenes/obstacles.h"
#include "skitter/error.h"

namespace skitter::crowd {
namespace {

bool isLength(float metres) { return metres > 0 && std::isfinite(metres); }

void checkTerrain(const Heightfield& terrain) {
  terrain.check();
  const float x = terrain.extentX(), z = terrain.extentZ();
  if (std::max(x, z) > 2 * Scene::maxCoordinate)
    throw inputError(
        fmt::format("{}: the terrain is {:.0f} x {:.0f} m, expected at most {:.0f} m a side; "
                    "--scale or the scene's scale makes it smaller",
                    terrain.name, std::floor(x), std::floor(z), 2 * Scene::maxCoordinate));
}

// `check` gets one of the list, and its name.
template <class List, class Check>
void checkList(const Scene& scene, const char* name, const List& list, size_t most, const Check& check) {
  if (list.size() > most)
    throw inputError(fmt::format("{}: {} {}, expected at most {}", scene.name, list.size(), name, most));
  for (size_t i = 0; i < list.size(); ++i) check(list[i], fmt::format("{}: {}[{}]", scene.name, name, i));
}

}  // namespace

void checkRig(const Rig& rig) {
  const auto check = [&](bool fits, const std::string& fault) {
    if (!fits) throw inputError(fmt::format("{}: {}", rig.name, fault));
  };
  check(!rig.legs.empty() && rig.legs.size() <= Rig::maxLegs,
        fmt::format("{} legs, expected 1 to {}", rig.legs.size(), Rig::maxLegs));
  check(isLength(rig.legLength), fmt::format("a leg length of {} m, expected above 0", rig.legLength));
  for (const Leg& leg : rig.legs) {
    check(!leg.bones.empty() && leg.bones.size() <= Leg::maxBones,
          fmt::format("leg {} has {} bones, expected 1 to {}", leg.name, leg.bones.size(), Leg::maxBones));
    check(isLength(leg.reach), fmt::format("leg {} reaches {} m, expected above 0", leg.name, leg.reach));
    check(leg.group >= 0 && leg.group < rig.groupCount(),
          fmt::format("leg {} is of group {}, expected one of {}", leg.name, leg.group, rig.groupCount()));
  }
}

void checkWorld(const Heightfield& terrain, const Scene& scene) {
  checkTerrain(terrain);
  checkList(scene, "obstacles", scene.obstacles, Scene::maxObstacles, scenes::checkObstacle);
  checkList(scene, "threats", scene.threats, Scene::maxThreats, scenes::checkThreat);
}

}  // namespace skitter::crowd
