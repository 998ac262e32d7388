#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string_view>
#include <vector>

namespace skitter::app {

// A flat picture: shapes with smooth edges, one over the other. Places are pixels, y down; colours are sRGB
// from 0 to 1.
class Drawing {
 public:
  Drawing(uint32_t width, uint32_t height, const glm::vec3& background);

  uint32_t width() const { return width_; }
  uint32_t height() const { return height_; }

  void set(uint32_t x, uint32_t y, const glm::vec3& colour) { pixels_[size_t{y} * width_ + x] = colour; }
  glm::vec3 at(uint32_t x, uint32_t y) const { return pixels_[size_t{y} * width_ + x]; }
  // Shapes that follow are drawn within these columns and rows only.
  void confine(uint32_t left, uint32_t top, uint32_t columns, uint32_t rows);
  void confine() { confine(0, 0, width_, height_); }

  // With round ends.
  void line(const glm::vec2& from, const glm::vec2& to, float thickness, const glm::vec3& colour,
            float opacity = 1);
  void disc(const glm::vec2& centre, float radius, const glm::vec3& colour, float opacity = 1);
  void ring(const glm::vec2& centre, float radius, float thickness, const glm::vec3& colour);
  // Convex, its corners either way round.
  void polygon(std::span<const glm::vec2> corners, const glm::vec3& colour, float opacity = 1);
  void rectangle(const glm::vec2& least, const glm::vec2& most, const glm::vec3& colour);

  enum class Align { left, centre, right };
  // Capitals are `size` pixels high and stand at `place`.
  void text(const glm::vec2& place, float size, std::string_view text, const glm::vec3& colour,
            Align align = Align::left);
  static float textWidth(float size, std::string_view text);

  std::vector<uint8_t> rgba() const;

 private:
  // Blends wherever `distance` from the shape's edge, negative inside, says so.
  template <class Distance>
  void shape(const glm::vec2& least, const glm::vec2& most, const glm::vec3& colour, float opacity,
             const Distance& distance);

  uint32_t width_, height_;
  uint32_t left_ = 0, top_ = 0, right_, bottom_;  // where shapes are drawn
  std::vector<glm::vec3> pixels_;
};

}  // namespace skitter::app
