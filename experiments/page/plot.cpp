#include "experiments/page/plot.h"

#include <algorithm>

namespace skitter::experiments {
namespace {

using Anchor = Svg::Anchor;

constexpr double letter = 6.6;  // pixels, about, of a letter of 12

// The rectangle that the data lie in, in pixels.
struct Frame {
  double left, top, width, height;

  glm::dvec2 at(double u, double v) const { return {left + u * width, top + (1 - v) * height}; }
};

double legendWidth(const std::string& name) { return 34 + letter * static_cast<double>(name.size()); }

// Names in rows below the plot; how many rows they take.
int layLegend(const std::vector<std::string>& names, double width, std::vector<glm::dvec2>& places) {
  double x = 0;
  int row = 0;
  for (const std::string& name : names) {
    const double wide = legendWidth(name);
    if (x > 0 && x + wide > width) x = 0, ++row;
    places.emplace_back(x, row);
    x += wide;
  }
  return row + 1;
}

void drawAxes(Svg& svg, const Frame& frame, const Axis& x, const Axis& y, const Plot& plot) {
  for (const Tick& tick : y.ticks()) {
    const glm::dvec2 at = frame.at(0, y.place(tick.value));
    svg.line(at, {frame.left + frame.width, at.y}, colour::grid, tick.label.empty() ? 0.5 : 1);
    svg.text({at.x - 6, at.y + 4}, tick.label, Anchor::end, 11);
  }
  double free = -1e9;  // labels that would run into the one before are left out
  for (const Tick& tick : x.ticks()) {
    const glm::dvec2 at = frame.at(x.place(tick.value), 0);
    svg.line(at, {at.x, frame.top}, colour::grid, tick.label.empty() ? 0.5 : 1);
    const double half = letter * static_cast<double>(tick.label.size()) / 2;
    if (tick.label.empty() || at.x - half < free) continue;
    svg.text({at.x, at.y + 16}, tick.label, Anchor::middle, 11);
    free = at.x + half + 4;
  }
  svg.polyline({frame.at(0, 1), frame.at(0, 0), frame.at(1, 0)}, colour::ink, 1);
  svg.text({frame.left + frame.width / 2, frame.top + frame.height + 34}, plot.x.label, Anchor::middle);
  svg.text({14, frame.top + frame.height / 2}, plot.y.label, Anchor::middle, 12, colour::ink, -90);
  svg.text({frame.left, 18}, plot.title, Anchor::start, 13);
}

void drawSeries(Svg& svg, const Frame& frame, const Axis& x, const Axis& y, const Series& series,
                const std::string& stroke) {
  std::vector<glm::dvec2> path;
  for (const glm::dvec2& p : series.points)
    if (x.holds(p.x) && y.holds(p.y)) path.push_back(frame.at(x.place(p.x), y.place(p.y)));
  if (series.line) svg.polyline(path, stroke, 1.8, series.dash);
  for (size_t i = 0; i < series.spreads.size(); ++i) {
    const double at = series.points[i].x;
    const glm::dvec2 spread = series.spreads[i];
    if (!x.holds(at) || !y.holds(spread.x) || !y.holds(spread.y)) continue;
    svg.line(frame.at(x.place(at), y.place(spread.x)), frame.at(x.place(at), y.place(spread.y)), stroke);
  }
  if (!series.markers) return;
  for (const glm::dvec2& p : path) svg.disc(p, 3, stroke);
}

}  // namespace

std::string draw(const Plot& plot) {
  std::vector<std::string> names;
  std::vector<double> xs, ys;
  for (const Series& series : plot.series) {
    names.push_back(series.name);
    for (const glm::dvec2& p : series.points) xs.push_back(p.x), ys.push_back(p.y);
    for (const glm::dvec2& p : series.spreads) ys.push_back(p.x), ys.push_back(p.y);
  }
  for (const Level& level : plot.levels) ys.push_back(level.y);
  std::vector<glm::dvec2> places;
  const int rows = layLegend(names, plot.width - 76, places);
  const double height = plot.height + 18 * rows;
  const Frame frame{72, 30, plot.width - 98, plot.height - 78};
  const Axis x(plot.x, xs), y(plot.y, ys);

  Svg svg(plot.width, height, plot.title);
  drawAxes(svg, frame, x, y, plot);
  for (const Level& level : plot.levels) {
    const glm::dvec2 at = frame.at(0, y.place(level.y));
    svg.line(at, {frame.left + frame.width, at.y}, colour::ink, 1.2, "5 4");
    svg.text({frame.left + frame.width - 3, at.y - 4}, level.label, Anchor::end, 11);
  }
  for (size_t i = 0; i < plot.series.size(); ++i) {
    const Series& series = plot.series[i];
    const std::string stroke = series.colour.empty() ? seriesColour(i) : series.colour;
    drawSeries(svg, frame, x, y, series, stroke);
    const glm::dvec2 at(frame.left + places[i].x, plot.height + 6 + 18 * places[i].y);
    if (series.line) svg.line(at, at + glm::dvec2(20, 0), stroke, 1.8, series.dash);
    if (series.markers) svg.disc(at + glm::dvec2(10, 0), 3, stroke);
    svg.text(at + glm::dvec2(25, 4), series.name);
  }
  return svg.str();
}

std::string draw(const Bars& bars) {
  Svg svg(bars.width, bars.height, bars.title);
  const Frame frame{62, 30, bars.width - 78, bars.height - 92};
  const double step = frame.width / std::max<double>(1, static_cast<double>(bars.places.size()));
  double free = -1e9;
  for (size_t i = 0; i < bars.places.size(); ++i) {
    double from = 0;
    const double left = frame.left + step * (static_cast<double>(i) + 0.1);
    for (size_t part = 0; part < bars.parts.size(); ++part) {
      const double share = bars.shares[i][part];
      const double top = frame.at(0, from + share).y;
      svg.rectangle({left, top}, {0.8 * step, share * frame.height}, bars.colours[part]);
      from += share;
    }
    const double middle = left + 0.4 * step, half = letter * static_cast<double>(bars.places[i].size()) / 2;
    if (middle - half < free) continue;
    svg.text({middle, frame.top + frame.height + 14}, bars.places[i], Anchor::middle, 11);
    free = middle + half + 4;
  }
  for (const double share : {0.0, 0.5, 1.0}) {
    const glm::dvec2 at = frame.at(0, share);
    svg.line({at.x - 4, at.y}, at, colour::ink);
    svg.text({at.x - 7, at.y + 4}, share == 0 ? "0" : (share == 1 ? "1" : "0.5"), Anchor::end, 11);
  }
  svg.polyline({frame.at(0, 1), frame.at(0, 0), frame.at(1, 0)}, colour::ink, 1);
  svg.text({frame.left, 18}, bars.title, Anchor::start, 13);
  svg.text({frame.left + frame.width / 2, frame.top + frame.height + 32}, bars.xLabel, Anchor::middle);
  double x = frame.left;
  for (size_t part = 0; part < bars.parts.size(); ++part) {
    svg.rectangle({x, bars.height - 17}, {12, 12}, bars.colours[part]);
    svg.text({x + 17, bars.height - 7}, bars.parts[part]);
    x += legendWidth(bars.parts[part]);
  }
  return svg.str();
}

}  // namespace skitter::experiments
