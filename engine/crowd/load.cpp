#include "crowd/load.h"

#include <algorithm>

namespace skitter::crowd {
namespace {

// The body moves no further off its feet than a regrouped gait may (docs/damage.md, Centres).
constexpr float mostLean = 0.3f;  // leg lengths
// Most of the body's height that is lost under a load, however heavy.
constexpr float mostSag = 0.2f;

}  // namespace

glm::vec3 combinedCentre(const Load& load) { return load.mass / (1 + load.mass) * load.offset; }

Regait loaded(const Regait& gait, const Load& load, const Rig& rig, const Tuning& tuning,
              const LegPattern& pattern) {
  if (load.mass == 0 || gait.speed == 0) return gait;
  Regait result = gait;
  // Power is in proportion to the mass that is carried and, nearly, to speed: so it stays (docs/loads.md).
  const float share = 1 / (1 + load.mass);
  result.speed *= share;

  const glm::vec3 centre = rig.legLength * combinedCentre(load);
  const glm::vec2 before{gait.shift.x, gait.shift.z};
  glm::vec2 lean = before + glm::vec2(centre.x, centre.z);
  const float most = std::max(mostLean * rig.legLength, glm::length(before));
  if (glm::length(lean) > most) lean *= most / glm::length(lean);
  // A shift of the homes toward the combined centre. Upward, it lowers the body.
  const float lowering = std::max(gait.shift.y, loweringFor(rig, tuning, pattern, lean));
  result.shift = {lean.x, lowering + mostSag * (1 - share) * rig.bodyHeight, lean.y};
  return result;
}

CarriedRecord carriedRecord(const Load& load) {
  return {load.offset.x, load.offset.y, load.offset.z, load.mass};
}

Load loadOf(std::span<const float> record) {
  return {.mass = record[3], .offset = {record[0], record[1], record[2]}};
}

}  // namespace skitter::crowd
