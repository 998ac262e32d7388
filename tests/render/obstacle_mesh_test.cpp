#include "render/obstacle_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <vector>

namespace skitter::render {
namespace {

constexpr float kWall = 0.75f;  // metres high

std::vector<Obstacle> everyShape() {
  return {{Disc{.centre = {3, -4}, .radius = 2}},
          {Disc{.centre = {9, 0}, .radius = 0.01f}},
          {Capsule{.from = {-8, 2}, .to = {4, 5}, .radius = 0.4f}},
          {Capsule{.from = {-8, 2}, .to = {-8, 9}}},
          {Capsule{.from = {1, 1}, .to = {1, 1}, .radius = 1}},
          {ConvexPolygon{.corners = {{0, 0}, {20, 0}, {20, 1}, {0, 1}}}},
          {ConvexPolygon{.corners = {{0, 0}, {0, 3}, {5, 0}}}}};  // the other way round
}

glm::vec3 corner(const ObstacleMesh& mesh, size_t index) {
  const glm::vec3& p = mesh.vertices[mesh.indices[index]].place;
  return {p.x, p.z, p.y};
}

TEST(ObstacleMesh, FacesOutward) {
  for (const Obstacle& obstacle : everyShape()) {
    const ObstacleMesh mesh = obstacleMesh({&obstacle, 1}, kWall, 0.5f);
    ASSERT_GT(mesh.indices.size(), 0u);
    for (size_t i = 0; i < mesh.indices.size(); i += 3) {
      const glm::vec3 a = corner(mesh, i),
                      face = glm::cross(corner(mesh, i + 1) - a, corner(mesh, i + 2) - a);
      if (glm::length(face) < 1e-6f) continue;  // where an outline meets itself
      for (size_t k = 0; k < 3; ++k) {
        const glm::vec3& normal = mesh.vertices[mesh.indices[i + k]].normal;
        EXPECT_NEAR(glm::length(normal), 1, 1e-5f);
        EXPECT_GT(glm::dot(normal, glm::normalize(face)), -1e-3f) << obstacle.shape.index() << " at " << i;
      }
    }
  }
}

// An edge that only one triangle has is at the end of the skirt.
TEST(ObstacleMesh, IsOpenBelowTheGroundOnly) {
  using Point = std::tuple<long, long, long>;  // millimetres
  const auto pointOf = [](const glm::vec3& p) {
    return Point(std::lround(1000 * p.x), std::lround(1000 * p.y), std::lround(1000 * p.z));
  };
  for (const Obstacle& obstacle : everyShape()) {
    const ObstacleMesh mesh = obstacleMesh({&obstacle, 1}, kWall, 0.5f);
    std::map<std::pair<Point, Point>, int> ways;  // one way along an edge less the other
    for (size_t i = 0; i < mesh.indices.size(); i += 3)
      for (size_t k = 0; k < 3; ++k) {
        const Point from = pointOf(corner(mesh, i + k)), to = pointOf(corner(mesh, i + (k + 1) % 3));
        if (from == to) continue;
        ways[std::minmax(from, to)] += from < to ? 1 : -1;
      }
    for (const auto& [edge, count] : ways)
      if (count != 0) {
        EXPECT_LT(std::get<1>(edge.first), -1000) << obstacle.shape.index();
        EXPECT_LT(std::get<1>(edge.second), -1000) << obstacle.shape.index();
      }
  }
}

TEST(ObstacleMesh, HasTheOutlineOfTheObstacle) {
  const std::vector<Obstacle> shapes = everyShape();
  const auto extent = [&](size_t i) {
    glm::vec2 least(1e9f), most(-1e9f);
    for (const ObstacleVertex& vertex : obstacleMesh({&shapes[i], 1}, kWall, 0.5f).vertices) {
      least = glm::min(least, glm::vec2(vertex.place));
      most = glm::max(most, glm::vec2(vertex.place));
      EXPECT_LE(vertex.place.z, kWall);
    }
    return std::pair(least, most);
  };
  const auto near = [](const glm::vec2& a, const glm::vec2& b, float by) { return glm::distance(a, b) < by; };
  EXPECT_TRUE(near(extent(0).first, {1, -6}, 0.02f));
  EXPECT_TRUE(near(extent(0).second, {5, -2}, 0.02f));
  // Thin ones are thick enough to be seen.
  EXPECT_NEAR(extent(1).second.x - extent(1).first.x, kWall / 12, 0.01f);
  EXPECT_NEAR(extent(3).second.x - extent(3).first.x, kWall / 12, 0.01f);
  EXPECT_TRUE(near(extent(2).first, {-8.4f, 1.6f}, 0.02f));
  EXPECT_TRUE(near(extent(2).second, {4.4f, 5.4f}, 0.02f));
  EXPECT_TRUE(near(extent(5).first, {0, 0}, 1e-5f));
  EXPECT_TRUE(near(extent(5).second, {20, 1}, 1e-5f));
}

// The top begins as far from the outline as the wall ends below it: a tenth of the height, a third of a
// radius or a quarter of the way to the middle of a polygon, whatever is least.
TEST(ObstacleMesh, HasARoundedEdge) {
  const std::vector<Obstacle> shapes = everyShape();
  const float thin = kWall / 24;  // half as wide as can be seen
  for (const auto& [shape, rounding] : {std::pair{0u, kWall / 10},
                                        {1u, thin / 3},
                                        {2u, kWall / 10},
                                        {3u, thin / 3},
                                        {4u, kWall / 10},
                                        {5u, kWall / 10}}) {
    float wall = 0, outline = 0, top = 0;
    const ObstacleMesh mesh = obstacleMesh({&shapes[shape], 1}, kWall, 0.5f);
    for (const ObstacleVertex& vertex : mesh.vertices) {
      if (vertex.place.z < kWall) wall = std::max(wall, vertex.place.z);
      float& most = vertex.place.z < kWall ? outline : top;
      most = std::max(most, vertex.place.x - mesh.vertices[0].place.x + 100);
    }
    EXPECT_NEAR(kWall - wall, rounding, 1e-5f) << shape;
    EXPECT_NEAR(outline - top, rounding, 1e-3f) << shape;
  }
  const std::vector<Obstacle> narrow = {{ConvexPolygon{.corners = {{0, 0}, {20, 0}, {20, 0.2f}, {0, 0.2f}}}}};
  float wall = 0;
  for (const ObstacleVertex& vertex : obstacleMesh(narrow, kWall, 0.5f).vertices)
    if (vertex.place.z < kWall) wall = std::max(wall, vertex.place.z);
  EXPECT_NEAR(kWall - wall, 0.1f / 4, 1e-5f);
}

// As many and as large as a scene may have.
TEST(ObstacleMesh, IsBounded) {
  const std::vector<Obstacle> discs(4096, {Disc{.radius = 4096}});
  EXPECT_LE(obstacleMesh(discs, kWall, 0.5f).vertices.size(), size_t{1} << 20);
  EXPECT_TRUE(obstacleMesh({}, kWall, 0.5f).indices.empty());
}

}  // namespace
}  // namespace skitter::render
