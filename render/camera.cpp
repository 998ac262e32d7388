#include <algorithm>
#include <cmath>
#include <numbers>

#include "crowd/herd.h"
#include "crowd/spawn.h"
#include "skitter/renderer.h"
#include "skitter/spline.h"

namespace skitter {
namespace {

constexpr float kFollowRow = 0.3f;   // share of the crowd that walks behind the one followed
constexpr float kElevation = 0.30f;  // radians above the ground's horizon
constexpr float kAside = 0.62f;      // radians off the line behind the one followed
constexpr float kClearance = 0.5f;   // metres that eye and line of sight keep above gentle ground
constexpr float kLeast = 0.2f;       // the same above the ground itself, which may be a cliff
constexpr float kPathRadius = 1;     // metres within which the ground below an eye on a path is levelled
constexpr double kLongest = 1e9;     // seconds: whatever comes later looks the same

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
  // Only the device knows where those go who follow or flee.
  const bool unknown = herd.goal.kind == Goal::Kind::follow || herd.goal.kind == Goal::Kind::flee;
  if (herd.goal.kind == Goal::Kind::none || unknown || length < 1e-3f) return walk;
  walk.along = (there - start) / length;
  const double gone = std::max(0.0, seconds) * herd.goal.speed;
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

// The same of the whole crowd: of the first herd that has agents.
Walk walkOf(const Crowd::Impl& live, double seconds) {
  for (uint32_t i = 0; i < live.herds.size(); ++i) {
    const crowd::Herd& herd = live.herds[i];
    if (herd.from.agents == 0) continue;
    const double came = static_cast<double>(herd.since) * double{live.dt};
    return walkOf(herd.from, live.kindOf(i), live.terrain, herd.seed, seconds - came);
  }
  return {{0, 0}, {0, 1}};
}

// What height keeps a point clear of the ground, which is gentle where its mean within `radius` is.
float clearHeight(const Heightfield& terrain, glm::vec2 at, float radius) {
  return std::max(gentleHeight(terrain, at, radius) + kClearance, terrain.seenAt(at.x, at.y) + kLeast);
}

// Above the middle of a crowd's feet.
glm::vec3 middleOf(const Walk& walk, const Heightfield& terrain, float distance) {
  return {walk.at.x, gentleHeight(terrain, walk.at, 0.3f * distance) + 0.35f, walk.at.y};
}

// From `distance` away, along a way (unit) in the plane and up by the elevation; raised where the eye would
// be in the ground or behind a rise.
View seenFrom(const glm::vec3& target, glm::vec2 away, float elevation, float distance,
              const Heightfield& terrain) {
  const glm::vec2 middle(target.x, target.z), eye = middle + away * (distance * std::cos(elevation));
  View view;
  view.target = target;
  view.eye = {eye.x, target.y + distance * std::sin(elevation), eye.y};
  for (int i = 0; i <= 8; ++i) {
    const float t = float(i) / 12;  // from the eye; the ground beside the target may hide its feet
    const float needed = clearHeight(terrain, glm::mix(eye, middle, t), 0.1f * distance);
    const float line = view.eye.y + t * (view.target.y - view.eye.y);
    if (line < needed) view.eye.y += (needed - line) / (1 - t);
  }
  return view;
}

View followed(const Walk& walk, float distance, const Heightfield& terrain) {
  const float c = std::cos(kAside), s = std::sin(kAside);
  const glm::vec2 ahead(c * walk.along.x - s * walk.along.y, s * walk.along.x + c * walk.along.y);
  return seenFrom(middleOf(walk, terrain, distance), -ahead, kElevation, distance, terrain);
}

View orbited(const Camera& camera, const glm::vec3& target, float distance, double seconds,
             const Heightfield& terrain) {
  const double turns = camera.secondsATurn != 0 ? std::fmod(seconds / camera.secondsATurn, 1.0) : 0.0;
  const double angle = camera.azimuth + turns * 2 * std::numbers::pi;
  return seenFrom(target, {std::sin(angle), std::cos(angle)}, camera.elevation, distance, terrain);
}

// Before the first key and beyond the last one it stays.
View onPath(const Camera& camera, double seconds, const Heightfield& terrain) {
  SplineChain eyes, targets;
  for (const CameraKey& key : camera.keys) {
    eyes.points.push_back(key.position);
    targets.points.push_back(key.target);
    eyes.knots.push_back(key.time);
  }
  targets.knots = eyes.knots;
  View view;
  view.eye = Spline(eyes).position(seconds);
  view.target = Spline(targets).position(seconds);
  view.eye.y = std::max(view.eye.y, clearHeight(terrain, {view.eye.x, view.eye.z}, kPathRadius));
  return view;
}

View viewOf(const Camera& camera, const Crowd::Impl& live, double seconds) {
  const float distance = std::max(camera.distance, 0.5f);
  switch (camera.kind) {
    case Camera::Kind::fixed:
      return {.eye = camera.position, .target = camera.target};
    case Camera::Kind::orbit:
      return orbited(camera,
                     camera.about ? *camera.about : middleOf(walkOf(live, seconds), live.terrain, distance),
                     distance, seconds, live.terrain);
    case Camera::Kind::path:
      return onPath(camera, seconds, live.terrain);
    case Camera::Kind::follow:
      break;
  }
  return followed(walkOf(live, seconds), distance, live.terrain);
}

}  // namespace

View viewOf(const Scene& scene, const Crowd& crowd, double seconds) {
  const double time = std::isnan(seconds) ? 0 : std::clamp(seconds, -kLongest, kLongest);
  View view = viewOf(scene.camera, implOf(crowd), time);
  view.fieldOfView = scene.camera.fieldOfView;
  return view;
}

}  // namespace skitter
