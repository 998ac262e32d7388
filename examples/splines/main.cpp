// A thousand travellers go round closed splines at constant speed; the device and the host agree on where
// they are.
#include <skitter/error.h>
#include <skitter/spline.h>

#include <algorithm>
#include <cstdio>

int main() {
  using namespace skitter;
  try {
    Device device = Device::create();
    constexpr uint32_t travellers = 1000;
    const std::vector<glm::vec3> corners = {{0, 0, 0}, {4, 1, 0}, {4, 0, 3}, {0, 1, 3}};

    SplineBatch batch(device, travellers, {.points = 4, .closed = true, .constantSpeed = true});
    std::vector<glm::vec3> points;
    std::vector<SplineClock> clocks(travellers, {.duration = 10});  // seconds a round
    for (uint32_t i = 0; i < travellers; ++i) {
      points.insert(points.end(), corners.begin(), corners.end());
      clocks[i].activate(-0.01 * i);  // each a hundredth of a second ahead of the one before
    }
    batch.setPoints(points);
    batch.setClocks(clocks);
    batch.travel(2.5);

    Spline spline({.points = corners, .closed = true});
    float apart = 0;
    const std::vector<SplineMotion> motions = batch.downloadMotions();
    for (uint32_t i = 0; i < travellers; ++i) {
      spline.clock = clocks[i];
      apart = std::max(apart, glm::distance(motions[i].position, spline.at(2.5, true).position));
    }
    std::printf("%u travellers on a way of %.3f m are within %.0e m of where the host has them\n", travellers,
                spline.length(), static_cast<double>(apart));
  } catch (const Error& error) {
    std::fprintf(stderr, "splines: %s\n", error.what());
    return static_cast<int>(error.kind());
  }
}
