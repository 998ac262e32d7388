#include "cpu_reference/stages/route.h"

#include <algorithm>
#include <cmath>

#include "cpu_reference/heightfield.h"
#include "cpu_reference/stages/swing.h"

namespace skitter::reference {
namespace {

constexpr double forbidden = 100;

// A way's own spline says where its foot passes: with the lift being only `aside`, and by how much a metre of
// lift upward raises it there.
struct Passage {
  glm::dvec3 place{0};
  double raise = 0;
};
Passage passage(const glm::dvec3& liftOff, const glm::dvec3& landing, const glm::dvec3& aside,
                const std::optional<glm::dvec3>& startTangent, double u) {
  Step step;
  step.liftOff = liftOff;
  step.landing = landing;
  step.lift = aside;
  step.startTangent = startTangent.value_or(aside);
  Passage passage;
  passage.place = splineAt(step, u).position;
  Step unit;
  unit.lift = glm::dvec3(0, 1, 0);
  if (!startTangent) unit.startTangent = unit.lift;
  passage.raise = splineAt(unit, u).position.y;
  return passage;
}

}  // namespace

Route route(const Tuning& tuning, const Heights& heights, const AgentBody& body, const glm::dvec3& liftOff,
            const glm::dvec3& landing, const std::optional<glm::dvec3>& startTangent, double share) {
  const glm::dvec3 up = body.orientation * glm::dvec3(0, 1, 0);
  const glm::dvec3 across = normalized(glm::cross(up, landing - liftOff));
  const glm::dvec2 position = body.world();
  constexpr int sides[5] = {0, -1, 1, -2, 2};
  Route route;
  for (size_t w = 0; w < route.ways.size(); ++w) {
    Way& way = route.ways[w];
    way.side = sides[w];
    const glm::dvec3 aside = across * (way.side * tuning.routeWidth);
    way.height = tuning.stepHeight * share;
    for (size_t i = 0; i < way.gaps.size(); ++i) {
      const double u = static_cast<double>(i + 1) / 8;
      const Passage at = passage(liftOff, landing, aside, startTangent, u);
      const double clearing = passage(liftOff, landing, aside, std::nullopt, u).raise;
      way.places[i] = {at.place.x, at.place.z};
      way.gaps[i] = heightAt(heights, position.x + at.place.x, position.y + at.place.z) - body.y - at.place.y;
      way.height = std::max(way.height, (way.gaps[i] * up.y + tuning.stepClearance * clearing) / at.raise);
      way.heightError = std::max(way.heightError, std::abs(up.y) / at.raise);
    }
    const double capped = std::min(way.height, tuning.stepHeightMax), over = way.height - capped;
    way.lift = capped * up + aside;
    way.cost = glm::dot(way.lift, way.lift) + forbidden * over * over;
    if (way.cost < route.way().cost) route.chosen = static_cast<int>(w);
  }
  return route;
}

}  // namespace skitter::reference
