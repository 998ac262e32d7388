// The light of the sky by day, in doubles: docs/stages/pictures.md, Light. Tests hold pictures against it.
#pragma once

#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>

#include "render/light.h"

namespace skitter::test {

// Sums over directions evenly over the sphere, with the share of each; none lies on the horizon.
template <class Each>
void overSphere(const Each& each) {
  constexpr int kHeights = 400, kTurns = 96;
  for (int i = 0; i < kHeights; ++i)
    for (int j = 0; j < kTurns; ++j) {
      const double sine = (2 * i + 1.0) / kHeights - 1, flat = std::sqrt(1 - sine * sine);
      const double turn = 2 * std::numbers::pi * j / kTurns;
      each(glm::dvec3(flat * std::sin(turn), sine, flat * std::cos(turn)), 1.0 / (kHeights * kTurns));
    }
}

// Real spherical harmonics of the orders 0 to 2.
inline std::array<double, 9> harmonicsOf(const glm::dvec3& d) {
  const double pi = std::numbers::pi, first = std::sqrt(3 / (4 * pi)), second = std::sqrt(15 / (4 * pi));
  return {std::sqrt(1 / (4 * pi)),
          first * d.x,
          first * d.y,
          first * d.z,
          second * d.x * d.y,
          second * d.y * d.z,
          second * d.x * d.z,
          second * (d.x * d.x - d.z * d.z) / 2,
          std::sqrt(5 / (16 * pi)) * (3 * d.y * d.y - 1)};
}

// Radiance as coefficients of those, from which follows the light on a white surface.
struct Harmonics {
  std::array<glm::dvec3, 9> coefficients{};
  glm::dvec3 squares{0};  // the mean square of the radiance

  explicit Harmonics(const render::LightModel& model) {
    const glm::dvec3 ground = render::radianceIn(model, {0, -1, 0});
    overSphere([&](const glm::dvec3& d, double share) {
      const glm::dvec3 light = d.y < 0 ? ground : render::radianceIn(model, d);
      const std::array<double, 9> each = harmonicsOf(d);
      for (size_t i = 0; i < each.size(); ++i)
        coefficients[i] += 4 * std::numbers::pi * share * each[i] * light;
      squares += share * light * light;
    });
  }
  // Over pi, the cosine's lobe has 1, 2/3 and 1/4.
  glm::dvec3 lightOn(const glm::dvec3& normal) const {
    const std::array<double, 9> each = harmonicsOf(normal);
    glm::dvec3 sum(0);
    for (size_t i = 0; i < each.size(); ++i)
      sum += (i == 0 ? 1.0 : i < 4 ? 2.0 / 3 : 0.25) * each[i] * coefficients[i];
    return sum;
  }
};

}  // namespace skitter::test
