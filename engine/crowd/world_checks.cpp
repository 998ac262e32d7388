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

// What drawing takes for granted of a skin's materials.
void checkLook(const Rig& rig) {
  const Look& look = rig.look;
  const auto fail = [&](const std::string& fault) {
    throw inputError(fmt::format("{}: {}", rig.name, fault));
  };
  if (look.vertices.size() != (look ? rig.vertices.size() : 0))
    fail(fmt::format("its look has {} vertices, expected {}", look.vertices.size(),
                     look ? fmt::format("the skin's {}", rig.vertices.size()) : "none without materials"));
  if (!look) return;
  const Materials& materials = *look.materials;
  for (size_t m = 0; m < materials.list.size(); ++m)
    for (const TextureRole role : allTextureRoles) {
      const Texture& texture = materials.list[m].texture(role);
      const auto images = static_cast<int64_t>(materials.images.size());
      if (texture.image < -1 || texture.image >= images)
        fail(fmt::format("the {} texture of material {} is of image {}, but there are {}", nameOf(role), m,
                         texture.image, images));
      if (texture.set != 0 && texture.set != 1)
        fail(fmt::format("the {} texture of material {} uses texture coordinates {}, expected 0 or 1",
                         nameOf(role), m, texture.set));
    }
  for (const MaterialVertex& vertex : look.vertices)
    if (vertex.material >= materials.list.size())
      fail(fmt::format("a vertex is of material {}, but there are {}", vertex.material,
                       materials.list.size()));
  for (size_t i = 0; i + 2 < rig.indices.size(); i += 3) {
    const auto materialOf = [&](size_t corner) {
      const uint32_t vertex = rig.indices[i + corner];
      if (vertex >= look.vertices.size())
        fail(fmt::format("triangle {} has vertex {}, but there are {}", i / 3, vertex, look.vertices.size()));
      return look.vertices[vertex].material;
    };
    const uint16_t first = materialOf(0);
    if (materialOf(1) != first || materialOf(2) != first)
      fail(fmt::format("triangle {} is of several materials, expected one", i / 3));
  }
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
  for (size_t i = 0; i < rig.gaits.size(); ++i) {
    const RigGait& gait = rig.gaits[i];
    const auto isTurn = [](const RigGait::Turn& turn) {
      return turn.phase >= 0 && turn.phase < 1 && turn.slowness >= RigGait::minSlowness &&
             turn.slowness <= RigGait::maxSlowness;
    };
    check(gait.idle != 0 && gait.idle >> rig.legs.size() == 0,
          fmt::format("gaits[{}] is without legs {:#x}, expected a mask of the rig's", i, gait.idle));
    check(
        gait.turns.size() == rig.legs.size(),
        fmt::format("gaits[{}] has {} turns, expected {}, one a leg: the gaits of a rig with other legs are "
                    "cleared",
                    i, gait.turns.size(), rig.legs.size()));
    check(gait.groups >= 1 && gait.groups <= RigGait::maxGroups,
          fmt::format("gaits[{}] has {} groups, expected 1 to {}", i, gait.groups, RigGait::maxGroups));
    check(std::ranges::all_of(gait.turns, isTurn) && gait.speed > 0 && gait.speed <= 1 &&
              std::isfinite(gait.shift.x + gait.shift.y + gait.shift.z),
          fmt::format("gaits[{}] has a number out of its range (skitter/rig.h)", i));
  }
  checkLook(rig);
}

void checkWorld(const Heightfield& terrain, const Scene& scene) {
  checkTerrain(terrain);
  checkList(scene, "obstacles", scene.obstacles, Scene::maxObstacles, scenes::checkObstacle);
  checkList(scene, "threats", scene.threats, Scene::maxThreats, scenes::checkThreat);
}

}  // namespace skitter::crowd
