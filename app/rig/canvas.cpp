#include "app/rig/canvas.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/srgb.h"

namespace skitter::app {
namespace {

uint8_t encode(float linear) { return static_cast<uint8_t>(std::lround(255 * base::srgbOfLinear(linear))); }

}  // namespace

Canvas::Canvas(uint32_t width, uint32_t height, const glm::vec3& colour)
    : width_(width),
      height_(height),
      columns_(static_cast<int>(width * samples_)),
      rows_(static_cast<int>(height * samples_)),
      colour_(size_t{width} * samples_ * height * samples_, colour),
      depth_(colour_.size(), -std::numeric_limits<float>::infinity()) {}

void Canvas::confine(uint32_t x, uint32_t y, uint32_t width, uint32_t height) {
  left_ = static_cast<int>(x * samples_);
  top_ = static_cast<int>(y * samples_);
  columns_ = static_cast<int>(width * samples_);
  rows_ = static_cast<int>(height * samples_);
}

size_t Canvas::index(int x, int y) const {
  return static_cast<size_t>(top_ + y) * width_ * samples_ + static_cast<size_t>(left_ + x);
}

void Canvas::blend(int x, int y, const glm::vec3& colour, float opacity) {
  if (x < 0 || y < 0 || x >= columns_ || y >= rows_) return;
  glm::vec3& at = colour_[index(x, y)];
  at = glm::mix(at, colour, opacity);
}

void Canvas::triangle(const glm::vec3 corners[3], const Paint& paint) {
  constexpr auto scale = static_cast<float>(samples_);
  const glm::vec2 a = glm::vec2(corners[0]) * scale, b = glm::vec2(corners[1]) * scale,
                  c = glm::vec2(corners[2]) * scale;
  const auto cross = [](const glm::vec2& u, const glm::vec2& v) { return u.x * v.y - u.y * v.x; };
  const float area = cross(b - a, c - a);
  if (!(std::fabs(area) > 1e-6f)) return;
  const auto least = [](float p, float q, float r) {
    return static_cast<int>(std::floor(std::min({p, q, r})));
  };
  const auto most = [](float p, float q, float r) {
    return static_cast<int>(std::ceil(std::max({p, q, r})));
  };
  const int x0 = std::max(0, least(a.x, b.x, c.x)), x1 = std::min(columns_ - 1, most(a.x, b.x, c.x));
  const int y0 = std::max(0, least(a.y, b.y, c.y)), y1 = std::min(rows_ - 1, most(a.y, b.y, c.y));
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) {
      const glm::vec2 p(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
      const float u = cross(b - p, c - p) / area, v = cross(c - p, a - p) / area, w = 1 - u - v;
      if (u < 0 || v < 0 || w < 0) continue;
      const float depth = u * corners[0].z + v * corners[1].z + w * corners[2].z;
      const size_t at = index(x, y);
      if (depth <= depth_[at]) continue;
      const std::optional<glm::vec3> colour = paint({u, v, w});
      if (!colour) continue;
      depth_[at] = depth;
      colour_[at] = *colour;
    }
  }
}

void Canvas::line(const glm::vec3& from, const glm::vec3& to, const glm::vec3& colour, float width,
                  float opacity) {
  constexpr auto scale = static_cast<float>(samples_);
  const glm::vec2 a = glm::vec2(from) * scale, b = glm::vec2(to) * scale;
  const float half = 0.5f * width * scale;
  const glm::vec2 along = b - a;
  const float squared = glm::dot(along, along);
  const int x0 = std::max(0, static_cast<int>(std::floor(std::min(a.x, b.x) - half)));
  const int x1 = std::min(columns_ - 1, static_cast<int>(std::ceil(std::max(a.x, b.x) + half)));
  const int y0 = std::max(0, static_cast<int>(std::floor(std::min(a.y, b.y) - half)));
  const int y1 = std::min(rows_ - 1, static_cast<int>(std::ceil(std::max(a.y, b.y) + half)));
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) {
      const glm::vec2 p(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
      const float t = squared > 0 ? std::clamp(glm::dot(p - a, along) / squared, 0.0f, 1.0f) : 0.0f;
      if (glm::distance(p, a + t * along) <= half) blend(x, y, colour, opacity);
    }
  }
}

void Canvas::disc(const glm::vec3& centre, float radius, const glm::vec3& colour) {
  line(centre, centre, colour, 2 * radius, 1);
}

std::vector<uint8_t> Canvas::rgba() const {
  std::vector<uint8_t> bytes;
  bytes.reserve(size_t{width_} * height_ * 4);
  for (uint32_t y = 0; y < height_; ++y) {
    for (uint32_t x = 0; x < width_; ++x) {
      glm::vec3 sum(0);
      for (uint32_t j = 0; j < samples_; ++j) {
        for (uint32_t i = 0; i < samples_; ++i) {
          sum += colour_[size_t{y * samples_ + j} * width_ * samples_ + x * samples_ + i];
        }
      }
      sum /= static_cast<float>(samples_ * samples_);
      for (int k = 0; k < 3; ++k) bytes.push_back(encode(sum[k]));
      bytes.push_back(255);
    }
  }
  return bytes;
}

}  // namespace skitter::app
