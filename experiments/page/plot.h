#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "experiments/page/axis.h"
#include "experiments/page/svg.h"

namespace skitter::experiments {

struct Series {
  std::string name;
  std::vector<glm::dvec2> points;
  std::string colour = {};               // empty: by its place in the row
  bool line = true, markers = true;
  std::string dash = {};
  std::vector<glm::dvec2> spreads = {};  // least and most y of each point, drawn as a bar; or none
};

// A level that the eye should compare with, dashed.
struct Level {
  double y;
  std::string label;
};

struct Plot {
  std::string title;
  AxisInfo x, y;
  std::vector<Series> series;
  std::vector<Level> levels = {};
  double width = 460, height = 320;
};
// Axes, grid, ticks, legend below.
std::string draw(const Plot& plot);

// Bars of shares that add up to at most 1, a bar a place along x.
struct Bars {
  std::string title;
  std::string xLabel;
  std::vector<std::string> places;
  std::vector<std::string> parts;           // names, from the bottom up
  std::vector<std::string> colours;         // one a part
  std::vector<std::vector<double>> shares;  // [place][part]
  double width = 460, height = 190;
};
std::string draw(const Bars& bars);

}  // namespace skitter::experiments
