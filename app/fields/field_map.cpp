#include "app/fields/field_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <variant>

#include "app/fields/colours.h"

namespace skitter::app {
namespace {

constexpr uint32_t longestMapSide = 1040;  // pixels of a map
constexpr uint32_t leastMapSide = 420;     // of its picture, for the legend
constexpr uint32_t mapLeft = 36, mapTop = 92, belowMap = 78, legendWidth = 250;
constexpr glm::vec3 paperColour(1), inkColour(0.13f, 0.14f, 0.17f), quietColour(0.42f, 0.44f, 0.48f);
constexpr glm::vec3 blockedColour(0.44f, 0.46f, 0.50f), rockColour(0.19f, 0.20f, 0.23f),
    signalColour(0.90f, 0.16f, 0.22f), wayColour(1.0f, 0.72f, 0.30f), foodColour(0.10f, 0.42f, 0.86f);
constexpr float arrowEvery = 34, arrowLength = 15;  // pixels
constexpr size_t mostDrawnWays = 12, mostDrawnStarts = 4000;

size_t mapCellOf(const CostGrid& grid, const glm::vec2& place) {
  const auto along = [&](float at, uint32_t count) {
    return static_cast<size_t>(std::clamp(at, 0.0f, static_cast<float>(count - 1)));
  };
  const glm::vec2 at = (place - grid.origin) / grid.cell;
  return along(at.y, grid.rows) * grid.columns + along(at.x, grid.columns);
}

bool isPassable(const CostGrid& grid, size_t cell) { return std::isfinite(grid.cost[cell]); }

// A time and its gradient, bilinear between the middles of the four cells around a place.
struct TimeHere {
  float time;
  glm::vec2 gradient;  // seconds a metre
};
TimeHere timeAt(const CostGrid& grid, std::span<const glm::vec4> times, const glm::vec2& place) {
  const glm::vec2 last(static_cast<float>(grid.columns - 1), static_cast<float>(grid.rows - 1));
  const glm::vec2 u = glm::clamp((place - grid.origin) / grid.cell - 0.5f, glm::vec2(0), last);
  const glm::vec2 i = glm::min(glm::floor(u), last - 1.0f), f = u - i;
  const size_t at = static_cast<size_t>(i.y) * grid.columns + static_cast<size_t>(i.x);
  const float a = times[at].x, b = times[at].y, c = times[at].z, d = times[at].w;
  const glm::vec2 slope(glm::mix(b - a, d - c, f.y), glm::mix(c - a, d - b, f.x));
  return {glm::mix(glm::mix(a, b, f.x), glm::mix(c, d, f.x), f.y), slope / grid.cell};
}

// A picture with a map of the terrain, and room for a title and a legend.
class MapPicture {
 public:
  explicit MapPicture(const MapGround& ground)
      : ground_(ground),
        terrain_(ground.terrain),
        scale_(scaleOf(terrain_)),
        columns_(pixels(terrain_.extentX())),
        rows_(pixels(terrain_.extentZ())),
        drawing_(mapLeft + columns_ + legendWidth, mapTop + std::max(rows_, leastMapSide) + belowMap,
                 paperColour) {
    drawing_.text({mapLeft, 42}, 19, ground.title, inkColour);
    drawing_.text({mapLeft, 70}, 11, ground.subtitle, quietColour);
    float lowest = 1e9f, highest = -1e9f;
    for (const float height : terrain_.heights) {
      lowest = std::min(lowest, height);
      highest = std::max(highest, height);
    }
    drawScale(fmt::format("relief: {:.4g} m", double{highest} - double{lowest}));
  }

