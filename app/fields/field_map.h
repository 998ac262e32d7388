#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "app/fields/drawing.h"
#include "skitter/heightfield.h"
#include "skitter/ways.h"

namespace skitter::app {

// Maps show this, seen from above: x to the right, z down.
struct MapGround {
  const Heightfield& terrain;
  std::span<const Obstacle> obstacles;
  const CostGrid& grid;
  std::string title, subtitle;
};

// A goal of some agents, and the times from everywhere to it.
struct MapGoal {
  glm::vec2 goal, stop;
  std::span<const glm::vec4> times;  // for each cell at the four middles from it on, as agents go by them
  // For each cell, whether a way leads to the goal.
  std::vector<bool> reached;
  std::vector<glm::vec2> starts;  // where those agents are
};

// Pheromone, and those who go by it: foragers, or scouts who look for one path.
struct MapTrail {
  std::string what;               // of what the values are, for the legend
  std::span<const float> values;  // of the cells, 0 or more
  std::vector<Disc> nests = {}, food = {};
  std::vector<glm::vec2> agents = {};
  std::vector<glm::vec2> path = {};  // the best one of scouts
};

struct TrailFigures {
  double marked = 0;         // share of the passable cells that have some
  double most = 0, sum = 0;  // of all cells
};
TrailFigures figuresOf(const MapGround& ground, const MapTrail& trail);

struct MapFigures {
  double passable = 0;                // share of cells
  double costMean = 1, costMost = 1;  // of these
};
MapFigures figuresOf(const CostGrid& grid);

struct TimeFigures {
  double reached = 0;         // share of the passable cells
  double mean = 0, most = 0;  // of their times
};
TimeFigures figuresOf(const MapGround& ground, const MapGoal& goal);

Drawing drawCosts(const MapGround& ground);
Drawing drawTimes(const MapGround& ground, const MapGoal& goal);
Drawing drawTrail(const MapGround& ground, const MapTrail& trail);

// The way down the times from a place, as far as it goes: to the goal or where a region ends.
std::vector<glm::vec2> wayFrom(const MapGround& ground, const MapGoal& goal, glm::vec2 place);

// The greatest of 1, 2 and 5 times a power of ten that is at most `value`, which is above 0.
double niceBelow(double value);

}  // namespace skitter::app
