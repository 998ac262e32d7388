#include "render/limbs.h"

#include <algorithm>

#include "assets/materials/worn_colours.h"
#include "crowd/controller.h"

namespace skitter::render {
namespace {

constexpr float kLeastBone = 1e-6f;  // metres: a rig's bones have a length

Limbs limbsWith(Rig rig, const Look& worn) {
  Limbs limbs{.rig = std::move(rig), .carriers = {}, .entries = {}};
  const std::vector<glm::vec3> colours = wornColours(limbs.rig.vertices, worn);
  for (size_t v = 0; v < colours.size(); ++v) {
    limbs.rig.vertices[v].colour = colours[v];
    limbs.entries.push_back(heaviestBone(limbs.rig.vertices[v]));
  }
  limbs.rig.look = {};
  return limbs;
}

Leg legOf(const ClipLeg& from) {
  Leg leg;
  for (size_t b = 0; b + 1 < from.starts.size(); ++b) {
    const glm::vec3 along = from.starts[b + 1] - from.starts[b];
    Bone& bone = leg.bones.emplace_back();
    bone.start = from.starts[b];
    bone.length = std::max(glm::length(along), kLeastBone);
    if (bone.length > kLeastBone) bone.direction = along / bone.length;
  }
  return leg;
}

// The vertex, hung on what `entries` says of each of its joints.
SkinVertex hung(const SkinVertex& from, const std::vector<uint16_t>& entries) {
  SkinVertex to = from;
  std::ranges::fill(to.bones, uint16_t{0});
  std::ranges::fill(to.weights, 0.0f);
  for (int i = 0, count = 0; i < 4; ++i) {
    if (from.weights[i] <= 0) continue;
    const uint16_t entry = entries[from.bones[i]];
    const int place = int(std::find(to.bones, to.bones + count, entry) - to.bones);
    count = std::max(count, place + 1);
    to.bones[place] = entry;
    to.weights[place] += from.weights[i];
  }
  return to;
}

// The joint that carries most vertices of the body.
uint16_t bodyOf(const Limbs& limbs, size_t joints) {
  std::vector<size_t> counts(joints);
  for (size_t v = 0; v < limbs.entries.size(); ++v)
    counts[limbs.entries[v]] += heaviestBone(limbs.rig.vertices[v]) == 0;
  return uint16_t(std::ranges::max_element(counts) - counts.begin());
}

}  // namespace

Limbs limbsOf(const Rig& rig) {
  Limbs limbs = limbsWith(rig, rig.look);
  for (int entry = 0; entry < rig.paletteSize(); ++entry)
    limbs.carriers.push_back({.entry = uint16_t(entry)});
  return limbs;
}

Limbs limbsOf(const ClipSet& set) {
  Rig rig;
  rig.vertices = set.vertices;
  rig.indices = set.indices;
  for (const ClipLeg& leg : set.legs) rig.legs.push_back(legOf(leg));
  Limbs limbs = limbsWith(std::move(rig), set.look);

  const auto bones = size_t(limbs.rig.maxBones());
  std::vector<uint16_t> entries;
  for (const ClipJoint& joint : set.joints)
    entries.push_back(joint.leg < 0 ? 0 : uint16_t(1 + size_t(joint.leg) * bones + size_t(joint.bone)));
  for (SkinVertex& vertex : limbs.rig.vertices) vertex = hung(vertex, entries);

  limbs.carriers.assign(size_t(limbs.rig.paletteSize()), {});
  limbs.carriers[0].entry = bodyOf(limbs, set.joints.size());
  for (size_t l = 0; l < set.legs.size(); ++l)
    for (size_t b = 0; b < limbs.rig.legs[l].bones.size(); ++b)
      limbs.carriers[1 + l * bones + b] = {.entry = set.legs[l].joints[b], .start = set.legs[l].starts[b]};
  return limbs;
}

Limbs limbsOf(const crowd::Kind& kind) {
  return crowd::traitsOf(kind.controller).playsClips ? limbsOf(kind.clipSet) : limbsOf(kind.rig);
}

}  // namespace skitter::render
