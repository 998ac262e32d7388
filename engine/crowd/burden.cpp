#include "crowd/burden.h"

#include <algorithm>

namespace skitter::crowd {
namespace {

// The body moves no further off its feet than a regrouped gait may (docs/damage.md, Centres).
constexpr float mostLean = 0.3f;  // leg lengths
// At most so much of the body's height is lost, however heavy the load.
constexpr float mostSag = 0.2f;
// A step is never shorter than so much of an unloaded one's: it needs ticks enough to clear the ground.
constexpr float shortestStep = 0.6f;

}  // namespace

glm::vec3 combinedCentre(const Burden& burden) { return burden.share / (1 + burden.share) * burden.offset; }

Regait burdened(const Regait& gait, const Burden& burden, float legLength, float bodyHeight) {
  if (burden.share == 0) return gait;
  Regait result = gait;
  // Power is in proportion to the mass that is carried (Taylor et al. 1980) and, nearly, to speed: so it stays.
  const float speed = 1 / (1 + burden.share);
  result.speed *= speed;
  const glm::vec2 centre{combinedCentre(burden).x, combinedCentre(burden).z};
  const float distance = glm::length(centre);
  const glm::vec2 lean = distance > mostLean ? mostLean / distance * centre : centre;
  // A shift of the homes towards the combined centre; upward, it lowers the body.
  result.shift += glm::vec3(lean.x * legLength, mostSag * (1 - speed) * bodyHeight, lean.y * legLength);
  // The stride is shorter by `speed`: a step that is so, too, has a foot move no faster than without a load.
  for (LegTurn& leg : result.legs) leg.slowness *= std::max(speed, shortestStep);
  return result;
}

}  // namespace skitter::crowd
