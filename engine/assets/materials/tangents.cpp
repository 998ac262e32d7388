#include "assets/materials/tangents.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace skitter {
namespace {

glm::dvec3 along(const glm::dvec3& direction, const glm::dvec3& normal) {
  const glm::dvec3 flat = direction - glm::dot(direction, normal) * normal;
  const double length = glm::length(flat);
  return length > 1e-30 && std::isfinite(length) ? flat / length : glm::dvec3(0);
}

glm::dvec3 anyAlong(const glm::dvec3& normal) {
  return along(std::fabs(normal.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0), normal);
}

// The image's right and top on a surface, summed over a vertex's corners.
struct Frame {
  glm::dvec3 right{0}, top{0};
};

class TangentSums {
 public:
  TangentSums(const Model& model, size_t first, const Texture& texture)
      : model_(model), first_(first), rows_(texture.rows()), set_(texture.set) {
    frames_.resize(model.vertices.size() - first);
  }

  void add(const uint32_t* triangle) {
    glm::dvec3 p[3];
    glm::dvec2 uv[3];
    for (int k = 0; k < 3; ++k) {
      p[k] = model_.vertices[triangle[k]].position;
      const glm::vec3 from(model_.look.vertices[triangle[k]].uv[set_], 1);
      uv[k] = {glm::dot(rows_[0], from), glm::dot(rows_[1], from)};
    }
    const glm::dvec3 a = p[1] - p[0], b = p[2] - p[0];
    const glm::dvec2 s = uv[1] - uv[0], t = uv[2] - uv[0];
    const double area = s.x * t.y - t.x * s.y;
    if (area == 0 || !std::isfinite(area)) return;
    // The ways along which u increases and v decreases: to the image's right and to its top.
    const glm::dvec3 right = (a * t.y - b * s.y) / area, top = (a * t.x - b * s.x) / area;
    for (int k = 0; k < 3; ++k) {
      const glm::dvec3 u = p[(k + 1) % 3] - p[k], v = p[(k + 2) % 3] - p[k];
      const double lengths = glm::length(u) * glm::length(v);
      if (!(lengths > 0)) continue;
      const double angle = std::acos(std::clamp(glm::dot(u, v) / lengths, -1.0, 1.0));
      const glm::dvec3 normal(model_.vertices[triangle[k]].normal);
      Frame& frame = frames_[triangle[k] - first_];
      frame.right += angle * along(right, normal);
      frame.top += angle * along(top, normal);
    }
  }

  glm::vec4 tangentOf(size_t vertex) const {
    const glm::dvec3 normal(model_.vertices[vertex].normal);
    const Frame& frame = frames_[vertex - first_];
    glm::dvec3 tangent = along(frame.right, normal);
    if (tangent == glm::dvec3(0)) tangent = anyAlong(normal);
    const double side = glm::dot(glm::cross(normal, tangent), frame.top) < 0 ? -1 : 1;
    return glm::vec4(glm::dvec4(tangent, side));
  }

 private:
  const Model& model_;
  size_t first_;  // of the primitive's vertices
  std::array<glm::vec3, 2> rows_;
  int set_;
  std::vector<Frame> frames_;
};

}  // namespace

glm::dvec4 turnedTangent(const glm::dmat3& linear, const glm::dvec4& tangent) {
  const double side = (tangent.w < 0) != (glm::determinant(linear) < 0) ? -1 : 1;
  const glm::dvec3 turned = linear * glm::dvec3(tangent);
  const double length = glm::length(turned);
  if (!(length > 1e-30) || !std::isfinite(length)) return {1, 0, 0, side};
  return {turned / length, side};
}

void makeTangents(Model& model, size_t first, size_t indices, const Texture& normal) {
  TangentSums sums(model, first, normal);
  for (size_t t = model.indices.size() - indices; t + 2 < model.indices.size(); t += 3)
    sums.add(&model.indices[t]);
  for (size_t v = first; v < model.vertices.size(); ++v) model.look.vertices[v].tangent = sums.tangentOf(v);
}

}  // namespace skitter
