#include "app/fields/colours.h"

#include <algorithm>
#include <cmath>

namespace skitter::app {
namespace {

float encoded(float linear) {
  const float v = std::clamp(linear, 0.0f, 1.0f);
  return v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f;
}

// Lightness from 0 to 1, chroma, and hue in degrees.
glm::vec3 ofOklch(float lightness, float chroma, float hue) {
  const float a = chroma * std::cos(glm::radians(hue)), b = chroma * std::sin(glm::radians(hue));
  const float l = lightness + 0.3963377774f * a + 0.2158037573f * b,
              m = lightness - 0.1055613458f * a - 0.0638541728f * b,
              s = lightness - 0.0894841775f * a - 1.2914855480f * b;
  const glm::vec3 cubes(l * l * l, m * m * m, s * s * s);
  return {encoded(glm::dot(cubes, {4.0767416621f, -3.3077115913f, 0.2309699292f})),
          encoded(glm::dot(cubes, {-1.2684380046f, 2.6097574011f, -0.3413193965f})),
          encoded(glm::dot(cubes, {-0.0041960863f, -0.7034186147f, 1.7076147010f}))};
}

}  // namespace

glm::vec3 costColour(float share) {
  const float t = std::clamp(share, 0.0f, 1.0f);
  return ofOklch(0.95f - 0.55f * t, 0.025f + 0.13f * std::sqrt(t), 95 - 70 * t);
}

glm::vec3 timeColour(float share) {
  const float t = std::clamp(share, 0.0f, 1.0f);
  // Least colour in the middle, where screens have little of blue-green.
  return ofOklch(0.93f - 0.65f * t, 0.09f + 0.2f * (t - 0.5f) * (t - 0.5f), 105 + 190 * t);
}

glm::vec3 trailColour(float share) {
  const float t = std::clamp(share, 0.0f, 1.0f);
  return ofOklch(0.95f - 0.6f * t, 0.02f + 0.11f * std::sqrt(t), 155);
}

glm::vec3 faded(const glm::vec3& colour, float left) {
  return glm::mix(glm::vec3(glm::dot(colour, {0.30f, 0.59f, 0.11f})), colour, left);
}

}  // namespace skitter::app
