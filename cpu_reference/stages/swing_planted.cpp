#include "cpu_reference/stages/swing_planted.h"

#include <limits>

#include "cpu_reference/heightfield.h"

namespace skitter::reference {
namespace {

double level(const glm::dvec3& v) { return std::hypot(v.x, v.z); }

}  // namespace

PlantedFoot idlePlantedFoot(const Plant& previous) {
  PlantedFoot result;
  result.foot = {glm::dvec3(0), 0};
  result.plant = previous;
  result.plant.offset = glm::dvec3(0);
  result.plant.locked = false;
  result.strayMargin = std::numeric_limits<double>::infinity();
  return result;
}

PlantedFoot plantedSwing(const Tuning& tuning, const Heights& heights, const AgentBody& body,
                         const glm::dvec3& inModel, bool stands, const Plant& previous,
                         const std::optional<bool>& locked) {
  PlantedFoot result;
  Plant& plant = result.plant;
  plant = previous;
  const glm::dvec2 position = body.world();
  const auto groundBelow = [&](const glm::dvec3& relative) {
    return heightAt(heights, position.x + relative.x, position.y + relative.z) - body.y;
  };
  const glm::dvec3 foot = body.orientation * inModel;
  const double above = std::max(inModel.y, 0.0);
  result.wanted = {foot.x, groundBelow(foot) + above, foot.z};

  const bool wasLocked = previous.locked;
  if (stands && wasLocked) plant.offset = previous.relative(body) - result.wanted;
  const double bound = wasLocked ? tuning.plantStray : tuning.plantStray / 2;
  const double stray = level(plant.offset);
  result.strayMargin = stands ? std::abs(stray - bound) : std::numeric_limits<double>::infinity();
  plant.locked = stands && locked.value_or(stray <= bound);
  if (!plant.locked) {
    plant.offset *= tuning.plantKeep;
    result.foot = {result.wanted + plant.offset, 0.5};
    return result;
  }
  if (!wasLocked) {
    glm::dvec3 lock = result.wanted + plant.offset;
    lock.y = groundBelow(lock) + above;
    plant.tileX = body.tileX;
    plant.tileZ = body.tileZ;
    plant.lock = lock + glm::dvec3(body.localX, body.y, body.localZ);
  }
  result.foot = {plant.relative(body), 1};
  return result;
}

}  // namespace skitter::reference
