#include "cpu_reference/stages/footfall.h"

namespace skitter::reference {
namespace {

glm::dvec3 worldOf(const FootAt& foot) {
  const glm::dvec2 body = foot.body.world();
  return glm::dvec3(body.x, foot.body.y, body.y) + foot.tip;
}

}  // namespace

std::optional<Footfall> footfall(const FootAt& before, const FootAt& after, double dt) {
  if (before.progress >= 1 || after.progress < 1) return {};
  const glm::dvec3 place = worldOf(after);
  return Footfall{place, glm::length(place - worldOf(before)) / dt};
}

}  // namespace skitter::reference
