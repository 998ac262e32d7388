#include "experiments/placement.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "experiments/walk.h"
#include "skitter/renderer.h"

namespace skitter::experiments {
namespace {

constexpr double distanceAway = 2.5;  // metres from the eye to the agent
constexpr double elevation = 0.42;    // radians above the horizon
constexpr double clearance = 0.25;    // metres that the line of sight keeps above the ground

double groundAt(const Heightfield& ground, const glm::dvec3& p) {
  return ground.at(static_cast<float>(p.x), static_cast<float>(p.z));
}

// How far the line of sight would have to rise, in radians, to clear the ground.
double hidden(const Heightfield& ground, const glm::dvec3& eye, const glm::dvec3& target) {
  double worst = 0;
  for (int i = 0; i <= 12; ++i) {
    const double t = i / 16.0;  // the last quarter is what the agent stands on
    const glm::dvec3 p = glm::mix(eye, target, t);
    worst = std::max(worst, groundAt(ground, p) + clearance * (1 - t) - p.y);
  }
  return worst / distanceAway;
}

// From whichever side the ground hides the least, a little above the agent.
View viewOfAgent(const Heightfield& ground, const AgentState& agent) {
  glm::dvec3 feet(0);
  for (const LegState& leg : agent.legs) feet += leg.foot / static_cast<double>(agent.legs.size());
  constexpr double bodyAbove = 0.22;  // metres: a body that stands is on the ground by its origin
  const glm::dvec3 target = glm::mix(agent.position, feet, 0.5) + glm::dvec3(0, bodyAbove, 0);
  const double ahead = std::atan2(agent.heading.x, agent.heading.y);
  std::optional<glm::dvec3> best;
  double least = 1e9;
  for (const double rise : {elevation, elevation + 0.15, elevation + 0.35}) {
    for (const double aside : {2.2, -2.2, 1.6, -1.6, 1.0, -1.0}) {
      const double angle = ahead + aside;
      const glm::dvec3 eye =
          target + distanceAway * glm::dvec3(std::sin(angle) * std::cos(rise), std::sin(rise),
                                             std::cos(angle) * std::cos(rise));
      const double cost = hidden(ground, eye, target) + 0.02 * rise;
      if (cost < least) least = cost, best = eye;
    }
  }
  View view;
  view.eye = *best;
  view.target = target;
  view.fieldOfView = 0.75f;
  return view;
}

// The agent whose surroundings are the most uneven: all controllers begin alike, so that the first decides.
size_t roughest(const Heightfield& ground, const Rig& rig, const std::vector<AgentState>& agents) {
  size_t best = 0;
  double most = -1;
  for (size_t a = 0; a < agents.size(); ++a) {
    const double rough = roughnessAt(ground, rig, agents[a].position, agents[a].heading);
    if (rough > most) most = rough, best = a;
  }
  return best;
}

}  // namespace

std::vector<PlacementPicture> measurePlacement(Device& device, const Heightfield& ground,
                                               const Settings& settings, Course& course) {
  std::vector<PlacementPicture> made;
  std::optional<View> view;
  size_t chosen = 0;
  // The adaptive agent first: where it is, the others are looked at too, as near as they come to it.
  for (size_t c = subjects.size(); c-- > 0;) {
    course.at(static_cast<double>(made.size()) / subjects.size());
    Walk walk(device, ground, crossing(subjects[c].controller, settings.placementAgents, 1, settings.seed),
              settings.dt);
    walk.ticks(settings.placementTicks);
    const std::vector<AgentState> agents = walk.agents();
    if (!view) chosen = roughest(ground, walk.rig(), agents);
    const AgentState& agent = agents[chosen];
    view = viewOfAgent(ground, agent);

    PlacementPicture picture;
    picture.controller = subjects[c].controller;
    picture.width = settings.pictureWidth;
    picture.height = settings.pictureHeight;
    const double length = walk.rig().legLength;
    picture.roughness = roughnessAt(ground, walk.rig(), agent.position, agent.heading) / length;
    for (const LegState& leg : agent.legs) {
      const double above = (leg.foot.y - groundAt(ground, leg.foot)) / length;
      picture.penetration = std::max(picture.penetration, -above);
      if (leg.stance) picture.floating = std::max(picture.floating, above);
    }
    Renderer renderer(device, walk.crowd(), picture.width, picture.height);
    renderer.record(walk.ring().begin(), *view);
    walk.ring().wait(walk.ring().submit());
    picture.rgba = renderer.download();
    made.insert(made.begin(), std::move(picture));
  }
  return made;
}

}  // namespace skitter::experiments
