#include "assets/scenes/obstacles.h"

#include <fmt/format.h>

#include <cmath>

#include "skitter/error.h"
#include "skitter/scene.h"

namespace skitter::scenes {
namespace {

void expectPlace(const glm::vec2& place, const std::string& what) {
  for (int i = 0; i < 2; ++i)
    if (!(std::abs(place[i]) <= Scene::maxCoordinate))
      throw inputError(fmt::format("{}[{}] is {}, expected a number from {} to {}", what, i, place[i],
                                   -Scene::maxCoordinate, Scene::maxCoordinate));
}

void expectRadius(float radius, double least, const std::string& what) {
  if (!(double{radius} >= least && radius <= Scene::maxCoordinate))
    throw inputError(fmt::format("{}.radius is {}, expected a number from {} to {}", what, radius, least,
                                 Scene::maxCoordinate));
}

void check(const Disc& disc, const std::string& what) {
  expectPlace(disc.centre, what + ".disc.centre");
  expectRadius(disc.radius, Disc::minRadius, what + ".disc");
}

void check(const Capsule& capsule, const std::string& what) {
  expectPlace(capsule.from, what + ".capsule.from");
  expectPlace(capsule.to, what + ".capsule.to");
  expectRadius(capsule.radius, 0, what + ".capsule");
}

// Twice the area of a triangle, positive where its corners are in one sense of rotation.
double areaOf(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// All corners lie on the same side of each edge: a star, which turns one way too, is refused.
void check(const ConvexPolygon& polygon, const std::string& what) {
  const std::vector<glm::vec2>& corners = polygon.corners;
  const std::string name = what + ".polygon.corners";
  const size_t n = corners.size();
  if (n < ConvexPolygon::minCorners || n > ConvexPolygon::maxCorners)
    throw inputError(fmt::format("{} has {}, expected {} to {}", name, n, ConvexPolygon::minCorners,
                                 ConvexPolygon::maxCorners));
  for (size_t i = 0; i < n; ++i) expectPlace(corners[i], fmt::format("{}[{}]", name, i));
  const double sense = areaOf(corners[0], corners[1], corners[2]) > 0 ? 1 : -1;
  for (size_t i = 0; i < n; ++i)
    for (size_t k = 2; k < n; ++k)
      if (!(sense * areaOf(corners[i], corners[(i + 1) % n], corners[(i + k) % n]) > 0))
        throw inputError(
            fmt::format("{} is not convex: [{}] is on the wrong side of the edge from [{}] to "
                        "[{}], or on its line",
                        name, (i + k) % n, i, (i + 1) % n));
}

}  // namespace

void checkObstacle(const Obstacle& obstacle, const std::string& what) {
  std::visit([&](const auto& shape) { check(shape, what); }, obstacle.shape);
}

void checkThreat(const Threat& threat, const std::string& what) {
  expectPlace(threat.centre, what + ".centre");
  expectRadius(threat.radius, 0, what);
}

}  // namespace skitter::scenes
