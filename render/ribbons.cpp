#include "render/ribbons.h"

#include <algorithm>

namespace skitter::render {
namespace {

// The entry of the pose palette that carries most of a vertex.
uint16_t heaviestBone(const SkinVertex& vertex) {
  return vertex.bones[std::max_element(vertex.weights, vertex.weights + 4) - vertex.weights];
}

// Sums over a bone's vertices, of which a line through their radii is made.
struct BoneSurface {
  const Bone* bone = nullptr;  // none of the body, and where a leg has fewer bones than others
  double count = 0, along = 0, alongAlong = 0, radius = 0, alongRadius = 0;
  float least = 0, most = 0;
  glm::vec3 colour[2] = {};
  float share[2] = {};

  void add(const SkinVertex& vertex) {
    const glm::vec3 from = vertex.position - bone->start;
    const float at = glm::dot(from, bone->direction), away = glm::length(from - at * bone->direction);
    ++count;
    along += at;
    alongAlong += at * at;
    radius += away;
    alongRadius += at * away;
    least = std::min(least, at);
    most = std::max(most, at);
    const float end = std::clamp(at / bone->length, 0.0f, 1.0f);
    for (int i = 0; i < 2; ++i) {
      const float weight = 1e-3f + (i == 0 ? 1 - end : end);
      colour[i] += weight * vertex.colour;
      share[i] += weight;
    }
  }
  // Least squares; what lies in one place has one radius.
  float radiusAt(float at) const {
    const double spread = count * alongAlong - along * along;
    const double slope =
        spread > 1e-6f * count * count * most * most ? (count * alongRadius - along * radius) / spread : 0;
    return float(std::max(0.0, (radius - slope * along) / count + slope * at));
  }
};

// By entry of the palette.
std::vector<BoneSurface> boneSurfacesOf(const Rig& rig) {
  std::vector<BoneSurface> surfaces(size_t(rig.paletteSize()));
  for (size_t leg = 0; leg < rig.legs.size(); ++leg)
    for (size_t b = 0; b < rig.legs[leg].bones.size(); ++b) {
      BoneSurface& surface = surfaces[1 + leg * size_t(rig.maxBones()) + b];
      surface.bone = &rig.legs[leg].bones[b];
      surface.most = surface.bone->length;
    }
  for (const SkinVertex& vertex : rig.vertices)
    if (BoneSurface& surface = surfaces[heaviestBone(vertex)]; surface.bone != nullptr) surface.add(vertex);
  return surfaces;
}

Ribbon::End endOf(const BoneSurface& surface, int i, float along) {
  return {along, surface.radiusAt(along), surface.colour[i] / surface.share[i]};
}

}  // namespace

Ribbons ribbonsOf(const Rig& rig, float radius) {
  Ribbons found;
  const std::vector<BoneSurface> surfaces = boneSurfacesOf(rig);
  std::vector<bool> thin(surfaces.size());
  for (size_t entry = 0; entry < surfaces.size(); ++entry) {
    const BoneSurface& surface = surfaces[entry];
    if (surface.count == 0) continue;
    const Ribbon ribbon{uint16_t(entry), surface.bone->direction, endOf(surface, 0, surface.least),
                        endOf(surface, 1, surface.most)};
    thin[entry] = std::max(ribbon.from.radius, ribbon.to.radius) <= radius;
    if (thin[entry]) found.ribbons.push_back(ribbon);
  }
  const auto isThin = [&](uint32_t vertex) { return thin[heaviestBone(rig.vertices[vertex])]; };
  for (auto triangle = rig.indices.begin(); triangle != rig.indices.end(); triangle += 3)
    if (!std::all_of(triangle, triangle + 3, isThin))
      found.others.insert(found.others.end(), triangle, triangle + 3);
  return found;
}

}  // namespace skitter::render
