// README's example, with a picture and a spline.
#include <cstdio>

#include "skitter/crowd.h"
#include "skitter/ik.h"
#include "skitter/renderer.h"
#include "skitter/scene.h"
#include "skitter/spline.h"

int main() {
  using namespace skitter;
  Device device = Device::create();
  Scene scene = builtinScene();
  scene.herds[0].agents = 100;
  scene.herds[0].controller = Controller::loop;
  const Crowd crowd(device, scene.loadTerrain(), scene, CrowdOptions{.pose = true});

  ik::Chain leg;
  for (int bone = 0; bone < 4; ++bone)
    leg.bones.push_back({.length = 0.25f, .direction = {1, 0, 0}, .limit = ik::Cone{1.0f}});
  ik::Batch legs(device, leg, 10);
  legs.setTargets(std::vector<glm::vec3>(10, {0.5f, -0.3f, 0}));
  legs.solve();
  const glm::vec3 foot = legs.downloadJoints().at(4);
  std::printf("%u agents, a foot at %.3f %.3f %.3f\n", static_cast<unsigned>(crowd.agentCount()),
              static_cast<double>(foot.x), static_cast<double>(foot.y), static_cast<double>(foot.z));
  return 0;
}
