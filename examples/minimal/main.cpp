// A crowd walks for five seconds, and tells how well.
#include <skitter/crowd.h>
#include <skitter/error.h>
#include <skitter/scene.h>

#include <cstdio>

int main() {
  using namespace skitter;
  try {
    Device device = Device::create();
    Scene scene = builtinScene();
    scene.herds[0].agents = 200;
    Crowd crowd(device, scene.loadTerrain(), scene);

    for (int tick = 0; tick < 300; ++tick)
      device.run([&](VkCommandBuffer commands) { crowd.record(commands, 1.0f / 60); });

    const Fidelity seen = crowd.fidelity();
    std::printf("%llu spiders walked on %s; a standing foot slid by %.4f %% of the leg length\n",
                static_cast<unsigned long long>(crowd.agentCount()), device.report().name.c_str(),
                100 * seen.slip);
  } catch (const Error& error) {
    std::fprintf(stderr, "minimal: %s\n", error.what());
    return static_cast<int>(error.kind());
  }
}
