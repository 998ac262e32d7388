#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace skitter::experiments {

// Colours that people of every colour vision tell apart (Okabe and Ito 2008), dark enough on white.
namespace colour {
inline constexpr const char* ink = "#222222";
inline constexpr const char* faint = "#767676";
inline constexpr const char* grid = "#dddddd";
inline constexpr const char* blue = "#0072b2";
inline constexpr const char* red = "#d55e00";
inline constexpr const char* green = "#009e73";
inline constexpr const char* purple = "#a8559a";
inline constexpr const char* orange = "#c98a00";
inline constexpr const char* sky = "#3a9bd9";
inline constexpr const char* ground = "#8a6d3b";
}  // namespace colour
// The nth of a row of series.
const char* seriesColour(size_t n);

// A drawing in pixels, y downward, as inline SVG. Whatever is not finite is left out: a picture never says
// NaN.
class Svg {
 public:
  Svg(double width, double height, const std::string& description);

  void line(glm::dvec2 from, glm::dvec2 to, const std::string& colour, double width = 1,
            const std::string& dash = {});
  // Breaks where a point is not finite.
  void polyline(const std::vector<glm::dvec2>& points, const std::string& colour, double width = 1.5,
                const std::string& dash = {});
  void polygon(const std::vector<glm::dvec2>& points, const std::string& fill, double opacity = 1);
  void rectangle(glm::dvec2 corner, glm::dvec2 size, const std::string& fill);
  void disc(glm::dvec2 centre, double radius, const std::string& fill, const std::string& edge = {});
  void arrow(glm::dvec2 from, glm::dvec2 to, const std::string& colour);
  enum class Anchor { start, middle, end };
  void text(glm::dvec2 at, const std::string& words, Anchor anchor = Anchor::start, double size = 12,
            const std::string& fill = colour::ink, double degrees = 0);

  double width() const { return width_; }
  double height() const { return height_; }
  std::string str() const { return body_ + "</svg>\n"; }

 private:
  double width_, height_;
  std::string body_;
};

// For text and attributes of HTML and SVG.
std::string escaped(const std::string& text);

}  // namespace skitter::experiments
