#include <cmath>
#include <functional>

#include "crowd/situations.h"
#include "validation/lockstep/lockstep.h"

namespace skitter::test {
namespace {

using Results = std::vector<validation::StageResult>;

// A camera that comes and goes, so that every rate is had, and changed from to every other. `tell` is called
// before each tick.
Results replayAtRates(
    Device& device, const Scene& scene, const CrowdOptions& options,
    const std::function<void(Crowd&)>& tell = [](Crowd&) {}, float dt = kTick) {
  CrowdOptions own = options;
  own.feet = true;
  own.levels = Levels{.distances = {6, 10, 14}, .most = {16, 16, 1000}};
  Crowd crowd(device, smallRollingGround(), scene, own);
  validation::Lockstep lockstep(crowd, scene, dt);
  for (int i = 0; i < 160 && !lockstep.hasRefused(); ++i) {
    tell(crowd);
    lockstep.begin();
    // Low through the crowd, so that levels are full, then over it and away.
    const float t = static_cast<float>(crowd.tick()), wide = t < 100 ? 7 : 20;
    crowd.lookFrom({wide * std::sin(0.02f * t), 1 + (t < 100 ? 0 : 12 * std::abs(std::sin(0.031f * t))),
                    wide * std::cos(0.017f * t)});
    simulate(device, crowd, 1, dt);
    lockstep.end();
  }
  return lockstep.results();
}

Results atRatesOfTheirOwn(Device& device, Controller controller, const CrowdOptions& options) {
  Scene scene = sceneOf(60, 1, 1, controller);
  scene.herds[0].spawn = {.kind = Spawn::Kind::grid, .spacing = 2};
  return replayAtRates(device, scene, options);
}

// Half and quarter rates alone: no tick is longer than 2/15 s.
Results inLongTicksAtRates(Device& device, Controller controller, const CrowdOptions& options) {
  Scene scene = sceneOf(60, 1, 1, controller);
  scene.herds[0].spawn = {.kind = Spawn::Kind::grid, .spacing = 2};
  return replayAtRates(
      device, scene, options, [](Crowd&) {}, 1.0f / 30);
}

// One comes or goes in each tick; blocks are empty at first.
Results comingAndGoingAtRates(Device& device, Controller controller, const CrowdOptions& options) {
  Scene scene = sceneOf(37, 1, 1, controller);
  scene.herds[0].reserve = 27;
  scene.herds[0].spawn = {.kind = Spawn::Kind::grid, .spacing = 2};
  std::vector<AgentId> came;
  return replayAtRates(device, scene, options, [&](Crowd& crowd) {
    const auto t = static_cast<float>(crowd.tick());
    if (crowd.tick() % 2 == 1) {
      came.push_back(crowd.add(0, {.position = {8 * std::sin(t), 8 * std::cos(1.3f * t)}, .heading = t}));
    } else if (came.size() > 18) {
      const auto goes = came.begin() + static_cast<ptrdiff_t>(crowd.tick() * 7 % came.size());
      crowd.remove(*goes);
      came.erase(goes);
    }
  });
}

Results foragingAtRates(Device& device, Controller controller, const CrowdOptions& options) {
  return replayAtRates(device, foragersScene(controller), options);
}

// Half of them are told what they lost and half are not; they heal, and some carry loads.
Results hurtAtRates(Device& device, Controller controller, const CrowdOptions& options) {
  Scene scene = sceneOf(64, controller == Controller::adaptive ? 2 : 1, 1, controller);
  for (Herd& herd : scene.herds) {
    herd.hurt = true;
    herd.adapts = &herd != &scene.herds[0];
    herd.spawn = {.kind = Spawn::Kind::grid, .spacing = 2};
  }
  return replayAtRates(device, scene, options, [&](Crowd& crowd) {
    const auto each = [&](uint32_t every, const auto& tell) {
      for (uint32_t herd = 0; herd < scene.herds.size(); ++herd)
        for (uint32_t agent = 0; agent < scene.herds[herd].agents; agent += every)
          tell(crowd.agentId(herd, agent), agent);
    };
    if (crowd.tick() == 10) each(1, [&](AgentId id, uint32_t agent) { crowd.hurt(id, agent % 8); });
    if (crowd.tick() == 50)
      each(3, [&](AgentId id, uint32_t agent) {
        crowd.carry(id, {.mass = 0.5f + 0.05f * static_cast<float>(agent), .offset = {0.2f, 0.1f, 0}});
      });
    if (crowd.tick() == 90) each(2, [&](AgentId id, uint32_t) { crowd.heal(id); });
  });
}

// They keep clear of each other and of a wall, round which fields lead them.
Results crowdingAtRates(Device& device, Controller controller, const CrowdOptions& options) {
  Scene scene = sceneOf(60, 2, 1, controller);
  scene.obstacles = {{Capsule{.from = {-16, 0}, .to = {3, 0}, .radius = 0.3f}}};
  Herd& herd = scene.herds[0];
  herd.avoid = true;
  herd.ways = Ways{};
  herd.spawn = {.kind = Spawn::Kind::grid, .spacing = 0.8f, .centre = {0, -4}};
  herd.goal = {.kind = Goal::Kind::point, .target = {0, 5}, .speed = 2};
  return replayAtRates(device, scene, options);
}

// They are pushed to every side, some twice within a slow tick and some with loads, and fall and rise; ground
// is gone under others.
Results pushedAtRates(Device& device, Controller controller, const CrowdOptions& options) {
  constexpr uint32_t agents = 61;
  Scene scene = sceneOf(agents, 1, 1, controller);
  scene.herds[0].reactions = true;
  scene.herds[0].spawn = {.kind = Spawn::Kind::grid, .spacing = 2};
  return replayAtRates(device, scene, options, [&](Crowd& crowd) {
    const auto pushSome = [&](uint32_t first, uint32_t every, float speed) {
      for (uint32_t agent = first; agent < agents; agent += every) pushAside(crowd, agent, speed);
    };
    if (crowd.tick() == 5)
      for (uint32_t agent = 0; agent < agents; agent += 3)
        crowd.carry(crowd.agentId(0, agent),
                    {.mass = 0.05f * static_cast<float>(agent), .offset = {0.3f, 0.1f, 0}});
    // Thrice before slow agents have a tick of their own. All of these are in some blocks, so that others
    // stay slow.
    if (crowd.tick() >= 22 && crowd.tick() < 25) pushSome(3, 16, 3);
    // In ticks of every remainder by 8, of each block some.
    if (crowd.tick() >= 112 && crowd.tick() < 120) pushSome(static_cast<uint32_t>(crowd.tick()) % 8, 8, 6);
    if (crowd.tick() == 140) pushSome(0, 1, 2);
  });
}

}  // namespace

const std::vector<Situation>& situationsAtRates() {
  static const std::vector<Situation> all = {
      {"atRatesOfTheirOwn",
       {Controller::adaptive, Controller::loop, Controller::clip, Controller::planted, Controller::keyPoses},
       atRatesOfTheirOwn,
       true},
      {"inLongTicksAtRates", {Controller::adaptive, Controller::loop}, inLongTicksAtRates},
      {"foragingAtRates", {Controller::adaptive}, foragingAtRates},
      {"hurtAtRates", {Controller::adaptive, Controller::loop, Controller::planted}, hurtAtRates},
      {"pushedAtRates", {Controller::adaptive}, pushedAtRates, true},
      {"comingAndGoingAtRates", {Controller::adaptive, Controller::clip}, comingAndGoingAtRates},
      {"crowdingAtRates", {Controller::adaptive, Controller::clip}, crowdingAtRates},
  };
  return all;
}

}  // namespace skitter::test
