#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "crowd/page.h"
#include "skitter/scene.h"

// How agents are coloured in pictures where a scene says so: a vec4 an agent (Page::tint, render/tint.h).
namespace skitter::crowd {

// Whether a herd's agents need tints of their own.
// Whether a herd has tints for pictures: in a crowd without poses only herds that play clips are drawn.
inline bool isTinted(const CrowdOptions& options, const skitter::Herd& herd) {
  return (options.pose || herd.controller == Controller::clip) && (herd.colour || herd.tint);
}

// The mean lightness of a kind's creatures at rest, area by area, in the colours that textures give them.
float meanLightness(const Kind& kind);

// Those of a part of a herd. `lightness` is its kind's mean.
std::vector<glm::vec4> tintsOf(const skitter::Herd& herd, const Part& part, uint64_t seed, float lightness);

}  // namespace skitter::crowd
