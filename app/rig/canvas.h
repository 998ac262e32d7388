#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

namespace skitter::app {

// A picture drawn in software, in linear light, with a depth a pixel; samples are averaged when it is done.
class Canvas {
 public:
  Canvas(uint32_t width, uint32_t height, const glm::vec3& colour);

  // Positions in pixels, z toward the viewer. Triangles hide one another, lines and discs lie over all.
  // `paint` gives the colour of a point from how near it is to each corner: shares that sum to 1, and are as
  // the picture shows them. None is a hole.
  using Paint = std::function<std::optional<glm::vec3>(const glm::vec3& shares)>;
  void triangle(const glm::vec3 corners[3], const Paint& paint);
  void line(const glm::vec3& from, const glm::vec3& to, const glm::vec3& colour, float width, float opacity);
  void disc(const glm::vec3& centre, float radius, const glm::vec3& colour);
  // Confines what follows to a rectangle, with positions relative to its corner.
  void confine(uint32_t x, uint32_t y, uint32_t width, uint32_t height);

  std::vector<uint8_t> rgba() const;  // sRGB, width x height

 private:
  static constexpr uint32_t samples_ = 2;  // a pixel, in x and in y
  void blend(int x, int y, const glm::vec3& colour, float opacity);
  size_t index(int x, int y) const;

  uint32_t width_, height_;
  int left_ = 0, top_ = 0, columns_, rows_;  // of the rectangle, in samples
  std::vector<glm::vec3> colour_;
  std::vector<float> depth_;
};

}  // namespace skitter::app
