#pragma once

#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "gpu/kernel.h"
#include "skitter/light.h"

namespace skitter::render {

// The light of sky and ground on a white surface with the unit normal (s, y, p), s towards sun or moon
// along the ground: a + b y + c s + d y y + e s s + f y s, in this order.
using Ambient = std::array<glm::dvec3, 6>;

// What a scene's light is to a picture (docs/stages/pictures.md#light). Radiances are linear, relative to a
// white surface that reads as about 0.8 by day.
struct LightModel {
  glm::dvec3 towards;   // sun or moon, unit
  glm::dvec3 sunlight;  // on a white surface that faces it
  glm::dvec3 zenith, horizon, glow;
  double haze;      // how soon the horizon's colour is gone: by half for 1 / haze of the height's sine
  double disc;      // the disc's brightness, in sunlights
  double exposure;  // radiances are multiplied by it before the tone curve
  bool stars;
  float fog;             // metres at which it has taken 63 %; 0: as suits the camera
  Ambient ambient = {};  // follows from the others, by some 40,000 looks at the sky
};
LightModel lightModel(const Light&);

// The sky's in a unit direction; below the horizon the ground's.
glm::dvec3 radianceIn(const LightModel&, const glm::dvec3& direction);

// What shaders have of it, as constants from CONSTANT_LIGHT on (shaders/render/light.glsl).
struct LightNumbers {
  glm::vec3 sunlight;
  float exposure;
  glm::vec3 zenith;
  float haze;
  glm::vec3 horizon, glow;
  float disc;
  std::array<glm::vec3, 6> ambient;  // s is multiplied by the sun's distance from the vertical
};
LightNumbers lightNumbers(const LightModel&);
std::vector<gpu::SpecConstant> lightConstants(const LightModel&);

}  // namespace skitter::render
