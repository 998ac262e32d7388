// Ten thousand legs reach for targets on a circle, without a crowd.
#include <skitter/error.h>
#include <skitter/ik.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

int main() {
  using namespace skitter;
  try {
    Device device = Device::create();

    // Four bones of a quarter of a metre, which at rest lie along +x. Each may lean by a radian.
    ik::Chain leg;
    for (int bone = 0; bone < 4; ++bone)
      leg.bones.push_back({.length = 0.25f, .direction = {1, 0, 0}, .limit = ik::Cone{1.0f}});

    ik::Batch legs(device, leg, 10000);
    std::vector<glm::vec3> targets(legs.chains());
    for (size_t i = 0; i < targets.size(); ++i) {
      const float angle = 6.2831853f * static_cast<float>(i) / static_cast<float>(targets.size());
      targets[i] = {0.6f, 0.3f * std::sin(angle), 0.3f * std::cos(angle)};
    }
    legs.setTargets(targets);
    legs.solve();

    float furthest = 0;
    for (const ik::Report& report : legs.downloadReports()) furthest = std::max(furthest, report.error);
    std::printf("%u legs reach their targets to %.2f %% of their length\n", legs.chains(),
                static_cast<double>(100 * furthest));
  } catch (const Error& error) {
    std::fprintf(stderr, "ik: %s\n", error.what());
    return static_cast<int>(error.kind());
  }
}
