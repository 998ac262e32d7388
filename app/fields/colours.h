#pragma once

#include <glm/glm.hpp>

namespace skitter::app {

// Colour maps that look evenly graded, and keep their order in grey: lightness goes straight from end to end
// in Oklab (Ottosson 2020, "A perceptual color space for image processing"). `share` is from 0 to 1; sRGB.
glm::vec3 costColour(float share);   // pale, then ochre to dark red
glm::vec3 timeColour(float share);   // bright yellow, then green and blue to violet
glm::vec3 trailColour(float share);  // pale, then green to dark green
// The same colour with so much of its colour left.
glm::vec3 faded(const glm::vec3& colour, float left);

}  // namespace skitter::app
