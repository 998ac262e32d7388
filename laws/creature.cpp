#include "laws/creature.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

namespace skitter::laws {
namespace {

// In leg lengths: skin about the end of a leg is so near to it from above, and so little over it.
constexpr double footRadius = 0.4, footHeight = 0.12;
constexpr double soleShare = 0.25;  // of a foot's vertices
constexpr size_t fewestOfSole = 10;
constexpr double leastBend = 25;  // degrees at rest, else a joint has no side

double across(const glm::dvec3& a, const glm::dvec3& b) { return std::hypot(a.x - b.x, a.z - b.z); }

uint32_t heaviestOf(const SkinVertex& vertex) {
  const auto most = std::ranges::max_element(vertex.weights);
  return vertex.bones[static_cast<size_t>(most - vertex.weights.begin())];
}

int legOf(const Creature& creature, const SkinVertex& vertex) {
  const uint32_t bone = heaviestOf(vertex);
  return bone < creature.legOfBone.size() ? creature.legOfBone[bone] : -1;
}

// The leg whose foot the vertex is about, -1: none.
int footOf(const Creature& creature, const SkinVertex& vertex) {
  int nearest = -1;
  double least = footRadius * creature.legLength;
  for (size_t l = 0; l < creature.legs.size(); ++l)
    if (const double far = across(vertex.rest, creature.legs[l].back().rest); far < least) {
      least = far;
      nearest = static_cast<int>(l);
    }
  if (nearest < 0) return -1;
  const double tip = creature.legs[static_cast<size_t>(nearest)].back().rest.y;
  if (vertex.rest.y - tip > footHeight * creature.legLength) return -1;
  const int leg = legOf(creature, vertex);
  return leg < 0 || leg == nearest ? nearest : -1;
}

std::vector<uint32_t> soleOf(const Creature& creature, std::vector<uint32_t> foot) {
  const size_t count = std::min(
      foot.size(), std::max(fewestOfSole, static_cast<size_t>(soleShare * static_cast<double>(foot.size()))));
  std::ranges::sort(foot, {}, [&](uint32_t v) { return creature.vertices[v].rest.y; });
  foot.resize(count);
  return foot;
}

std::vector<Anatomy::Knee> kneesOf(const Leg& leg) {
  std::vector<Anatomy::Knee> knees;
  for (uint32_t j = 1; j + 1 < leg.size(); ++j) {
    const glm::dvec3 in = leg[j].rest - leg[j - 1].rest, out = leg[j + 1].rest - leg[j].rest;
    const glm::dvec3 axis = glm::cross(in, out);
    const double sine = glm::length(axis);
    if (std::atan2(sine, glm::dot(in, out)) >= glm::radians(leastBend)) knees.push_back({j, axis / sine});
  }
  return knees;
}

double fromLine(const glm::dvec3& point, const glm::dvec3& a, const glm::dvec3& b) {
  const double square = glm::dot(b - a, b - a);
  const double along = square > 0 ? std::clamp(glm::dot(point - a, b - a) / square, 0.0, 1.0) : 0;
  return glm::length(point - a - along * (b - a));
}

// The median distance of a bone's skin from its line.
std::vector<double> radiiOf(const Creature& creature, const Leg& leg) {
  std::vector<double> radii;
  for (size_t b = 0; b + 1 < leg.size(); ++b) {
    std::vector<double> distances;
    for (const SkinVertex& vertex : creature.vertices)
      if (heaviestOf(vertex) == leg[b].bone)
        distances.push_back(fromLine(vertex.rest, leg[b].rest, leg[b + 1].rest));
    const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
    if (!distances.empty()) std::nth_element(distances.begin(), middle, distances.end());
    radii.push_back(distances.empty() ? 0 : *middle);
  }
  return radii;
}

bool sameBones(const SkinVertex& a, const SkinVertex& b) {
  return a.bones == b.bones && a.weights == b.weights;
}

std::vector<Anatomy::Edge> edgesOf(const Creature& creature) {
  std::set<std::pair<uint32_t, uint32_t>> seen;
  std::vector<Anatomy::Edge> edges;
  for (size_t t = 0; t + 2 < creature.triangles.size(); t += 3)
    for (size_t k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(creature.triangles[t + k], creature.triangles[t + (k + 1) % 3]);
      const SkinVertex &from = creature.vertices[a], &to = creature.vertices[b];
      if (sameBones(from, to) || !seen.emplace(a, b).second) continue;
      edges.push_back({a, b, glm::length(to.rest - from.rest)});
    }
  return edges;
}

Anatomy::Hull hullOf(const Creature& creature, std::span<const uint32_t> body) {
  Anatomy::Hull hull;
  if (body.empty()) return hull;
  hull.least.fill(std::numeric_limits<double>::infinity());
  hull.most.fill(-std::numeric_limits<double>::infinity());
  for (const uint32_t v : body)
    for (size_t k = 0; k < Anatomy::planes; ++k) {
      const double along = glm::dot(creature.vertices[v].rest, hullDirections()[k]);
      hull.least[k] = std::min(hull.least[k], along);
      hull.most[k] = std::max(hull.most[k], along);
    }
  hull.centre = 0.5 * glm::dvec3(hull.least[0] + hull.most[0], hull.least[1] + hull.most[1],
                                 hull.least[2] + hull.most[2]);
  for (const uint32_t v : body)
    hull.radius = std::max(hull.radius, glm::length(creature.vertices[v].rest - hull.centre));
  return hull;
}

}  // namespace

const std::array<glm::dvec3, Anatomy::planes>& hullDirections() {
  static const auto directions = [] {
    std::array<glm::dvec3, Anatomy::planes> made = {{{1, 0, 0},
                                                     {0, 1, 0},
                                                     {0, 0, 1},
                                                     {1, 1, 0},
                                                     {1, -1, 0},
                                                     {1, 0, 1},
                                                     {1, 0, -1},
                                                     {0, 1, 1},
                                                     {0, 1, -1},
                                                     {1, 1, 1},
                                                     {1, 1, -1},
                                                     {1, -1, 1},
                                                     {1, -1, -1}}};
    for (glm::dvec3& each : made) each = glm::normalize(each);
    return made;
  }();
  return directions;
}

// Ericson 2005, Real-Time Collision Detection, 5.1.9.
double distanceOf(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d) {
  const glm::dvec3 ab = b - a, cd = d - c, r = a - c;
  const double e = glm::dot(ab, ab), f = glm::dot(cd, cd), g = glm::dot(cd, r);
  const double h = glm::dot(ab, cd), i = glm::dot(ab, r), determinant = e * f - h * h;
  double s = determinant > 0 ? std::clamp((h * g - i * f) / determinant, 0.0, 1.0) : 0;
  double t = f > 0 ? (h * s + g) / f : 0;
  if (t < 0 || t > 1) {
    t = std::clamp(t, 0.0, 1.0);
    s = e > 0 ? std::clamp((h * t - i) / e, 0.0, 1.0) : 0;
  }
  return glm::length(r + s * ab - t * cd);
}

Anatomy::Anatomy(const Creature& creature) {
  limbs.resize(creature.legs.size());
  for (uint32_t v = 0; v < creature.vertices.size(); ++v) {
    const int foot = footOf(creature, creature.vertices[v]);
    if (foot >= 0)
      limbs[static_cast<size_t>(foot)].foot.push_back(v);
    else if (legOf(creature, creature.vertices[v]) < 0)
      body.push_back(v);
  }
  for (size_t l = 0; l < limbs.size(); ++l) {
    const Leg& leg = creature.legs[l];
    limbs[l].sole = soleOf(creature, limbs[l].foot);
    limbs[l].knees = kneesOf(leg);
    limbs[l].radii = radiiOf(creature, leg);
    footprint = std::max(footprint, std::hypot(leg.back().rest.x, leg.back().rest.z));
  }
  edges = edgesOf(creature);
  hull = hullOf(creature, body);
  for (uint32_t a = 0; a < limbs.size(); ++a)
    for (uint32_t b = a + 1; b < limbs.size(); ++b)
      for (uint32_t i = 0; i < limbs[a].radii.size(); ++i)
        for (uint32_t j = 0; j < limbs[b].radii.size(); ++j) {
          const Leg &one = creature.legs[a], &other = creature.legs[b];
          if (distanceOf(one[i].rest, one[i + 1].rest, other[j].rest, other[j + 1].rest) >
              limbs[a].radii[i] + limbs[b].radii[j])
            pairs.push_back({a, i, b, j,
                             0.5 * (glm::length(one[i + 1].rest - one[i].rest) +
                                    glm::length(other[j + 1].rest - other[j].rest))});
        }
}

}  // namespace skitter::laws
