#include "crowd/radius.h"

#include <algorithm>
#include <cmath>

#include "crowd/controller.h"

namespace skitter::crowd {
namespace {

// At most how far a vertex gets from the body: each leg straight, pointing away from it. What lies along a
// bone adds to the length of the leg, what lies beside it does not.
float furthestOf(const Rig& rig, const SkinVertex& vertex) {
  float mean = 0;
  for (int i = 0; i < 4; ++i) {
    if (vertex.weights[i] <= 0) continue;
    float furthest = glm::length(vertex.position);
    if (const int entry = vertex.bones[i]; entry > 0) {
      const Leg& leg = rig.legs.at(static_cast<size_t>((entry - 1) / rig.maxBones()));
      const size_t last = std::min(static_cast<size_t>((entry - 1) % rig.maxBones()), leg.bones.size() - 1);
      const glm::vec3 from = vertex.position - leg.bones[last].start;
      const float along = glm::dot(from, leg.bones[last].direction);
      float straight = glm::length(leg.root()) + along;
      for (size_t k = 0; k < last; ++k) straight += leg.bones[k].length;
      furthest = glm::length(glm::vec2(straight, glm::length(from - along * leg.bones[last].direction)));
    }
    mean += vertex.weights[i] * furthest;
  }
  return mean;
}

}  // namespace

float radiusOf(const Rig& rig) {
  float radius = 0;
  for (const SkinVertex& vertex : rig.vertices) radius = std::max(radius, furthestOf(rig, vertex));
  for (const Leg& leg : rig.legs) radius = std::max(radius, glm::length(leg.root()) + leg.reach);
  return radius;
}

float radiusOf(const ClipSet& set) {
  float radius = 0;
  for (const Clip& clip : set.clips)
    radius = std::max(radius, glm::length(glm::max(glm::abs(clip.least), glm::abs(clip.most))));
  return radius;
}

float radiusOf(const Kind& kind) {
  return traitsOf(kind.controller).playsClips ? radiusOf(kind.clipSet) : radiusOf(kind.rig);
}

float radiusOf(const Crowd::Impl& crowd, const Herd& herd) {
  float radius = 0;
  for (const SizeRun& run : herd.runs) radius = std::max(radius, radiusOf(crowd.kinds[run.kind]));
  return radius;
}

float footprintRadius(const Rig& rig) {
  float home = 0;
  for (const Leg& leg : rig.legs) home = std::max(home, std::hypot(leg.home.x, leg.home.z));
  return std::max(rig.bodyRadius, home / 2);
}

}  // namespace skitter::crowd
