#include "crowd/key_poses.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "crowd/clip_records.h"
#include "skitter/error.h"
#include "skitter/records.h"
#include "skitter/scene.h"

namespace skitter::crowd {
namespace {

// Feet are within 1e-6 m of the clip's then, but where they are out of reach.
constexpr int kRootingIterations = 16;

// Tangents are taken so far to both sides, shares of the cycle: wider than the frames of a clip are apart.
constexpr double kAside = 1.0 / 64;

using Joints = std::vector<glm::dvec3>;
using Directions = std::vector<glm::dvec2>;  // (X, Y) of each bone

// How the rig has a leg at rest.
struct RestLeg {
  glm::dvec3 root{0};
  std::vector<double> lengths;     // metres
  std::vector<glm::dmat3> frames;  // B_i
};

RestLeg restOf(const Leg& leg, size_t l, int maxBones, const std::vector<float>& rigRecords) {
  RestLeg rest{leg.root(), {}, {}};
  const size_t stride = static_cast<size_t>(shared::rigStride(maxBones));
  for (size_t i = 0; i < leg.bones.size(); ++i) {
    const float* bone =
        rigRecords.data() + 4 * (l * stride + shared::RIG_LEG_STRIDE + shared::RIG_BONE_STRIDE * i);
    const glm::dvec3 x(bone[0], bone[1], bone[2]), z(bone[4], bone[5], bone[6]);
    rest.lengths.push_back(leg.bones[i].length);
    rest.frames.emplace_back(x, glm::cross(z, x), z);
  }
  return rest;
}

glm::dvec3 unit(const glm::dvec3& v) { return v / std::sqrt(std::max(glm::dot(v, v), 1e-20)); }

// p_0 .. p_bones of a leg, above the clip's ground.
Joints jointsAt(const ClipSet& set, const Clip& clip, const ClipLeg& leg, double time) {
  const auto later = std::upper_bound(clip.times.begin() + 1, clip.times.end(), time);
  const auto f = static_cast<size_t>(later - clip.times.begin()) - 1;
  const size_t next = std::min(f + 1, clip.frames() - 1);
  const double step = double{clip.times[next]} - clip.times[f];
  const double u = step > 0 ? (time - clip.times[f]) / step : 0;
  Joints joints;
  for (size_t i = 0; i < leg.joints.size(); ++i) {
    glm::dvec3 p(0, -clip.ground, 0);
    for (int r = 0; r < 3; ++r) {
      const auto row = [&](size_t frame) {
        return glm::dvec4(
            clip.rows[(frame * set.joints.size() + leg.joints[i]) * 3 + static_cast<size_t>(r)]);
      };
      p[r] += glm::dot(glm::mix(row(f), row(next), u), glm::dvec4(leg.starts[i], 1));
    }
    joints.push_back(p);
  }
  return joints;
}

// Onto the rig's root and lengths, the foot kept: FABRIK (Aristidou & Lasenby 2011).
void moveToRoot(const RestLeg& rest, Joints& p) {
  const glm::dvec3 foot = p.back();
  const size_t bones = rest.lengths.size();
  for (int k = 0; k < kRootingIterations; ++k) {
    p[bones] = foot;
    for (size_t i = bones; i-- > 0;) p[i] = p[i + 1] + rest.lengths[i] * unit(p[i] - p[i + 1]);
    p[0] = rest.root;
    for (size_t i = 0; i < bones; ++i) p[i + 1] = p[i] + rest.lengths[i] * unit(p[i + 1] - p[i]);
  }
}

Directions directionsOf(const RestLeg& rest, const Joints& p) {
  Directions directions;
  glm::dmat3 frame = rest.frames.front();
  for (size_t i = 0; i < rest.lengths.size(); ++i) {
    const glm::dvec3 d = glm::transpose(frame) * unit(p[i + 1] - p[i]);
    const glm::dvec2 s = rest.lengths[i] > 0 ? glm::dvec2(d) / (1 + std::max(d.z, -0.999)) : glm::dvec2(0);
    directions.push_back(s);
    if (i + 1 < rest.lengths.size())
      frame = frame * glm::mat3_cast(glm::normalize(glm::dquat(1, -s.y, s.x, 0))) *
              glm::transpose(rest.frames[i]) * rest.frames[i + 1];
  }
  return directions;
}

void push(std::vector<float>& records, double a, double b, double c, double d) {
  for (const double value : {a, b, c, d}) records.push_back(static_cast<float>(value));
}

void pushDirections(std::vector<float>& records, Directions directions, int maxBones) {
  directions.resize(2 * static_cast<size_t>(shared::chainStride(maxBones)));
  for (size_t i = 0; i < directions.size(); i += 2)
    push(records, directions[i].x, directions[i].y, directions[i + 1].x, directions[i + 1].y);
}

// Where the longest stance of a leg begins, and how long it is, shares of the cycle.
glm::dvec2 contactOf(const Clip& clip, size_t leg, size_t legs) {
  const size_t last = clip.frames() - 1;
  double began = 0, lasted = 0;
  glm::dvec2 longest(0);
  // Twice, as a stance may run through the end.
  for (size_t i = 0; i < 2 * last; ++i) {
    const size_t f = i % last;
    if (clip.stance[f * legs + leg] == 0) {
      lasted = 0;
      continue;
    }
    if (lasted == 0) began = clip.times[f] / clip.seconds;
    lasted += (double{clip.times[f + 1]} - clip.times[f]) / clip.seconds;
    if (lasted > longest.y) longest = {began, lasted};
  }
  return {longest.x, std::min(longest.y, 1.0)};
}

}  // namespace

KeyPoses keyPoses(const ClipSet& set, const std::vector<std::string>& names, uint32_t keys, const Rig& rig,
                  const std::vector<float>& rigRecords) {
  if (keys < skitter::Herd::minKeys || keys > skitter::Herd::maxKeys)
    throw inputError("keys " + std::to_string(keys) + ": expected " + std::to_string(skitter::Herd::minKeys) +
                     " to " + std::to_string(skitter::Herd::maxKeys) + " key poses");
  const std::vector<const Clip*> clips = chosenClips(set, names);
  const auto moving = std::find_if(clips.begin(), clips.end(), [](const Clip* c) { return c->speed > 0; });
  const auto still = std::find_if(clips.begin(), clips.end(), [](const Clip* c) { return c->speed == 0; });
  if (moving == clips.end()) {
    std::string message =
        set.name + ": controller key-poses takes its key poses from a clip that moves forward, and of";
    for (const Clip* clip : clips) message += " '" + clip->name + "'";
    throw inputError(message + " none does; name one by `clips`, or cut one out by `cuts` (docs/scene.md)");
  }
  const Clip& walk = **moving;
  KeyPoses result{static_cast<int>(keys), static_cast<float>(walk.speed * walk.seconds), {}};
  for (size_t l = 0; l < rig.legs.size(); ++l) {
    const RestLeg rest = restOf(rig.legs[l], l, rig.maxBones(), rigRecords);
    const auto directionsAt = [&](const Clip& clip, double phase) {
      Joints joints = jointsAt(set, clip, set.legs[l], (phase - std::floor(phase)) * clip.seconds);
      moveToRoot(rest, joints);
      return directionsOf(rest, joints);
    };
    const glm::dvec2 contact = contactOf(walk, l, set.legs.size());
    push(result.records, contact.x, contact.y, 0, 0);
    pushDirections(result.records, still == clips.end() ? Directions{} : directionsAt(**still, 0),
                   rig.maxBones());
    for (uint32_t k = 0; k < keys; ++k) {
      const double phase = static_cast<double>(k) / keys;
      Directions tangents = directionsAt(walk, phase + kAside);
      const Directions before = directionsAt(walk, phase - kAside);
      for (size_t i = 0; i < tangents.size(); ++i)
        tangents[i] = (tangents[i] - before[i]) / (2 * kAside * keys);
      pushDirections(result.records, directionsAt(walk, phase), rig.maxBones());
      pushDirections(result.records, std::move(tangents), rig.maxBones());
    }
  }
  return result;
}

}  // namespace skitter::crowd