  Drawing& drawing() { return drawing_; }
  uint32_t columns() const { return columns_; }
  uint32_t rows() const { return rows_; }
  float scale() const { return scale_; }
  glm::vec2 placeOf(float x, float y) const {  // of a pixel of the map
    return glm::vec2(terrain_.originX(), terrain_.originZ()) + glm::vec2(x, y) / scale_;
  }
  glm::vec2 pixelOf(const glm::vec2& place) const {
    return glm::vec2(mapLeft, mapTop) + (place - glm::vec2(terrain_.originX(), terrain_.originZ())) * scale_;
  }
  bool isOn(const glm::vec2& pixel) const {
    const glm::vec2 at = pixel - glm::vec2(mapLeft, mapTop);
    return at.x >= 0 && at.y >= 0 && at.x <= static_cast<float>(columns_) &&
           at.y <= static_cast<float>(rows_);
  }

  // Each pixel by its place, shaded as ground with the light from the upper left.
  template <class Colour>
  void fill(const Colour& colourAt) {
    const glm::vec3 light = glm::normalize(glm::vec3(-1, 1.6f, -1));
    for (uint32_t y = 0; y < rows_; ++y)
      for (uint32_t x = 0; x < columns_; ++x) {
        const glm::vec2 place = placeOf(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
        const float lit = glm::dot(terrain_.normalAt(place.x, place.y), light) / light.y;
        drawing_.set(mapLeft + x, mapTop + y, colourAt(place) * std::clamp(0.45f + 0.55f * lit, 0.4f, 1.08f));
      }
  }

  // What is drawn by the call stays on the map.
  template <class Draw>
  void drawOnMap(const Draw& drawAll) {
    drawing_.confine(mapLeft, mapTop, columns_, rows_);
    drawAll();
    drawing_.confine();
  }

  void drawObstacles() {
    drawOnMap([&] {
      for (const Obstacle& obstacle : ground_.obstacles)
        std::visit([&](const auto& shape) { draw(shape); }, obstacle.shape);
    });
    frame();
  }

  // A row of the legend, with a mark 26 pixels wide.
  template <class Mark>
  void explain(const std::string& text, const Mark& mark) {
    const glm::vec2 at(static_cast<float>(mapLeft + columns_) + 34, row_);
    mark(at + glm::vec2(13, -5));
    drawing_.text(at + glm::vec2(38, 0), 10.5f, text, inkColour);
    row_ += 27;
  }

  // A colour bar from `least` at its top to `most`, with a tick at every `step`.
  template <class Colour>
  void explainColours(const std::string& what, double least, double most, double step,
                      const Colour& colourOf) {
    const float x = static_cast<float>(mapLeft + columns_) + 34;
    drawing_.text({x, row_ + 6}, 10.5f, what, inkColour);
    row_ += 22;
    constexpr uint32_t height = 190, width = 26;
    for (uint32_t y = 0; y < height; ++y)
      for (uint32_t i = 0; i < width; ++i)
        drawing_.set(static_cast<uint32_t>(x) + i, static_cast<uint32_t>(row_) + y,
                     colourOf(static_cast<float>(y) / (height - 1)));
    for (double value = std::ceil(least / step - 1e-9) * step; value <= most + 1e-9 * step; value += step) {
      const float y = row_ + static_cast<float>((value - least) / (most - least)) * height;
      drawing_.line({x + width, y}, {x + width + 5, y}, 1.2f, inkColour);
      drawing_.text({x + width + 11, y + 4.5f}, 9.5f, fmt::format("{:.6g}", value + 0.0), inkColour);
    }
    row_ += height + 36;
  }

  void explainGround() {
    explain("obstacle", [&](const glm::vec2& at) { swatch(at, rockColour); });
    explain("impassable", [&](const glm::vec2& at) { swatch(at, blockedColour); });
  }
  void swatch(const glm::vec2& at, const glm::vec3& colour) {
    drawing_.rectangle(at - glm::vec2(11, 7), at + glm::vec2(11, 7), colour);
  }

  void arrow(const glm::vec2& from, const glm::vec2& to, const glm::vec3& colour, float thickness,
             float opacity = 1) {
    const glm::vec2 way = to - from, aside(-way.y, way.x);
    const float head = std::min(0.45f, 6 / std::max(glm::length(way), 1e-3f));
    drawing_.line(from, to, thickness, colour, opacity);
    for (const float side : {-0.6f, 0.6f})
      drawing_.line(to, to - head * (way + side * aside), thickness, colour, opacity);
  }

 private:
  static float scaleOf(const Heightfield& terrain) {
    return static_cast<float>(longestMapSide) / std::max(terrain.extentX(), terrain.extentZ());
  }
  uint32_t pixels(float metres) const {
    return std::max(1u, static_cast<uint32_t>(std::lround(metres * scale_)));
  }

  void draw(const Disc& disc) { post(disc.centre, disc.centre, disc.radius); }
  void draw(const Capsule& capsule) { post(capsule.from, capsule.to, capsule.radius); }
  void draw(const ConvexPolygon& polygon) {
    std::vector<glm::vec2> corners;
    for (const glm::vec2& corner : polygon.corners) corners.push_back(pixelOf(corner));
    drawing_.polygon(corners, rockColour);
  }
  void post(const glm::vec2& from, const glm::vec2& to, float radius) {
    drawing_.line(pixelOf(from), pixelOf(to), std::max(2.5f, 2 * radius * scale_), rockColour);
  }

  void frame() {
    const glm::vec2 least(mapLeft, mapTop), most = least + glm::vec2(columns_, rows_);
    const std::array corners = {least, glm::vec2(most.x, least.y), most, glm::vec2(least.x, most.y)};
    for (size_t i = 0; i < 4; ++i) drawing_.line(corners[i], corners[(i + 1) % 4], 1.2f, inkColour);
  }

  // A scale bar, the axes and a remark, below the map.
  void drawScale(const std::string& remark) {
    const double metres = niceBelow(0.25 * static_cast<double>(columns_) / static_cast<double>(scale_));
    const float y = static_cast<float>(mapTop + rows_) + 26, wide = static_cast<float>(metres) * scale_;
    for (int part = 0; part < 4; ++part)
      drawing_.rectangle({mapLeft + 0.25f * static_cast<float>(part) * wide, y},
                         {mapLeft + 0.25f * static_cast<float>(part + 1) * wide, y + 6},
                         part % 2 == 0 ? inkColour : quietColour);
    drawing_.text({mapLeft + wide + 10, y + 8}, 11, fmt::format("{:g} m", metres), inkColour);
    drawing_.text({mapLeft, y + 34}, 10, remark, quietColour);
    const glm::vec2 corner(static_cast<float>(mapLeft + columns_) - 62, y + 2);
    arrow(corner, corner + glm::vec2(30, 0), inkColour, 1.6f);
    arrow(corner, corner + glm::vec2(0, 30), inkColour, 1.6f);
    drawing_.text(corner + glm::vec2(37, 5), 10, "x", inkColour);
    drawing_.text(corner + glm::vec2(-14, 32), 10, "z", inkColour);
  }

  const MapGround& ground_;
  const Heightfield& terrain_;
  float scale_;
  uint32_t columns_, rows_;
  Drawing drawing_;
  float row_ = static_cast<float>(mapTop) + 12;  // where the legend goes on
};

glm::vec2 unitOrZero(const glm::vec2& v) {
  const float length = glm::length(v);
  return length > 1e-6f ? v / length : glm::vec2(0);
}

// The colours of times, a thin line at every multiple of `step` and a thick one at every fifth.
void fillTimes(MapPicture& picture, const MapGround& ground, const MapGoal& goal, double most, double step) {
  const CostGrid& grid = ground.grid;
  picture.fill([&](const glm::vec2& place) {
    const size_t cell = mapCellOf(grid, place);
    if (!isPassable(grid, cell)) return blockedColour;
    const TimeHere here = timeAt(grid, goal.times, place);
    const bool reached = goal.reached[cell];
    glm::vec3 colour = timeColour(static_cast<float>(double{here.time} / most));
    const double line = std::round(double{here.time} / step);
    const double apart = std::abs(double{here.time} - line * step) /
                         std::max(double{glm::length(here.gradient)}, 1e-6) * double{picture.scale()};
    const bool fifth = std::fmod(line, 5) == 0;
    const auto strength = static_cast<float>(std::clamp((fifth ? 1.5 : 1.1) - apart, 0.0, 1.0));
    if (line > 0) colour = glm::mix(colour, glm::vec3(1), (fifth ? 0.9f : 0.55f) * strength);
    return reached ? colour : glm::mix(faded(colour, 0.15f), glm::vec3(0.75f), 0.4f);
  });
}

void drawFlow(MapPicture& picture, const MapGround& ground, const MapGoal& goal) {
  for (float y = arrowEvery / 2; y < static_cast<float>(picture.rows()); y += arrowEvery)
    for (float x = arrowEvery / 2; x < static_cast<float>(picture.columns()); x += arrowEvery) {
      const glm::vec2 place = picture.placeOf(x, y);
      const size_t cell = mapCellOf(ground.grid, place);
      if (!isPassable(ground.grid, cell) || !goal.reached[cell]) continue;
      const glm::vec2 way = -unitOrZero(timeAt(ground.grid, goal.times, place).gradient);
      const glm::vec2 middle = picture.pixelOf(place), half = 0.5f * arrowLength * way;
      if (way == glm::vec2(0)) continue;
      picture.arrow(middle - half, middle + half, inkColour, 3.0f, 0.4f);
      picture.arrow(middle - half, middle + half, paperColour, 1.3f, 0.95f);
    }
}

void drawWay(MapPicture& picture, std::span<const glm::vec2> way) {
  for (const float thickness : {4.2f, 2.2f})
    for (size_t i = 1; i < way.size(); ++i)
      picture.drawing().line(picture.pixelOf(way[i - 1]), picture.pixelOf(way[i]), thickness,
                             thickness > 3 ? inkColour : wayColour);
}

void drawAgents(MapPicture& picture, std::span<const glm::vec2> agents) {
  const size_t every = std::max<size_t>(1, agents.size() / mostDrawnStarts);
  for (size_t i = 0; i < agents.size(); i += every)
    if (const glm::vec2 at = picture.pixelOf(agents[i]); picture.isOn(at)) {
      picture.drawing().disc(at, 2.6f, paperColour);
      picture.drawing().disc(at, 1.7f, inkColour);
    }
}

void drawWays(MapPicture& picture, const MapGround& ground, const MapGoal& goal) {
  const size_t starts = goal.starts.size(), ways = std::min(starts, mostDrawnWays);
  for (size_t k = 0; k < ways; ++k) drawWay(picture, wayFrom(ground, goal, goal.starts[k * starts / ways]));
  drawAgents(picture, goal.starts);
}

void explainWay(MapPicture& picture, const std::string& text) {
  picture.explain(text, [&](const glm::vec2& at) {
    picture.drawing().line(at - glm::vec2(10, 0), at + glm::vec2(10, 0), 4.2f, inkColour);
    picture.drawing().line(at - glm::vec2(10, 0), at + glm::vec2(10, 0), 2.2f, wayColour);
  });
}

void explainAgent(MapPicture& picture) {
  picture.explain("agent", [&](const glm::vec2& at) { picture.drawing().disc(at, 2.2f, inkColour); });
}

// Nests and food are rings, no smaller than they can be seen.
void drawRing(MapPicture& picture, const Disc& disc, const glm::vec3& colour) {
  const float radius = std::max(5.0f, disc.radius * picture.scale());
  picture.drawing().ring(picture.pixelOf(disc.centre), radius, 4.5f, paperColour);
  picture.drawing().ring(picture.pixelOf(disc.centre), radius, 2.5f, colour);
}

void drawGoal(Drawing& drawing, const glm::vec2& at) {
  drawing.ring(at, 10, 5.5f, paperColour);
  drawing.ring(at, 10, 3, signalColour);
  drawing.disc(at, 4.5f, paperColour);
  drawing.disc(at, 3.2f, signalColour);
}

void drawStop(Drawing& drawing, const glm::vec2& at) {
  for (const float thickness : {6.0f, 3.0f})
    for (const float side : {-1.0f, 1.0f})
      drawing.line(at - glm::vec2(6, side * 6), at + glm::vec2(6, side * 6), thickness,
                   thickness > 4 ? paperColour : signalColour);
}

}  // namespace

double niceBelow(double value) {
  const double ten = std::pow(10, std::floor(std::log10(value)));
  for (const double factor : {5.0, 2.0})
    if (factor * ten <= value * (1 + 1e-9)) return factor * ten;
  return ten;
}

MapFigures figuresOf(const CostGrid& grid) {
  MapFigures figures;
  double sum = 0;
  size_t count = 0;
  for (const float cost : grid.cost) {
    if (!std::isfinite(cost)) continue;
    ++count;
    sum += double{cost};
    figures.costMost = std::max(figures.costMost, double{cost});
  }
  figures.passable = static_cast<double>(count) / static_cast<double>(grid.cost.size());
  if (count > 0) figures.costMean = sum / static_cast<double>(count);
  return figures;
}

TimeFigures figuresOf(const MapGround& ground, const MapGoal& goal) {
  TimeFigures figures;
  double sum = 0;
  size_t reached = 0, passable = 0;
  for (size_t cell = 0; cell < goal.times.size(); ++cell) {
    passable += isPassable(ground.grid, cell);
    if (!goal.reached[cell]) continue;
    ++reached;
    sum += double{goal.times[cell].x};
    figures.most = std::max(figures.most, double{goal.times[cell].x});
  }
  if (reached == 0) return figures;
  figures.reached = static_cast<double>(reached) / static_cast<double>(passable);
  figures.mean = sum / static_cast<double>(reached);
  return figures;
}

TrailFigures figuresOf(const MapGround& ground, const MapTrail& trail) {
  TrailFigures figures;
  size_t marked = 0, passable = 0;
  for (size_t cell = 0; cell < trail.values.size(); ++cell) {
    passable += isPassable(ground.grid, cell);
    marked += isPassable(ground.grid, cell) && trail.values[cell] > 0;
    figures.sum += double{trail.values[cell]};
    figures.most = std::max(figures.most, double{trail.values[cell]});
  }
  if (passable > 0) figures.marked = static_cast<double>(marked) / static_cast<double>(passable);
  return figures;
}

std::vector<glm::vec2> wayFrom(const MapGround& ground, const MapGoal& goal, glm::vec2 place) {
  const float step = 0.25f * ground.grid.cell;
  // Along a wall the gradient turns the way back and forth; where it gets no further it is at an end.
  constexpr size_t patience = 64;
  std::vector<glm::vec2> way{place};
  float best = HUGE_VALF;
  for (size_t since = 0; since < patience; ++since) {
    if (glm::distance(place, goal.stop) < 1.25f * ground.grid.cell) {
      way.push_back(goal.stop);
      return way;
    }
    const TimeHere here = timeAt(ground.grid, goal.times, place);
    if (here.time < best) {
      best = here.time;
      since = 0;
    }
    place -= step * unitOrZero(here.gradient);
    way.push_back(place);
  }
  way.resize(way.size() - patience);
  return way;
}

Drawing drawCosts(const MapGround& ground) {
  const double most = std::max(1.2, figuresOf(ground.grid).costMost);
  const auto shareOf = [&](float cost) { return static_cast<float>((double{cost} - 1) / (most - 1)); };
  MapPicture picture(ground);
  picture.fill([&](const glm::vec2& place) {
    const size_t cell = mapCellOf(ground.grid, place);
    return isPassable(ground.grid, cell) ? costColour(shareOf(ground.grid.cost[cell])) : blockedColour;
  });
  picture.drawObstacles();
  picture.explainColours("cost of a metre, flat = 1", 1, most, niceBelow((most - 1) / 4), costColour);
  picture.explainGround();
  return picture.drawing();
}

Drawing drawTimes(const MapGround& ground, const MapGoal& goal) {
  const double most = std::max(figuresOf(ground, goal).most, 1e-3), step = niceBelow(most / 12);
  MapPicture picture(ground);
  fillTimes(picture, ground, goal, most, step);
  drawFlow(picture, ground, goal);
  picture.drawObstacles();
  drawWays(picture, ground, goal);
  Drawing& drawing = picture.drawing();
  drawGoal(drawing, picture.pixelOf(goal.goal));
  if (goal.stop != goal.goal) drawStop(drawing, picture.pixelOf(goal.stop));

  picture.explainColours("seconds to the goal, 1 m/s", 0, most, 2 * niceBelow(most / 8), timeColour);
  picture.explain(fmt::format("every {:g} s, {:g} s", step, 5 * step), [&](const glm::vec2& at) {
    picture.swatch(at, timeColour(0.5f));
    drawing.line(at - glm::vec2(10, 0), at + glm::vec2(10, 0), 1.8f, paperColour, 0.8f);
  });
  picture.explain("flow", [&](const glm::vec2& at) {
    picture.swatch(at, timeColour(0.7f));
    picture.arrow(at - glm::vec2(7, 0), at + glm::vec2(7, 0), paperColour, 1.3f);
  });
  picture.explain("goal", [&](const glm::vec2& at) { drawGoal(drawing, at); });
  if (goal.stop != goal.goal) picture.explain("stop", [&](const glm::vec2& at) { drawStop(drawing, at); });
  if (!goal.starts.empty()) {
    explainAgent(picture);
    explainWay(picture, "way of an agent");
  }
  picture.explainGround();
  picture.explain("no way to the goal", [&](const glm::vec2& at) { picture.swatch(at, glm::vec3(0.72f)); });
  return drawing;
}

// A tenth of the most is seen, too: colours go by the root of the share.
Drawing drawTrail(const MapGround& ground, const MapTrail& trail) {
  const double most = std::max(figuresOf(ground, trail).most, 1e-3);
  const auto colourOf = [](float share) { return trailColour(std::sqrt(share)); };
  MapPicture picture(ground);
  picture.fill([&](const glm::vec2& place) {
    const size_t cell = mapCellOf(ground.grid, place);
    return isPassable(ground.grid, cell) ? colourOf(static_cast<float>(double{trail.values[cell]} / most))
                                         : blockedColour;
  });
  picture.drawObstacles();
  picture.drawOnMap([&] {
    for (const Disc& food : trail.food) drawRing(picture, food, foodColour);
    for (const Disc& nest : trail.nests) drawRing(picture, nest, signalColour);
  });
  drawWay(picture, trail.path);
  drawAgents(picture, trail.agents);

  picture.explainColours(trail.what, 0, most, niceBelow(most / 4), colourOf);
  const auto explainRing = [&](const char* text, const glm::vec3& colour) {
    picture.explain(text, [&](const glm::vec2& at) { picture.drawing().ring(at, 8, 2.5f, colour); });
  };
  if (!trail.nests.empty()) explainRing("nest", signalColour);
  if (!trail.food.empty()) explainRing("food", foodColour);
  if (!trail.agents.empty()) explainAgent(picture);
  if (!trail.path.empty()) explainWay(picture, "best path of the scouts");
  picture.explainGround();
  return picture.drawing();
}

}  // namespace skitter::app
