// The sky's light on surfaces, held against the sky itself.
#include "render/light.h"

#include <gtest/gtest.h>

#include "skitter/light.h"
#include "sky_reference.h"

namespace skitter::render {
namespace {

glm::dvec3 ambientOn(const LightModel& model, const glm::dvec3& normal) {
  const LightNumbers numbers = lightNumbers(model);
  const double s = normal.x * model.towards.x + normal.z * model.towards.z;
  const std::array<double, 6> each{1, normal.y, s, normal.y * normal.y, s * s, normal.y * s};
  glm::dvec3 sum(0);
  for (int i = 0; i < 6; ++i) sum += each[size_t(i)] * glm::dvec3(numbers.ambient[size_t(i)]);
  return sum;
}

std::vector<Light> lights() {
  std::vector<Light> all;
  for (const Sky sky : allSkies) {
    all.push_back({.sky = sky});
    for (const glm::vec2 sun : {glm::vec2(1, 0.1f), glm::vec2(-2, 0.8f), glm::vec2(3, 1.5707964f)})
      all.push_back({.sky = sky, .sun = sun});
  }
  return all;
}

const std::vector<glm::dvec3>& normals() {
  static const std::vector<glm::dvec3> all = [] {
    std::vector<glm::dvec3> made;
    for (double y = -1; y <= 1; y += 0.25)
      for (double turn = 0; turn < 6.2; turn += 0.7)
        made.push_back({std::sqrt(1 - y * y) * std::sin(turn), y, std::sqrt(1 - y * y) * std::cos(turn)});
    return made;
  }();
  return all;
}

TEST(Light, AmbientIsTheSkysInSphericalHarmonics) {
  for (const Light& light : lights()) {
    const LightModel model = lightModel(light);
    const test::Harmonics reference(model);
    for (const glm::dvec3& normal : normals()) {
      const glm::dvec3 expected = reference.lightOn(normal), found = ambientOn(model, normal);
      // Both sums take the middle of strips in the height's sine. Either errs by h h / 24 times the change of
      // the integrand's slope, at most 15 times the radiance (haze 6, glow, the squares of d); h is 1 / 200
      // here. Rounding to float is less.
      const double brightest = glm::length(model.zenith + model.horizon + model.glow);
      const double tolerance = 2 * 15 * brightest / (200.0 * 200 * 24) + 1e-6;
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(found[c], expected[c], tolerance) << nameOf(light.sky) << ' ' << normal.y;
    }
  }
}

TEST(Light, AmbientIsTheSkysByIntegrationButForWhatHigherOrdersHold) {
  for (const Light& light : lights()) {
    const LightModel model = lightModel(light);
    const test::Harmonics reference(model);
    glm::dvec3 inside(0);
    for (const glm::dvec3& each : reference.coefficients) inside += each * each;
    // The light is sum_l a_l sum_m L_lm Y_lm(n), and a_3 = 0. By Cauchy and Schwarz, the orders from 4 on
    // give at most sqrt(sum a_l a_l (2 l + 1) / (4 pi)) times the root of the energy that is left. a_4 =
    // -1/24, a_6 = 1/64, a_8 = -1/128 over pi's: (9 / 576 + 13 / 4096 + 17 / 16384 + ..) / (4 pi) < 1/600.
    const glm::dvec3 left =
        glm::sqrt(glm::max(reference.squares * (4 * std::numbers::pi) - inside, glm::dvec3(0)) / 600.0);
    const glm::dvec3 ground = radianceIn(model, {0, -1, 0});
    for (const glm::dvec3& normal : normals()) {
      glm::dvec3 sum(0);
      test::overSphere([&](const glm::dvec3& d, double share) {
        const double facing = glm::dot(d, normal);
        if (facing > 0) sum += 4 * share * facing * (d.y < 0 ? ground : radianceIn(model, d));
      });
      const glm::dvec3 found = ambientOn(model, normal);
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(found[c], sum[c], left[c] + 1e-3) << nameOf(light.sky) << ' ' << normal.y;
      EXPECT_GE(std::min({found.x, found.y, found.z}), 0.0) << nameOf(light.sky);
    }
  }
}

TEST(Light, TheSunStandsWhereTheSceneSays) {
  const LightModel model = lightModel({.sun = glm::vec2(0.5f, 0.25f), .exposure = 2, .fog = 50});
  EXPECT_NEAR(std::atan2(model.towards.x, model.towards.z), 0.5, 1e-6);
  EXPECT_NEAR(std::asin(model.towards.y), 0.25, 1e-6);
  EXPECT_NEAR(model.exposure, 2 * lightModel({}).exposure, 1e-9);
  EXPECT_EQ(model.fog, 50);
}

}  // namespace
}  // namespace skitter::render
