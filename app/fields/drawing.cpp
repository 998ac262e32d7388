#include "app/fields/drawing.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "app/fields/stroke_font.h"

namespace skitter::app {
namespace {

constexpr float strokeShare = 0.14f;  // of a letter's height

float lineDistance(const glm::vec2& place, const glm::vec2& from, const glm::vec2& to) {
  const glm::vec2 way = to - from;
  const float squared = glm::dot(way, way);
  const float along = squared > 0 ? std::clamp(glm::dot(place - from, way) / squared, 0.0f, 1.0f) : 0;
  return glm::distance(place, from + along * way);
}

}  // namespace

Drawing::Drawing(uint32_t width, uint32_t height, const glm::vec3& background)
    : width_(width),
      height_(height),
      right_(width),
      bottom_(height),
      pixels_(size_t{width} * height, background) {}

template <class Distance>
void Drawing::shape(const glm::vec2& least, const glm::vec2& most, const glm::vec3& colour, float opacity,
                    const Distance& distance) {
  const auto clamped = [](float value, uint32_t low, uint32_t high) {
    return static_cast<uint32_t>(std::clamp(value, static_cast<float>(low), static_cast<float>(high)));
  };
  const uint32_t left = clamped(std::floor(least.x) - 1, left_, right_),
                 right = clamped(std::ceil(most.x) + 1, left_, right_),
                 top = clamped(std::floor(least.y) - 1, top_, bottom_),
                 bottom = clamped(std::ceil(most.y) + 1, top_, bottom_);
  for (uint32_t y = top; y < bottom; ++y)
    for (uint32_t x = left; x < right; ++x) {
      const float inside = 0.5f - distance(glm::vec2(x, y) + 0.5f);
      if (inside <= 0) continue;
      glm::vec3& pixel = pixels_[size_t{y} * width_ + x];
      pixel = glm::mix(pixel, colour, opacity * std::min(inside, 1.0f));
    }
}

void Drawing::confine(uint32_t left, uint32_t top, uint32_t columns, uint32_t rows) {
  left_ = std::min(left, width_);
  top_ = std::min(top, height_);
  right_ = std::min(left + columns, width_);
  bottom_ = std::min(top + rows, height_);
}

void Drawing::line(const glm::vec2& from, const glm::vec2& to, float thickness, const glm::vec3& colour,
                   float opacity) {
  const float half = 0.5f * thickness;
  shape(glm::min(from, to) - half, glm::max(from, to) + half, colour, opacity,
        [&](const glm::vec2& place) { return lineDistance(place, from, to) - half; });
}

void Drawing::disc(const glm::vec2& centre, float radius, const glm::vec3& colour, float opacity) {
  line(centre, centre, 2 * radius, colour, opacity);
}

void Drawing::ring(const glm::vec2& centre, float radius, float thickness, const glm::vec3& colour) {
  const float reach = radius + thickness;
  shape(centre - reach, centre + reach, colour, 1, [&](const glm::vec2& place) {
    return std::abs(glm::distance(place, centre) - radius) - 0.5f * thickness;
  });
}

void Drawing::polygon(std::span<const glm::vec2> corners, const glm::vec3& colour, float opacity) {
  glm::vec2 least(1e9f), most(-1e9f), middle(0);
  for (const glm::vec2& corner : corners) {
    least = glm::min(least, corner);
    most = glm::max(most, corner);
    middle += corner / static_cast<float>(corners.size());
  }
  shape(least, most, colour, opacity, [&](const glm::vec2& place) {
    float farthest = -1e9f;  // beyond an edge
    for (size_t i = 0; i < corners.size(); ++i) {
      const glm::vec2 from = corners[i], way = corners[(i + 1) % corners.size()] - from;
      const glm::vec2 normal = glm::vec2(way.y, -way.x) / std::max(glm::length(way), 1e-6f);
      const float side = glm::dot(normal, from - middle) < 0 ? -1.0f : 1.0f;
      farthest = std::max(farthest, side * glm::dot(normal, place - from));
    }
    return farthest;
  });
}

void Drawing::rectangle(const glm::vec2& least, const glm::vec2& most, const glm::vec3& colour) {
  polygon(std::array{least, glm::vec2(most.x, least.y), most, glm::vec2(least.x, most.y)}, colour);
}

float Drawing::textWidth(float size, std::string_view text) {
  float width = 0;
  for (const char c : text) width += glyphOf(c).width + glyphSpace;
  return size / glyphHeight * std::max(0.0f, width - glyphSpace);
}

void Drawing::text(const glm::vec2& place, float size, std::string_view text, const glm::vec3& colour,
                   Align align) {
  const float unit = size / glyphHeight, wide = textWidth(size, text);
  glm::vec2 pen = place;
  pen.x -= align == Align::left ? 0 : align == Align::centre ? 0.5f * wide : wide;
  for (const char c : text) {
    const Glyph glyph = glyphOf(c);
    for (const std::vector<glm::vec2>& stroke : glyph.strokes) {
      const auto at = [&](size_t i) { return pen + unit * glm::vec2(stroke[i].x, -stroke[i].y); };
      for (size_t i = 0; i < stroke.size(); ++i)
        line(at(i > 0 ? i - 1 : 0), at(i), std::max(1.1f, strokeShare * size), colour);
    }
    pen.x += unit * (glyph.width + glyphSpace);
  }
}

std::vector<uint8_t> Drawing::rgba() const {
  std::vector<uint8_t> bytes;
  bytes.reserve(pixels_.size() * 4);
  for (const glm::vec3& pixel : pixels_) {
    for (int k = 0; k < 3; ++k)
      bytes.push_back(static_cast<uint8_t>(std::lround(255 * std::clamp(pixel[k], 0.0f, 1.0f))));
    bytes.push_back(255);
  }
  return bytes;
}

}  // namespace skitter::app
