// The bounds of docs/stages/body.md on ground of every kind, judged from positions, tilt and heights alone:
// heights are looked up here, in doubles, by other code than any stage's.
#include <cmath>
#include <cstdlib>
#include <functional>
#include <random>
#include <string>

#include "crowd/simulation.h"
#include "skitter/decode.h"

namespace skitter::test {
namespace {

using GroundedTest = GpuTest;

double groundAt(const Heightfield& terrain, double x, double z) {
  const double u = std::clamp((x - terrain.originX()) / terrain.spacingX, 0.0, terrain.columns - 1.0);
  const double v = std::clamp((z - terrain.originZ()) / terrain.spacingZ, 0.0, terrain.rows - 1.0);
  const auto i = static_cast<uint32_t>(std::min(u, terrain.columns - 2.0));
  const auto j = static_cast<uint32_t>(std::min(v, terrain.rows - 2.0));
  const auto sample = [&](uint32_t column, uint32_t row) {
    return static_cast<double>(terrain.heights[static_cast<size_t>(row) * terrain.columns + column]);
  };
  const double a = u - i, b = v - j;
  return (sample(i, j) * (1 - a) + sample(i + 1, j) * a) * (1 - b) +
         (sample(i, j + 1) * (1 - a) + sample(i + 1, j + 1) * a) * b;
}

Heightfield groundOf(float spacing, const std::function<double(double, double)>& height) {
  Heightfield terrain;
  terrain.columns = terrain.rows = 129;
  terrain.spacingX = terrain.spacingZ = spacing;
  for (uint32_t row = 0; row < terrain.rows; ++row)
    for (uint32_t column = 0; column < terrain.columns; ++column)
      terrain.heights.push_back(
          static_cast<float>(height(terrain.originX() + spacing * static_cast<float>(column),
                                    terrain.originZ() + spacing * static_cast<float>(row))));
  return terrain;
}

// Ground of a random kind that can hardly be walked on, or not at all.
Heightfield randomGround(std::mt19937_64& random, float legLength) {
  std::uniform_real_distribution<double> unit;
  const double high = legLength * std::exp2(8 * unit(random) - 4);
  const float spacing = legLength * static_cast<float>(std::exp2(3 * unit(random) - 2));
  const double period = legLength * (1 + 8 * unit(random));
  switch (random() % 6) {
    case 0:  // spikes
      return groundOf(spacing, [&](double, double) { return high * unit(random); });
    case 1:  // steps
      return groundOf(spacing, [&](double, double z) { return high * std::floor(z / period); });
    case 2:  // a chasm
      return groundOf(spacing, [&](double, double z) { return std::abs(z) < period / 2 ? -high : 0; });
    case 3:  // a slope
      return groundOf(spacing, [&](double x, double z) { return high / legLength * (0.6 * x + 0.8 * z); });
    case 4:  // posts
      return groundOf(spacing, [&](double, double) { return random() % 9 == 0 ? high : 0; });
    default:  // waves
      return groundOf(spacing,
                      [&](double x, double z) { return high * std::sin(x / period) * std::sin(z / period); });
  }
}

// SKITTER_GROUNDED_RUNS; 2,000 take half an hour, nearly all of it for making pipelines.
int runs() {
  const char* given = std::getenv("SKITTER_GROUNDED_RUNS");
  return given != nullptr ? std::atoi(given) : 16;
}

TEST_F(GroundedTest, NoBodyLeavesItsBoundsOnAnyGround) {
  for (int run = 0; run < runs(); ++run) {
    std::mt19937_64 random(static_cast<uint64_t>(run) + 1);
    std::uniform_real_distribution<double> unit;
    const auto controller = allControllers[random() % 4 == 0 ? random() % allControllers.size() : 0];
    Scene scene = sceneOf(16, static_cast<float>(std::exp2(6 * unit(random) - 3)), random(), controller);
    const bool quadruped = controller == Controller::adaptive && random() % 2 == 0;
    if (quadruped) scene.herds[0].rig = SKITTER_ROOT "/assets/quadruped.glb";
    scene.herds[0].tuning.maxSlope = static_cast<float>(0.2 + 2.5 * unit(random));
    const double legLength = quadruped ? 0.66 : 1, dt = 1 / (4 + 236 * unit(random));
    const Heightfield terrain = randomGround(random, static_cast<float>(legLength));
    Crowd crowd(device(), terrain, scene);
    const double sink = 0.15 * legLength, rise = legLength;
    const double steepest = scene.herds[0].tuning.maxSlope + scene.herds[0].tuning.leanMost;
    // Stages look heights up in float32: a coordinate errs by 6 roundings of the extent, over which the
    // ground rises by up to twice the highest sample in a cell, along either axis; the interpolation rounds 8
    // times.
    double most = 0;
    for (const float h : terrain.heights) most = std::max(most, std::abs(static_cast<double>(h)));
    constexpr double roundoff = 0x1p-24;
    const double slack =
        roundoff * (6.0 * terrain.extentX() * 4 * most / terrain.spacingX + 16 * (most + legLength)) +
        1e-6 * legLength;
    for (int batch = 0; batch < 12; ++batch) {
      simulate(device(), crowd, 10, static_cast<float>(dt));
      const HerdState state = crowd.download(0);
      const Rig& rig = crowd.rig(0);
      for (size_t agent = 0; agent < 16; ++agent) {
        const BodyState body = bodyOf(std::span(state.body).subspan(16 * agent));
        const glm::dmat3 frame(glm::mat3_cast(body.rotation));
        const glm::dvec3 p = body.position, up = frame[1];
        const double below = groundAt(terrain, p.x, p.z);
        double highest = below;
        for (const double end : {-1.0, 1.0}) {
          const glm::dvec3 q = p + up * double{rig.bodyHeight} + frame[2] * (end * rig.bodyRadius);
          highest = std::max(highest, groundAt(terrain, q.x, q.z));
        }
        ASSERT_GE(p.y, below - sink - slack)
            << "run " << run << ", tick " << crowd.tick() << ", agent " << agent;
        ASSERT_LE(p.y, highest + rise + slack)
            << "run " << run << ", tick " << crowd.tick() << ", agent " << agent;
        ASSERT_GE(up.y, 1 / std::hypot(1, steepest) - 1e-5)
            << "run " << run << ", tick " << crowd.tick() << ", agent " << agent;
      }
    }
  }
}

}  // namespace
}  // namespace skitter::test
