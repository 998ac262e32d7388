#include "crowd/ways/shapes.h"

#include <algorithm>
#include <limits>
#include <variant>

namespace skitter::crowd {
namespace {

double distanceToLine(const glm::dvec2& place, const glm::dvec2& from, const glm::dvec2& to) {
  const glm::dvec2 way = to - from, delta = place - from;
  const double along = glm::dot(way, way) > 0 ? glm::dot(delta, way) / glm::dot(way, way) : 0;
  return glm::distance(place, from + std::clamp(along, 0.0, 1.0) * way);
}

double distanceToShape(const Disc& disc, const glm::dvec2& place) {
  return glm::distance(place, glm::dvec2(disc.centre)) - double{disc.radius};
}
double distanceToShape(const Capsule& capsule, const glm::dvec2& place) {
  return distanceToLine(place, capsule.from, capsule.to) - double{capsule.radius};
}
// 0 inside.
double distanceToShape(const ConvexPolygon& polygon, const glm::dvec2& place) {
  double nearest = std::numeric_limits<double>::infinity();
  size_t left = 0;
  const size_t n = polygon.corners.size();
  for (size_t i = 0; i < n; ++i) {
    const glm::dvec2 from = polygon.corners[i], to = polygon.corners[(i + 1) % n];
    nearest = std::min(nearest, distanceToLine(place, from, to));
    const glm::dvec2 way = to - from, delta = place - from;
    left += way.x * delta.y - way.y * delta.x > 0;
  }
  return left == 0 || left == n ? 0 : nearest;
}

ShapeBounds boundsOfShape(const Disc& disc) {
  const glm::dvec2 centre(disc.centre);
  return {centre - double{disc.radius}, centre + double{disc.radius}};
}
ShapeBounds boundsOfShape(const Capsule& capsule) {
  const glm::dvec2 from(capsule.from), to(capsule.to);
  return {glm::min(from, to) - double{capsule.radius}, glm::max(from, to) + double{capsule.radius}};
}
ShapeBounds boundsOfShape(const ConvexPolygon& polygon) {
  ShapeBounds bounds{polygon.corners.front(), polygon.corners.front()};
  for (const glm::dvec2 corner : polygon.corners)
    bounds = {glm::min(bounds.least, corner), glm::max(bounds.most, corner)};
  return bounds;
}

}  // namespace

double distanceTo(const Obstacle& obstacle, const glm::dvec2& place) {
  return std::visit([&](const auto& shape) { return distanceToShape(shape, place); }, obstacle.shape);
}

ShapeBounds boundsOf(const Obstacle& obstacle) {
  return std::visit([](const auto& shape) { return boundsOfShape(shape); }, obstacle.shape);
}

std::vector<glm::vec2> cornersOf(const ConvexPolygon& polygon) {
  std::vector<glm::vec2> corners = polygon.corners;
  const glm::dvec2 a = corners[0], b = corners[1], c = corners[2];
  if ((b.x - a.x) * (c.y - b.y) - (b.y - a.y) * (c.x - b.x) < 0) std::ranges::reverse(corners);
  return corners;
}

}  // namespace skitter::crowd
