#pragma once

#include "cpu_reference/stages/swing_clip.h"
#include "validation/checks.h"

namespace skitter::validation {

// A leg as the clip has it, by the reference, with how far a float32 result may be from it.
struct ClipLegBounds {
  std::vector<double> joints;      // metres, p_0 .. p_bones
  std::vector<double> directions;  // of the stereographic coordinates
};
ClipLegBounds boundsOf(const Setting& setting, const reference::Limb& limb, size_t l,
                       const reference::Play& play, const reference::ClipLeg& leg);

void compareDirections(const reference::ClipLeg& expected, const ClipLegBounds& bounds,
                       const std::vector<glm::dvec2>& got, Sample& sample);

}  // namespace skitter::validation
