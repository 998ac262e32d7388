#include "app/viewer/camera_control.h"

#include <algorithm>
#include <cmath>

namespace skitter::app {
namespace {

constexpr float clearance = 0.3f;                 // metres of the eye above the ground
constexpr float nearest = 0.3f, farthest = 4000;  // metres to the pivot
constexpr float steepest = 1.55f;                 // radians above or below the horizon
constexpr float slowest = 2;                      // m/s of flying
constexpr float glide = 0.12f;                    // seconds in which two thirds of a way are gone

float share(float seconds) { return 1 - std::exp(-seconds / glide); }

}  // namespace

std::optional<float> groundAlong(const Heightfield& ground, const glm::vec3& eye, const glm::vec3& forward,
                                 float most) {
  const float step = 0.5f * std::min(ground.spacingX, ground.spacingZ);
  const auto above = [&](float t) {
    const glm::vec3 p = eye + forward * t;
    return p.y - ground.seenAt(p.x, p.z);
  };
  // Steps grow with the distance, as what is far is seen less sharply.
  for (float last = 0, t = step; last < most; last = t, t += step + 0.01f * t) {
    if (above(t) > 0) continue;
    float in = t, out = last;
    for (int i = 0; i < 20; ++i) (above(0.5f * (in + out)) > 0 ? out : in) = 0.5f * (in + out);
    return in <= most ? std::optional(in) : std::nullopt;
  }
  return std::nullopt;
}

glm::vec3 CameraControl::forward() const {
  return {std::sin(heading_) * std::cos(pitch_), std::sin(pitch_), std::cos(heading_) * std::cos(pitch_)};
}

glm::vec3 CameraControl::right() const { return {-std::cos(heading_), 0, std::sin(heading_)}; }

void CameraControl::grasp(Hold least) {
  if (hold_ == Hold::scene) {
    const glm::vec3 line = scene_.target - scene_.eye;
    distance_ = wantedDistance_ = std::clamp(glm::length(line), nearest, farthest);
    const glm::vec3 ahead = glm::length(line) > 1e-6f ? glm::normalize(line) : glm::vec3(0, 0, 1);
    heading_ = std::atan2(ahead.x, ahead.z);
    pitch_ = std::clamp(std::asin(std::clamp(ahead.y, -1.0f, 1.0f)), -steepest, steepest);
    pivot_ = scene_.target;
  }
  hold_ = std::max(hold_, least);
}

void CameraControl::advance(const View& scene, const std::optional<Followed>& followed, float seconds) {
  const glm::vec3 moved = scene.target - scene_.target;
  if (followed) {
    grasp(Hold::free);
    if (!following_) wantedDistance_ = std::min(wantedDistance_, followed->near);
    pivot_ += (followed->at - pivot_) * share(seconds);
  } else if (hold_ == Hold::target) {
    pivot_ += moved;
  }
  following_ = followed.has_value();
  distance_ += (wantedDistance_ - distance_) * share(seconds);
  scene_ = scene;
}

void CameraControl::orbit(float left, float up) {
  grasp(Hold::target);
  heading_ -= left;
  pitch_ = std::clamp(pitch_ - up, -steepest, steepest);
}

void CameraControl::pan(float rightwards, float upwards) {
  grasp(Hold::free);
  const float height = 2 * distance_ * std::tan(0.5f * scene_.fieldOfView);
  pivot_ -= (right() * rightwards + glm::cross(right(), forward()) * upwards) * height;
}

void CameraControl::zoom(float notches) {
  grasp(Hold::target);
  wantedDistance_ = std::clamp(wantedDistance_ * std::pow(0.9f, notches), nearest, farthest);
}

void CameraControl::fly(const glm::vec3& direction, float seconds) {
  grasp(Hold::free);
  const glm::vec3 way = right() * direction.x + glm::vec3(0, direction.y, 0) + forward() * direction.z;
  pivot_ += way * (std::max(slowest, distance_) * seconds);
}

void CameraControl::aim(const Heightfield& ground) {
  if (following_) return;
  grasp(Hold::target);
  const View now = view(ground);
  const std::optional<float> met = groundAlong(ground, now.eye, forward(), farthest);
  if (!met) return;
  distance_ = wantedDistance_ = std::max(*met, nearest);
  pivot_ = now.eye + forward() * distance_;
}

View CameraControl::view(const Heightfield& ground) const {
  if (hold_ == Hold::scene) return scene_;
  View view{.eye = pivot_ - forward() * distance_, .target = pivot_, .fieldOfView = scene_.fieldOfView};
  // Both are raised, so that the camera goes on looking the same way.
  const float least = ground.seenAt(view.eye.x, view.eye.z) + clearance;
  const float raised = std::max(0.0f, least - view.eye.y);
  view.eye.y += raised;
  view.target.y += raised;
  return view;
}

}  // namespace skitter::app
