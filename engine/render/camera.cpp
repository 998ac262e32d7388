#include <algorithm>
#include <cmath>

#include "crowd/herd.h"
#include "crowd/spawn.h"
#include "skitter/renderer.h"

namespace skitter {
namespace {

constexpr float kFollowRow = 0.3f;   // share of the crowd that walks behind the one followed
constexpr float kElevation = 0.30f;  // radians above the ground's horizon
constexpr float kAside = 0.62f;      // radians off the line behind the one followed
constexpr float kClearance = 0.5f;   // metres that eye and line of sight keep above gentle ground
constexpr float kLeast = 0.2f;       // the same above the ground itself, which may be a cliff

// Where the middle one of a herd walks if nothing holds it up.
struct Walk {
  glm::vec2 at, along;  // world x, z; along is the way that it first goes, unit
};
Walk walkOf(const Herd& herd, const crowd::Kind& live, const Heightfield& terrain, uint64_t seed,
            double seconds) {
  const crowd::Spawner spawner(herd, live, terrain, seed);
  const uint32_t lanes = spawner.lanes(), row = uint32_t(float(herd.agents) * kFollowRow) / lanes;
  const auto placed = spawner.place(std::min(herd.agents - 1, row * lanes + lanes / 2));
  const glm::vec2 start(placed.x, placed.z);
  const glm::vec2 there(placed.targetX, placed.targetZ), back(placed.otherX, placed.otherZ);
  const float length = glm::distance(start, there);
  Walk walk{start, {std::sin(placed.heading), std::cos(placed.heading)}};
  if (herd.goal.kind == Goal::Kind::velocity) {
    const glm::vec2 velocity = herd.goal.velocity,
                    edge = 0.5f * glm::vec2(terrain.extentX(), terrain.extentZ());
    if (glm::length(velocity) > 1e-3f) walk.along = glm::normalize(velocity);
    walk.at = glm::clamp(start + velocity * float(seconds), -edge, edge);
    return walk;
  }
  if (herd.goal.kind == Goal::Kind::none || length < 1e-3f) return walk;
  walk.along = (there - start) / length;
  const double gone = seconds * herd.goal.speed;
  if (gone <= length || herd.goal.kind == Goal::Kind::point) {
    walk.at = start + walk.along * float(std::min(gone, double(length)));
    return walk;
  }
  const double lap = glm::distance(there, back);
  const double turned = lap > 1e-3 ? std::fmod((gone - length) / lap, 2.0) : 0.0;
  walk.at = glm::mix(there, back, float(turned < 1 ? turned : 2 - turned));
  return walk;
}

// The ground's mean height about a point, so that the camera glides over what feet climb.
float gentleHeight(const Heightfield& terrain, glm::vec2 at, float radius) {
  float sum = terrain.seenAt(at.x, at.y);
  for (int i = 0; i < 12; ++i) {
    const float angle = float(i) * 2.0943951f / 4, reach = radius * (i % 2 == 0 ? 1.0f : 0.5f);
    sum += terrain.seenAt(at.x + reach * std::cos(angle), at.y + reach * std::sin(angle));
  }
  return sum / 13;
}

View followed(const Camera& camera, const Walk& walk, const Heightfield& terrain) {
  const float distance = std::max(camera.distance, 0.5f);
  const float c = std::cos(kAside), s = std::sin(kAside);
  const glm::vec2 ahead(c * walk.along.x - s * walk.along.y, s * walk.along.x + c * walk.along.y);
  const glm::vec2 eye = walk.at - ahead * (distance * std::cos(kElevation));

  View view;
  view.fieldOfView = camera.fieldOfView;
  view.target = {walk.at.x, gentleHeight(terrain, walk.at, 0.3f * distance) + 0.35f, walk.at.y};
  view.eye = {eye.x, view.target.y + distance * std::sin(kElevation), eye.y};
  // Neither in the ground nor behind a rise.
  for (int i = 0; i <= 8; ++i) {
    const float t = float(i) / 12;  // from the eye; the ground beside the target may hide its feet
    const glm::vec2 p = glm::mix(eye, walk.at, t);
    const float needed =
        std::max(gentleHeight(terrain, p, 0.1f * distance) + kClearance, terrain.seenAt(p.x, p.y) + kLeast);
    const float line = view.eye.y + t * (view.target.y - view.eye.y);
    if (line < needed) view.eye.y += (needed - line) / (1 - t);
  }
  return view;
}

}  // namespace

View viewOf(const Scene& scene, const Crowd& crowd, double seconds) {
  const Camera& camera = scene.camera;
  if (camera.kind == Camera::Kind::fixed)
    return {.eye = camera.position, .target = camera.target, .fieldOfView = camera.fieldOfView};
  const Crowd::Impl& live = implOf(crowd);
  Walk walk{{0, 0}, {0, 1}};
  for (uint32_t i = 0; i < scene.herds.size() && i < live.herds.size(); ++i) {
    if (scene.herds[i].agents == 0) continue;
    walk = walkOf(scene.herds[i], live.kindOf(i), live.terrain, scene.seed, seconds);
    break;
  }
  return followed(camera, walk, live.terrain);
}

}  // namespace skitter
