#include "laws/bodies.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <tuple>
#include <utility>

namespace skitter::laws {
namespace {

// Where a body is asked to go about as fast as it can go at all.
constexpr double steepest = 35;     // degrees; steeper ground is in the way
constexpr double leastAsked = 0.1;  // leg lengths a second
constexpr double sameHeading = 10;  // degrees
constexpr double sameSpeed = 0.01;  // of the speed
constexpr double leastWay = 0.1;    // leg lengths; less has no direction
constexpr double longest = 2.5;     // seconds from look to look

double degreesBetween(const glm::dvec3& a, const glm::dvec3& b) {
  return glm::degrees(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
}

glm::dvec3 level(const glm::dvec3& v) { return {v.x, 0, v.z}; }

// Nearly all bodies keep the law by the ground below their middle alone, and are looked at no further.
double heightOver(const Ground& ground, const glm::dvec3& place, double footprint, double legLength) {
  const double middle = place.y - ground.at(place.x, place.z);
  if (infoOf(Law::grounded).bound.isKept(middle / legLength)) return middle;
  const Footing footing = footingOf(ground, place.x, place.z, footprint);
  if (place.y > footing.highest) return place.y - footing.highest;
  return place.y < footing.lowest ? place.y - footing.lowest : 0;
}

// From the up axis to the nearest direction between the vertical and the ground's normal.
double leanOf(const Ground& ground, const Body& body, double footprint) {
  constexpr glm::dvec3 vertical(0, 1, 0);
  constexpr int steps = 8;
  double least = degreesBetween(body.rotation[1], vertical);
  if (infoOf(Law::upright).bound.isKept(least)) return least;
  const glm::dvec3 normal = footingOf(ground, body.position.x, body.position.z, footprint).normal;
  for (int i = 1; i <= steps; ++i)
    least = std::min(
        least, degreesBetween(body.rotation[1], glm::mix(vertical, normal, static_cast<double>(i) / steps)));
  return least;
}

// Whether the ground under and about a body is nowhere steep.
bool isEasy(const Ground& ground, const glm::dvec3& place, double radius) {
  const double least = std::cos(glm::radians(steepest));
  const auto steepness = [&](double x, double z) { return ground.normalAt(place.x + x, place.z + z).y; };
  return steepness(0, 0) > least && steepness(radius, 0) > least && steepness(-radius, 0) > least &&
         steepness(0, radius) > least && steepness(0, -radius) > least;
}

}  // namespace

BodyJudge::BodyJudge(std::vector<const Anatomy*> anatomies, std::vector<const Creature*> creatures,
                     Tally& tally)
    : anatomies_(std::move(anatomies)), creatures_(std::move(creatures)), tally_(tally) {}

void BodyJudge::look(uint64_t tick, double seconds, const Ground& ground, const Body& body, uint32_t agent,
                     size_t size) {
  if (trails_.size() <= agent) trails_.resize(size_t{agent} + 1);
  Trail& trail = trails_[agent];
  if (!body.present) {
    trail = {};
    return;
  }
  const double legLength = creatures_[size]->legLength, footprint = anatomies_[size]->footprint;
  tally_.add(Law::grounded, agent, tick, heightOver(ground, body.position, footprint, legLength) / legLength);
  const Trail before = trail;
  trail = {.seconds = seconds, .body = body, .askedBefore = before.body.asked};
  if (!body.isSteady) {
    trail = {};
    return;
  }
  tally_.add(Law::upright, agent, tick, leanOf(ground, body, footprint));
  const double passed = seconds - before.seconds;
  if (before.seconds < 0 || passed > longest) {
    trail.askedBefore = -1;
    return;
  }
  const glm::dvec3 way = level(body.position - before.body.position);
  const glm::dvec3 now = level(body.rotation * creatures_[size]->forward);
  const glm::dvec3 then = level(before.body.rotation * creatures_[size]->forward);
  if (degreesBetween(now, then) > sameHeading) return;
  if (glm::length(way) >= leastWay * legLength)
    tally_.add(Law::facing, agent, tick, degreesBetween(way, glm::normalize(now) + glm::normalize(then)));
  const auto same = [&](double asked) { return std::abs(asked - body.asked) <= sameSpeed * body.asked; };
  if (body.isFree && before.body.isFree && body.asked >= leastAsked * legLength && same(before.body.asked) &&
      same(before.askedBefore) && isEasy(ground, body.position, footprint) &&
      isEasy(ground, before.body.position, footprint))
    tally_.add(Law::progress, agent, tick, glm::length(way) / (passed * body.asked));
}

namespace {

// How far the skins of two bodies overlap along a direction of the world.
struct Extent {
  double least = std::numeric_limits<double>::infinity(), most = -std::numeric_limits<double>::infinity();
};
Extent extentOf(const Solid& solid, const glm::dvec3& direction) {
  const glm::dvec3 own = glm::transpose(solid.body.rotation) * direction;
  const double at = glm::dot(solid.body.position, direction);
  Extent extent;
  for (const uint32_t v : solid.anatomy->body) {
    const double along = at + glm::dot(solid.creature->vertices[v].rest, own);
    extent.least = std::min(extent.least, along);
    extent.most = std::max(extent.most, along);
  }
  return extent;
}
double overlapOf(const Solid& a, const Solid& b, const glm::dvec3& direction) {
  const Extent one = extentOf(a, direction), other = extentOf(b, direction);
  return std::min(one.most - other.least, other.most - one.least);
}

glm::dvec3 centreOf(const Solid& solid) {
  return solid.body.position + solid.body.rotation * solid.anatomy->hull.centre;
}

}  // namespace

namespace {

// How deep two bodies are in each other: the least that one would have to move, in the directions of either's
// hull and in that from one to the other. 0: they are apart.
double depthOf(const Solid& a, const Solid& b, const glm::dvec3& between) {
  const double far = glm::length(between);
  double depth = far > 0 ? overlapOf(a, b, between / far) : std::numeric_limits<double>::infinity();
  for (const Solid* solid : {&a, &b})
    for (const glm::dvec3& direction : hullDirections()) {
      if (depth <= 0) return 0;
      depth = std::min(depth, overlapOf(a, b, solid->body.rotation * direction));
    }
  return std::max(depth, 0.0);
}

}  // namespace

// Bodies are sorted into rows along x, so that those that are near each other are near in the list.
void judgeApart(uint64_t tick, const std::vector<Solid>& solids) {
  struct Entry {
    int64_t row;
    double x;
    size_t solid;

    bool operator<(const Entry& other) const { return std::tie(row, x) < std::tie(other.row, other.x); }
  };
  double widest = 0;
  for (const Solid& solid : solids) widest = std::max(widest, 2 * solid.anatomy->hull.radius);
  if (widest <= 0) return;
  std::vector<glm::dvec3> centres;
  std::vector<Entry> entries;
  for (size_t i = 0; i < solids.size(); ++i) {
    centres.push_back(centreOf(solids[i]));
    entries.push_back({static_cast<int64_t>(std::floor(centres[i].z / widest)), centres[i].x, i});
  }
  std::ranges::sort(entries, std::less());
  std::vector<double> deepest(solids.size(), 0);
  const auto compare = [&](size_t i, size_t j) {
    const glm::dvec3 between = centres[j] - centres[i];
    const double reach = solids[i].anatomy->hull.radius + solids[j].anatomy->hull.radius;
    if (glm::dot(between, between) > reach * reach) return;
    const double depth = depthOf(solids[i], solids[j], between);
    deepest[i] = std::max(deepest[i], depth);
    deepest[j] = std::max(deepest[j], depth);
  };
  for (auto one = entries.begin(); one != entries.end(); ++one) {
    const auto scan = [&](std::vector<Entry>::iterator other, int64_t row) {
      for (; other != entries.end() && other->row == row && other->x <= one->x + widest; ++other)
        compare(one->solid, other->solid);
    };
    scan(one + 1, one->row);
    scan(std::lower_bound(one, entries.end(), Entry{one->row + 1, one->x - widest, 0}), one->row + 1);
  }
  for (size_t i = 0; i < solids.size(); ++i)
    solids[i].tally->add(Law::apart, solids[i].agent, tick, deepest[i] / solids[i].creature->legLength);
}

}  // namespace skitter::laws
