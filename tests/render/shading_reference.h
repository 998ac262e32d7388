// How a material is shaded, in doubles: docs/stages/pictures.md, Materials. Tests hold pictures against it.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "sky_reference.h"
#include "support/srgb.h"

namespace skitter::test {

// The light of sky and ground by day about a direction.
inline glm::dvec3 ambientFrom(const glm::dvec3& direction) {
  static const Harmonics day(render::lightModel({}));
  return day.lightOn(direction);
}

// The tone curve of the picture.
inline glm::dvec3 developedLight(glm::dvec3 x) {
  x *= 0.62;
  return glm::clamp((x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
}

// The normal as a texel (0 to 255) bends it; `side` is the tangent's fourth number.
inline glm::dvec3 bentBy(const glm::dvec3& texel, const glm::dvec3& normal, const glm::dvec3& tangent,
                         double side, double scale) {
  const glm::dvec3 right = glm::normalize(tangent - glm::dot(tangent, normal) * normal);
  const glm::dvec3 top = side * glm::cross(normal, right);
  const glm::dvec3 bump = texel / 127.5 - 1.0;
  return glm::normalize(scale * (bump.x * right + bump.y * top) + bump.z * normal);
}

// A point of a surface, all that textures say included.
struct ShadedPoint {
  glm::dvec3 colour{1};  // linear, tint included
  double metallic = 1, roughness = 1;
  double open = 1;  // the sky's share, occlusion included
  double lit = 1;   // the sun's
  glm::dvec3 glow{0};
  glm::dvec3 normal{0, 1, 0}, toEye{0, 1, 0},
      toSun{0, 1, 0};  // unit; the normal bent, on the side that is seen
};

// Linear and not developed.
inline glm::dvec3 lightOf(const ShadedPoint& p) {
  const double r = std::max(p.roughness, 0.05), a = r * r;
  const glm::dvec3 f0 = glm::mix(glm::dvec3(0.04), p.colour, p.metallic),
                   scattered = p.colour * (1 - p.metallic);
  const double nl = std::max(glm::dot(p.normal, p.toSun), 0.0),
               nv = std::max(glm::dot(p.normal, p.toEye), 1e-4);
  const glm::dvec3 half = glm::normalize(p.toSun + p.toEye);
  const double nh = std::max(glm::dot(p.normal, half), 0.0), vh = std::max(glm::dot(p.toEye, half), 0.0);
  const double d = a * a / std::pow(nh * nh * (a * a - 1) + 1, 2);
  const double v =
      0.5 / (nl * std::sqrt(nv * nv * (1 - a * a) + a * a) + nv * std::sqrt(nl * nl * (1 - a * a) + a * a));
  const glm::dvec3 f = f0 + (1.0 - f0) * std::pow(1 - vh, 5);
  const glm::dvec3 direct = ((1.0 - f) * scattered + f * (d * v)) * (p.lit * nl);
  const glm::dvec4 fit = r * glm::dvec4(-1, -0.0275, -0.572, 0.022) + glm::dvec4(1, 0.0425, 1.04, -0.04);
  const double seen = std::max(glm::dot(p.normal, p.toEye), 0.0);
  const double bias = std::min(fit.x * fit.x, std::exp2(-9.28 * seen)) * fit.x + fit.y;
  const glm::dvec3 mirrored = f0 * (-1.04 * bias + fit.z) + 1.04 * bias + fit.w;
  const glm::dvec3 reflection = 2 * glm::dot(p.normal, p.toEye) * p.normal - p.toEye;
  const glm::dvec3 ambient = ambientFrom(p.normal) * scattered + ambientFrom(reflection) * mirrored;
  return glm::dvec3(3.10, 2.55, 1.85) * direct + p.open * ambient + p.glow;
}

}  // namespace skitter::test
