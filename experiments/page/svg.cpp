#include "experiments/page/svg.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace skitter::experiments {
namespace {

bool isFinite(glm::dvec2 p) { return std::isfinite(p.x) && std::isfinite(p.y); }

std::string dashed(const std::string& dash) {
  return dash.empty() ? "" : fmt::format(" stroke-dasharray=\"{}\"", dash);
}

std::string pointList(const std::vector<glm::dvec2>& points) {
  std::string list;
  for (const glm::dvec2& p : points)
    list += fmt::format("{}{:.1f},{:.1f}", list.empty() ? "" : " ", p.x, p.y);
  return list;
}

}  // namespace

const char* seriesColour(size_t n) {
  static constexpr std::array all = {colour::blue,   colour::red, colour::green, colour::purple,
                                     colour::orange, colour::sky, colour::ink,   colour::faint};
  return all[n % all.size()];
}

std::string escaped(const std::string& text) {
  std::string made;
  for (const char c : text) {
    switch (c) {
      case '&':
        made += "&amp;";
        break;
      case '<':
        made += "&lt;";
        break;
      case '>':
        made += "&gt;";
        break;
      case '"':
        made += "&quot;";
        break;
      default:
        made += c;
    }
  }
  return made;
}

Svg::Svg(double width, double height, const std::string& description) : width_(width), height_(height) {
  body_ = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:g} {1:g}\" width=\"{0:g}\" role=\"img\" "
      "font-family=\"sans-serif\"><title>{2}</title>\n"
      "<rect width=\"{0:g}\" height=\"{1:g}\" fill=\"#ffffff\"/>\n",
      width, height, escaped(description));
}

void Svg::line(glm::dvec2 from, glm::dvec2 to, const std::string& stroke, double width,
               const std::string& dash) {
  polyline({from, to}, stroke, width, dash);
}

void Svg::polyline(const std::vector<glm::dvec2>& points, const std::string& stroke, double width,
                   const std::string& dash) {
  std::vector<glm::dvec2> run;
  const auto flush = [&] {
    if (run.size() > 1) {
      body_ += fmt::format(
          "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{:g}\" "
          "stroke-linejoin=\"round\" stroke-linecap=\"round\"{}/>\n",
          pointList(run), stroke, width, dashed(dash));
    }
    run.clear();
  };
  for (const glm::dvec2& p : points) {
    if (isFinite(p))
      run.push_back(p);
    else
      flush();
  }
  flush();
}

void Svg::polygon(const std::vector<glm::dvec2>& points, const std::string& fill, double opacity) {
  for (const glm::dvec2& p : points)
    if (!isFinite(p)) return;
  body_ += fmt::format("<polygon points=\"{}\" fill=\"{}\" fill-opacity=\"{:g}\"/>\n", pointList(points),
                       fill, opacity);
}

void Svg::rectangle(glm::dvec2 corner, glm::dvec2 size, const std::string& fill) {
  if (!isFinite(corner) || !isFinite(size)) return;
  body_ += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\"/>\n",
                       corner.x, corner.y, size.x, size.y, fill);
}

void Svg::disc(glm::dvec2 centre, double radius, const std::string& fill, const std::string& edge) {
  if (!isFinite(centre)) return;
  const std::string stroke = edge.empty() ? "" : fmt::format(" stroke=\"{}\" stroke-width=\"1.5\"", edge);
  body_ += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:g}\" fill=\"{}\"{}/>\n", centre.x, centre.y,
                       radius, fill, stroke);
}

void Svg::arrow(glm::dvec2 from, glm::dvec2 to, const std::string& stroke) {
  if (!isFinite(from) || !isFinite(to) || glm::distance(from, to) < 1) return;
  const glm::dvec2 along = glm::normalize(to - from), across(-along.y, along.x);
  line(from, to - 5.0 * along, stroke, 1.2);
  polygon({to, to - 7.0 * along + 3.0 * across, to - 7.0 * along - 3.0 * across}, stroke);
}

void Svg::text(glm::dvec2 at, const std::string& words, Anchor anchor, double size, const std::string& fill,
               double degrees) {
  if (!isFinite(at) || words.empty()) return;
  static constexpr std::array anchors = {"start", "middle", "end"};
  const std::string turned =
      degrees == 0 ? "" : fmt::format(" transform=\"rotate({:g} {:.1f} {:.1f})\"", degrees, at.x, at.y);
  body_ += fmt::format(
      "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" font-size=\"{:g}\" fill=\"{}\"{}>{}</text>\n", at.x,
      at.y, anchors[static_cast<size_t>(anchor)], size, fill, turned, escaped(words));
}

}  // namespace skitter::experiments
