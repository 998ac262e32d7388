#include "render/light.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "render/bindings.h"

namespace skitter::render {
namespace {

// Of bare soil; half of the ground about a surface is in shadow or faces away from the sun.
constexpr glm::dvec3 kGroundColour{0.25, 0.18, 0.11};
constexpr double kGroundLit = 0.5;
constexpr double kGlowHigh = 0.35, kGlowLow = 0.65, kGlowHaze = 5;
// A sun so near the zenith has no side.
constexpr double kNoSide = 1e-3;

// Calls `each` with unit directions (s, y, p) evenly over the upper or lower hemisphere. The midpoint rule in
// the height's sine errs by a 24th of its step's square times the slope's change, here below 1e-5; about the
// vertical it converges faster than any power.
template <class Each>
void overHemisphere(bool upper, const Each& each) {
  constexpr int kHeights = 256, kTurns = 48;
  for (int i = 0; i < kHeights; ++i) {
    const double sine = (i + 0.5) / kHeights, flat = std::sqrt(1 - sine * sine);
    for (int j = 0; j < kTurns; ++j) {
      const double turn = 2 * std::numbers::pi * (j + 0.5) / kTurns;
      each(glm::dvec3(flat * std::cos(turn), upper ? sine : -sine, flat * std::sin(turn)),
           0.5 / (kHeights * kTurns));
    }
  }
}

glm::dvec3 skyIn(const LightModel& m, double height, double towardsSun) {
  const double t = std::pow(std::max(towardsSun, 0.0), 8);
  return glm::mix(m.zenith, m.horizon, std::exp2(-m.haze * height)) +
         m.glow * (t * (kGlowHigh + kGlowLow * std::exp2(-kGlowHaze * height)));
}

// In axes (s, y, p).
glm::dvec3 sunIn(const LightModel& m) {
  return {std::sqrt(std::max(0.0, 1 - m.towards.y * m.towards.y)), m.towards.y, 0};
}

glm::dvec3 groundRadiance(const LightModel& m) {
  const glm::dvec3 sun = sunIn(m);
  glm::dvec3 fromSky(0);
  overHemisphere(true, [&](const glm::dvec3& d, double share) {
    fromSky += 4 * share * d.y * skyIn(m, d.y, glm::dot(d, sun));
  });
  return kGroundColour * (kGroundLit * m.towards.y * m.sunlight + fromSky);
}

LightModel modelOf(Sky sky) {
  switch (sky) {
    case Sky::overcast:
      return {.towards = glm::normalize(glm::dvec3(0.30, 0.93, 0.20)),
              .sunlight = {0.36, 0.36, 0.36},
              .zenith = {0.93, 0.97, 1.03},
              .horizon = {0.60, 0.63, 0.67},
              .glow = {0, 0, 0},
              .haze = 2,
              .disc = 0,
              .exposure = 0.95,
              .stars = false,
              .fog = 0};
    case Sky::evening:
      return {.towards = glm::normalize(glm::dvec3(0.80, 0.22, 0.56)),
              .sunlight = {2.40, 1.20, 0.52},
              .zenith = {0.14, 0.19, 0.37},
              .horizon = {0.66, 0.43, 0.33},
              .glow = {1.10, 0.48, 0.14},
              .haze = 4,
              .disc = 4,
              .exposure = 0.78,
              .stars = false,
              .fog = 0};
    case Sky::night:
      return {.towards = glm::normalize(glm::dvec3(0.55, 0.62, 0.56)),
              .sunlight = {0.25, 0.36, 0.56},
              .zenith = {0.010, 0.017, 0.042},
              .horizon = {0.030, 0.044, 0.078},
              .glow = {0.04, 0.05, 0.07},
              .haze = 5,
              .disc = 4,
              .exposure = 0.95,
              .stars = true,
              .fog = 0};
    case Sky::day:
      break;
  }
  return {.towards = glm::normalize(glm::dvec3(0.62, 0.62, 0.40)),
          .sunlight = {3.10, 2.55, 1.85},
          .zenith = {0.12, 0.26, 0.60},
          .horizon = {0.58, 0.68, 0.80},
          .glow = {0.55, 0.37, 0.19},
          .haze = 6,
          .disc = 6,
          .exposure = 0.62,
          .stars = false,
          .fog = 0};
}

// Spherical harmonics to the second order, as a polynomial of the normal (Ramamoorthi and Hanrahan 2001, "An
// Efficient Representation for Irradiance Environment Maps"). Over pi, the cosine's lobe weighs the orders by
// 1, 2/3 and 1/4, so with means <> over the sphere the light is <L> + 2 <L d>.n + 5/4 <L P2(n.d)>. The light
// is the same on both sides of the plane through sun and zenith, so that nothing odd in p is left.
Ambient ambientOf(const LightModel& m) {
  const glm::dvec3 sun = sunIn(m), ground = groundRadiance(m);
  glm::dvec3 mean(0), byS(0), byY(0), bySS(0), byYY(0), byPP(0), byYS(0);
  for (const bool upper : {false, true})
    overHemisphere(upper, [&](const glm::dvec3& d, double share) {
      const glm::dvec3 light = share * (upper ? skyIn(m, d.y, glm::dot(d, sun)) : ground);
      mean += light;
      byS += light * d.x;
      byY += light * d.y;
      bySS += light * (d.x * d.x);
      byYY += light * (d.y * d.y);
      byPP += light * (d.z * d.z);
      byYS += light * (d.x * d.y);
    });
  const double k = 15.0 / 8;
  return {0.375 * mean + k * byPP, 2.0 * byY, 2.0 * byS, k * (byYY - byPP), k * (bySS - byPP), 2 * k * byYS};
}

}  // namespace

LightModel lightModel(const Light& light) {
  LightModel m = modelOf(light.sky);
  if (light.sun) {
    const double azimuth = light.sun->x, elevation = light.sun->y;
    m.towards = {std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
                 std::cos(azimuth) * std::cos(elevation)};
  }
  m.exposure *= light.exposure;
  m.fog = light.fog.value_or(0);
  m.ambient = ambientOf(m);
  return m;
}

glm::dvec3 radianceIn(const LightModel& m, const glm::dvec3& direction) {
  return direction.y < 0 ? groundRadiance(m) : skyIn(m, direction.y, glm::dot(direction, m.towards));
}

LightNumbers lightNumbers(const LightModel& m) {
  LightNumbers numbers{.sunlight = glm::vec3(m.sunlight),
                       .exposure = float(m.exposure),
                       .zenith = glm::vec3(m.zenith),
                       .haze = float(m.haze),
                       .horizon = glm::vec3(m.horizon),
                       .glow = glm::vec3(m.glow),
                       .disc = float(m.disc),
                       .ambient = {}};
  // The shaders have s times the sun's distance from the vertical.
  const double side = sunIn(m).x, scale = side < kNoSide ? 0 : 1 / side;
  const std::array<double, 6> scales{1, 1, scale, 1, scale * scale, scale};
  for (size_t i = 0; i < scales.size(); ++i) numbers.ambient[i] = glm::vec3(m.ambient[i] * scales[i]);
  return numbers;
}

std::vector<gpu::SpecConstant> lightConstants(const LightModel& m) {
  constexpr size_t count = sizeof(LightNumbers) / sizeof(float);
  const auto numbers = std::bit_cast<std::array<float, count>>(lightNumbers(m));
  std::vector<gpu::SpecConstant> constants;
  for (size_t i = 0; i < count; ++i) constants.emplace_back(shared::CONSTANT_LIGHT + uint32_t(i), numbers[i]);
  return constants;
}

}  // namespace skitter::render
