#include "crowd/support.h"

#include <algorithm>
#include <limits>
#include <ranges>
#include <utility>

namespace skitter::crowd {
namespace {

double crossOf(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

// Counter-clockwise, without points on its edges (Andrew 1979).
std::vector<glm::dvec2> hullOf(std::vector<glm::dvec2> points) {
  std::ranges::sort(points, [](const glm::dvec2& a, const glm::dvec2& b) {
    return a.x < b.x || (a.x == b.x && a.y < b.y);
  });
  if (points.size() < 3) return points;
  std::vector<glm::dvec2> hull;
  const auto goAlong = [&](auto&& range) {
    const size_t begin = hull.size();
    for (const glm::dvec2& point : range) {
      while (hull.size() > begin + 1 &&
             crossOf(hull.back() - hull[hull.size() - 2], point - hull[hull.size() - 2]) <= 0)
        hull.pop_back();
      hull.push_back(point);
    }
    hull.pop_back();
  };
  goAlong(points);
  goAlong(points | std::views::reverse);
  return hull;
}

double distanceToSide(const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b) {
  const glm::dvec2 way = b - a;
  const double square = glm::dot(way, way);
  const double t = square > 0 ? std::clamp(glm::dot(p - a, way) / square, 0.0, 1.0) : 0;
  return glm::length(p - a - t * way);
}

}  // namespace

SupportPolygon::SupportPolygon(std::vector<glm::dvec2> feet) {
  std::vector<glm::dvec2> hull = hullOf(std::move(feet));
  if (hull.size() < 3) {
    corners_ = std::move(hull);
    return;
  }
  for (size_t i = 0; i < hull.size(); ++i) {
    const glm::dvec2 along = glm::normalize(hull[(i + 1) % hull.size()] - hull[i]), inward(-along.y, along.x);
    edges_.push_back({inward, glm::dot(inward, hull[i])});
  }
}

double SupportPolygon::marginOf(const glm::dvec2& place) const {
  double margin = std::numeric_limits<double>::infinity();
  for (const Edge& edge : edges_) margin = std::min(margin, glm::dot(edge.inward, place) - edge.offset);
  if (!edges_.empty()) return margin;
  return corners_.empty() ? -margin : -distanceToSide(place, corners_.front(), corners_.back());
}

}  // namespace skitter::crowd
