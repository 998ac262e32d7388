#include "render/obstacle_mesh.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <variant>

#include "crowd/ways/shapes.h"

namespace skitter::render {
namespace {

constexpr size_t kMostVertices = 1 << 20;
constexpr float kMostParts = 256;  // of a line, and of a circle
constexpr float kLeastArcs = 24;   // of a circle
constexpr float kMostRings = 64;
constexpr int kWallRows = 3;  // of vertices: the skirt's end, the wall's, and the top's edge
// Shares of the height: a wall without a radius has a half of this, and edges are rounded by at most this.
constexpr float kThinnest = 1.0f / 12, kRounding = 1.0f / 10;
constexpr float kSkirt = 4;  // heights, for ground far away is drawn in coarser triangles

// A point of an outline, which goes round with +x turning to +z.
struct OutlinePoint {
  glm::vec2 place, normal;
  glm::vec2 inward;  // metres by which it moves where the outline shrinks by one
  glm::vec2 core;    // where the middle is closest
};

struct Outline {
  std::vector<OutlinePoint> points = {};
  float rounding = 0;  // metres
  uint32_t rings = 1;  // of the top
};

float partsOf(float length, float step, float least) {
  return std::clamp(std::ceil(length / step), least, kMostParts);
}

glm::vec2 outwardOf(const glm::vec2& way) { return {way.y, -way.x}; }

// Half a circle or a whole one about `core`, from `start` on, without its end.
void addArc(Outline& outline, const glm::vec2& core, float radius, const glm::vec2& start, float angle,
            float step) {
  const float whole = 2 * std::numbers::pi_v<float>;
  const float parts = std::ceil(partsOf(whole * radius, step, kLeastArcs) * angle / whole);
  for (float i = 0; i < parts; ++i) {
    const float turn = angle * i / parts, c = std::cos(turn), s = std::sin(turn);
    const glm::vec2 n(c * start.x - s * start.y, s * start.x + c * start.y);
    outline.points.push_back({core + radius * n, n, -n, core});
  }
}

Outline outlineOf(const Disc& disc, float height, float step) {
  const float radius = std::max(disc.radius, kThinnest / 2 * height);
  Outline outline{.rounding = radius / 3};
  addArc(outline, disc.centre, radius, {1, 0}, 2 * std::numbers::pi_v<float>, step);
  return outline;
}

Outline outlineOf(const Capsule& capsule, float height, float step) {
  const float radius = std::max(capsule.radius, kThinnest / 2 * height);
  const float length = glm::distance(capsule.from, capsule.to);
  if (!(length > 0)) return outlineOf(Disc{.centre = capsule.from, .radius = radius}, height, step);
  Outline outline{.rounding = radius / 3};
  const glm::vec2 out = outwardOf((capsule.to - capsule.from) / length);
  const auto addSide = [&](const glm::vec2& from, const glm::vec2& to, const glm::vec2& normal) {
    const float parts = partsOf(length, step, 1);
    for (float i = 0; i < parts; ++i) {
      const glm::vec2 core = glm::mix(from, to, i / parts);
      outline.points.push_back({core + radius * normal, normal, -normal, core});
    }
    addArc(outline, to, radius, normal, std::numbers::pi_v<float>, step);
  };
  addSide(capsule.from, capsule.to, out);
  addSide(capsule.to, capsule.from, -out);
  return outline;
}

Outline outlineOf(const ConvexPolygon& polygon, float, float step) {
  const std::vector<glm::vec2> corners = crowd::cornersOf(polygon);
  const size_t n = corners.size();
  glm::vec2 middle(0);
  for (const glm::vec2& corner : corners) middle += corner / static_cast<float>(n);
  std::vector<glm::vec2> normals;
  float least = HUGE_VALF;
  for (size_t i = 0; i < n; ++i) {
    normals.push_back(outwardOf(glm::normalize(corners[(i + 1) % n] - corners[i])));
    least = std::min(least, glm::dot(normals[i], corners[i] - middle));
  }
  // At a corner both edges move; an acute one moves three times as far at most.
  const auto mitre = [](const glm::vec2& a, const glm::vec2& b) {
    const glm::vec2 inward = -(a + b) / std::max(1 + glm::dot(a, b), 1e-3f);
    return inward * std::min(1.0f, 3 / std::max(glm::length(inward), 1e-6f));
  };
  Outline outline{.rounding = least / 4};
  for (size_t i = 0; i < n; ++i) {
    const glm::vec2 from = corners[i], to = corners[(i + 1) % n], normal = normals[i];
    const float parts = partsOf(glm::distance(from, to), step, 1);
    for (float k = 0; k <= parts; ++k) {
      const glm::vec2 inward = k == 0       ? mitre(normals[(i + n - 1) % n], normal)
                               : k == parts ? mitre(normal, normals[(i + 1) % n])
                                            : -normal;
      outline.points.push_back({glm::mix(from, to, k / parts), normal, inward, middle});
    }
  }
  return outline;
}

Outline outlineOf(const Obstacle& obstacle, float height, float step) {
  Outline outline =
      std::visit([&](const auto& shape) { return outlineOf(shape, height, step); }, obstacle.shape);
  outline.rounding = std::min(outline.rounding, kRounding * height);
  float longest = 0;
  for (const OutlinePoint& point : outline.points)
    longest = std::max(longest, glm::distance(point.place, point.core));
  outline.rings = static_cast<uint32_t>(std::clamp(std::ceil(longest / step), 1.0f, kMostRings));
  return outline;
}

void addRow(ObstacleMesh& mesh, const Outline& outline, uint32_t row, float height) {
  const float b = outline.rounding;
  for (const OutlinePoint& point : outline.points) {
    if (row < kWallRows - 1) {
      mesh.vertices.push_back(
          {{point.place, row == 0 ? -kSkirt * height : height - b}, {point.normal.x, 0, point.normal.y}});
      continue;
    }
    const float share = static_cast<float>(row - (kWallRows - 1)) / static_cast<float>(outline.rings);
    const glm::vec2 at = glm::mix(point.place + b * point.inward, point.core, share);
    mesh.vertices.push_back({{at, height}, {0, 1, 0}});
  }
}

void add(ObstacleMesh& mesh, const Outline& outline, float height) {
  const auto first = static_cast<uint32_t>(mesh.vertices.size()),
             round = static_cast<uint32_t>(outline.points.size());
  const uint32_t rows = kWallRows + outline.rings;
  for (uint32_t row = 0; row < rows; ++row) {
    addRow(mesh, outline, row, height);
    if (row == 0) continue;
    const uint32_t below = first + (row - 1) * round, above = below + round;
    for (uint32_t i = 0; i < round; ++i) {
      const uint32_t next = (i + 1) % round;
      for (const uint32_t index : {below + i, above + i, below + next, below + next, above + i, above + next})
        mesh.indices.push_back(index);
    }
  }
}

}  // namespace

ObstacleMesh obstacleMesh(std::span<const Obstacle> obstacles, float height, float step) {
  for (bool last = false;; step *= 2) {
    std::vector<Outline> outlines;
    size_t vertices = 0;
    for (const Obstacle& obstacle : obstacles) {
      outlines.push_back(outlineOf(obstacle, height, step));
      vertices += outlines.back().points.size() * (kWallRows + outlines.back().rings);
    }
    last = step > 4096;  // all have the fewest vertices then
    if (vertices > kMostVertices && !last) continue;
    ObstacleMesh mesh;
    for (const Outline& outline : outlines) add(mesh, outline, height);
    return mesh;
  }
}

}  // namespace skitter::render
