#include "render/ribbons.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace skitter::render {
namespace {

// Sums over a bone's vertices, of which a line through their radii is made.
struct BoneSurface {
  const Bone* bone = nullptr;  // none of the body, and where a leg has fewer bones than others
  double count = 0, along = 0, alongAlong = 0, radius = 0, alongRadius = 0;
  float least = 0, most = 0;
  glm::vec3 colour[2] = {};
  float share[2] = {};
  struct Point {
    float at;               // metres along the bone
    glm::dvec4 appearance;  // colour; radius
  };
  std::vector<Point> points;

  void add(const SkinVertex& vertex) {
    const glm::vec3 from = vertex.position - bone->start;
    const float at = glm::dot(from, bone->direction), away = glm::length(from - at * bone->direction);
    ++count;
    along += at;
    alongAlong += at * at;
    radius += away;
    alongRadius += at * away;
    points.push_back({at, {vertex.colour, away}});
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

Ribbon::End endOf(uint16_t entry, const BoneSurface& surface, int i, float along) {
  return {entry, surface.bone->direction, along, surface.radiusAt(along),
          surface.colour[i] / surface.share[i]};
}

// Ends and middle of a bone's ribbon: the least-squares polyline through colours and radii. Where there is
// too little skin for one, it stays by their mean.
std::array<Ribbon::End, 3> sectionsOf(uint16_t entry, const BoneSurface& surface) {
  const double length = std::max(double{surface.most} - surface.least, 1e-9);
  glm::dmat3 sums(1e-3 * surface.count);
  glm::dvec4 mean(0);
  for (const BoneSurface::Point& point : surface.points) mean += point.appearance / surface.count;
  std::array<glm::dvec4, 3> found;
  found.fill(1e-3 * surface.count * mean);
  for (const BoneSurface::Point& point : surface.points) {
    const double s = 2 * (point.at - surface.least) / length - 1;  // -1 to 1
    const glm::dvec3 weights(std::max(0.0, -s), 1 - std::abs(s), std::max(0.0, s));
    sums += glm::outerProduct(weights, weights);
    for (int i = 0; i < 3; ++i) found[size_t(i)] += weights[i] * point.appearance;
  }
  const glm::dmat3 inverse = glm::inverse(sums);
  std::array<Ribbon::End, 3> sections;
  for (int i = 0; i < 3; ++i) {
    const glm::dvec4 appearance =
        inverse[0][i] * found[0] + inverse[1][i] * found[1] + inverse[2][i] * found[2];
    sections[size_t(i)] = {entry, surface.bone->direction,
                           glm::mix(surface.least, surface.most, 0.5f * float(i)),
                           float(std::max(0.0, appearance.w)), glm::clamp(glm::vec3(appearance), 0.0f, 1.0f)};
  }
  return sections;
}

// Below these shares nobody sees a waist.
constexpr float kColourStep = 0.02f, kRadiusStep = 0.08f;

bool isWaist(const std::array<Ribbon::End, 3>& sections) {
  const glm::vec3 colour = sections[1].colour - 0.5f * (sections[0].colour + sections[2].colour);
  const float mean = 0.5f * (sections[0].radius + sections[2].radius);
  return glm::any(glm::greaterThan(glm::abs(colour), glm::vec3(kColourStep))) ||
         std::abs(sections[1].radius - mean) > kRadiusStep * mean;
}

// One ribbon for those of bones that follow each other. Each bone counts by its length: its colours at a
// quarter and three quarters of it, nearer to one end of the ribbon and the other.
Ribbon joined(const Leg& leg, const std::vector<Ribbon>& bones, size_t first) {
  Ribbon whole{bones.front().from, bones.back().to, {}};
  if (bones.size() == 1) return whole;
  float length = 0, before = 0;
  for (size_t b = 0; b < bones.size(); ++b) length += leg.bones[first + b].length;
  glm::vec3 colour[2] = {};
  float radius[2] = {}, share[2] = {};
  for (size_t b = 0; b < bones.size(); ++b) {
    const float own = leg.bones[first + b].length;
    for (const auto& [end, at] : {std::pair(bones[b].from, 0.25f), {bones[b].to, 0.75f}}) {
      const float t = (before + at * own) / length;
      for (int i = 0; i < 2; ++i) {
        const float weight = own * (i == 0 ? 1 - t : t);
        colour[i] += weight * end.colour;
        radius[i] += weight * glm::mix(bones[b].from.radius, bones[b].to.radius, at);
        share[i] += weight;
      }
    }
    before += own;
  }
  // So weighed, the value at one end is that at about a third of the way.
  const float a = radius[0] / share[0], b = radius[1] / share[1];
  whole.from.radius = std::max(0.0f, 2 * a - b);
  whole.to.radius = std::max(0.0f, 2 * b - a);
  whole.from.colour = colour[0] / share[0];
  whole.to.colour = colour[1] / share[1];
  return whole;
}

float distanceToLine(const glm::vec3& point, const glm::vec3& from, const glm::vec3& to) {
  const glm::vec3 line = to - from;
  const float share = glm::dot(point - from, line) / std::max(glm::dot(line, line), 1e-12f);
  return glm::distance(point, from + std::clamp(share, 0.0f, 1.0f) * line);
}

// Whether the joints between the bones from `first` to `last` of a leg are within `bend` metres of one line.
bool isStraight(const Leg& leg, size_t first, size_t last, float bend) {
  const glm::vec3 end = leg.bones[last].start + leg.bones[last].length * leg.bones[last].direction;
  for (size_t joint = first + 1; joint <= last; ++joint)
    if (distanceToLine(leg.bones[joint].start, leg.bones[first].start, end) > bend) return false;
  return true;
}

}  // namespace

uint16_t heaviestBone(const SkinVertex& vertex) {
  return vertex.bones[std::max_element(vertex.weights, vertex.weights + 4) - vertex.weights];
}

Ribbons ribbonsOf(const Rig& rig, float radius, float bend, bool waists) {
  Ribbons found;
  const std::vector<BoneSurface> surfaces = boneSurfacesOf(rig);
  std::vector<bool> thin(surfaces.size());
  for (const Leg& leg : rig.legs) {
    const size_t firstEntry = 1 + size_t(&leg - rig.legs.data()) * size_t(rig.maxBones());
    // The bones before this one that the last ribbon joins. There are none where the bone before is not thin.
    std::vector<Ribbon> run;
    for (size_t b = 0; b < leg.bones.size(); ++b) {
      const auto entry = uint16_t(firstEntry + b);
      const BoneSurface& surface = surfaces[entry];
      Ribbon ribbon;
      if (surface.count > 0) {
        ribbon = {endOf(entry, surface, 0, surface.least), endOf(entry, surface, 1, surface.most), {}};
        thin[entry] = std::max(ribbon.from.radius, ribbon.to.radius) <= radius;
      }
      if (!thin[entry]) {
        run.clear();
        continue;
      }
      if (run.empty() || !isStraight(leg, b - run.size(), b, bend)) {
        run.clear();
        found.ribbons.emplace_back();
      }
      run.push_back(ribbon);
      found.ribbons.back() = joined(leg, run, b + 1 - run.size());
      if (!waists || run.size() > 1) continue;
      if (const auto sections = sectionsOf(entry, surface); isWaist(sections))
        found.ribbons.back() = {sections[0], sections[2], sections[1]};
    }
  }
  const auto isThin = [&](uint32_t vertex) { return thin[heaviestBone(rig.vertices[vertex])]; };
  for (auto triangle = rig.indices.begin(); triangle != rig.indices.end(); triangle += 3)
    if (!std::all_of(triangle, triangle + 3, isThin))
      found.others.insert(found.others.end(), triangle, triangle + 3);
  return found;
}

}  // namespace skitter::render
