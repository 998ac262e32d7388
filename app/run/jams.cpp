#include "app/run/jams.h"

#include <algorithm>
#include <cmath>
#include <deque>

namespace skitter::app {
namespace {

constexpr double movedShare = 0.1;    // of a body, in ten seconds: less is standing
constexpr double jammedShare = 0.5;   // of the speed that is wanted: less is a jam
constexpr double leastTime = 10;      // seconds in which a square counts
constexpr double aheadCosine = 0.5;   // within 60 degrees of where an agent wants to go
constexpr double leastWanted = 1e-3;  // m/s

using Cell = std::pair<int64_t, int64_t>;

Cell cellAt(const glm::dvec2& place, double side) {
  return {static_cast<int64_t>(std::floor(place.x / side)), static_cast<int64_t>(std::floor(place.y / side))};
}

// Places by the cell that they are in.
class Near {
 public:
  Near(std::span<const glm::dvec2> places, double reach) : places_(places), reach_(std::max(reach, 1e-3)) {
    for (size_t i = 0; i < places.size(); ++i)
      if (std::isfinite(places[i].x)) cells_[cellAt(places[i], reach_)].push_back(i);
  }

  // Calls each(j) with those within reach of one, itself among them.
  template <class Each>
  void eachNear(const glm::dvec2& place, const Each& each) const {
    const auto [x, z] = cellAt(place, reach_);
    for (int64_t j = z - 1; j <= z + 1; ++j)
      for (int64_t i = x - 1; i <= x + 1; ++i)
        if (const auto found = cells_.find({i, j}); found != cells_.end())
          for (const size_t k : found->second)
            if (glm::distance(places_[k], place) <= reach_) each(k);
  }

 private:
  std::span<const glm::dvec2> places_;
  double reach_;
  std::map<Cell, std::vector<size_t>> cells_;
};

double side(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& p) {
  return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

bool linesCross(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c, const glm::dvec2& d) {
  return side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0;
}

bool linesCross(const std::vector<glm::dvec2>& a, const std::vector<glm::dvec2>& b) {
  for (size_t i = 1; i < a.size(); ++i)
    for (size_t j = 1; j < b.size(); ++j)
      if (linesCross(a[i - 1], a[i], b[j - 1], b[j])) return true;
  return false;
}

// For each agent, those whom it stands directly ahead of: less than a body length between footprints.
std::vector<std::vector<size_t>> behindOf(std::span<const Advance> agents) {
  std::vector<glm::dvec2> places;
  double widest = 0;
  for (const Advance& agent : agents) {
    places.push_back(agent.isThere ? agent.now : glm::dvec2(NAN));
    widest = std::max(widest, agent.radius);
  }
  const Near near(places, 4 * widest);
  std::vector<std::vector<size_t>> behind(agents.size());
  for (size_t i = 0; i < agents.size(); ++i) {
    const Advance& agent = agents[i];
    if (!agent.isThere || glm::length(agent.wanted) < leastWanted) continue;
    const glm::dvec2 toward = glm::normalize(agent.wanted);
    near.eachNear(agent.now, [&](size_t j) {
      const glm::dvec2 way = agents[j].now - agent.now;
      const double distance = glm::length(way);
      if (j == i || distance > 3 * agent.radius + agents[j].radius) return;
      if (glm::dot(way, toward) >= aheadCosine * distance) behind[j].push_back(i);
    });
  }
  return behind;
}

}  // namespace

double movedFrom(std::span<const glm::dvec2> places, const glm::dvec2& now) {
  double moved = 0;
  for (const glm::dvec2& place : places) moved = std::max(moved, glm::distance(place, now));
  return moved;
}

std::vector<Standing> standingsOf(std::span<const Advance> agents) {
  std::vector<Standing> standings(agents.size(), Standing::stuck);
  std::deque<size_t> moving, arrived;
  for (size_t i = 0; i < agents.size(); ++i) {
    const Advance& agent = agents[i];
    const bool wants = glm::length(agent.wanted) >= leastWanted;
    if (agent.isThere && !wants && agent.hasPoint) {
      standings[i] = Standing::arrived;
      arrived.push_back(i);
    } else if (!agent.isThere || !wants || agent.moved >= movedShare * 2 * agent.radius) {
      standings[i] = Standing::moves;
      if (agent.isThere && wants) moving.push_back(i);
    }
  }
  const std::vector<std::vector<size_t>> behind = behindOf(agents);
  const auto follow = [&](std::deque<size_t>& from, Standing standing) {
    for (; !from.empty(); from.pop_front())
      for (const size_t i : behind[from.front()]) {
        if (standings[i] != Standing::stuck) continue;
        standings[i] = standing;
        from.push_back(i);
      }
  };
  follow(moving, Standing::waits);
  follow(arrived, Standing::arrived);
  return standings;
}

bool isInJam(double wanted, double speed) { return wanted >= leastWanted && speed < jammedShare * wanted; }

void FlowMap::add(const glm::dvec2& from, const glm::dvec2& to, double seconds) {
  const auto [found, isNew] = squares_.try_emplace(cellAt(0.5 * (from + to), side_));
  Square& square = found->second;
  if (isNew) {
    square.first = seconds;
    square.came.fill(seconds);
  }
  square.last = seconds;
  square.way += glm::distance(from, to);
  square.along += glm::abs(to - from);
  const Cell left = cellAt(from, side_), entered = cellAt(to, side_);
  if (left == entered) return;
  for (const size_t row : {0, 1})
    for (const int64_t step : {-1, 0, 1}) {
      Cell middle = entered;
      (row == 0 ? middle.first : middle.second) += step;
      const int64_t across = row == 0 ? left.first - middle.first : left.second - middle.second;
      const bool isSameRow = row == 0 ? left.second == middle.second : left.first == middle.first;
      const auto of = squares_.find(middle);
      if (of == squares_.end() || (isSameRow && std::abs(across) <= 1)) continue;
      double &came = of->second.came[row], &pause = of->second.pause[row];
      pause = std::max(pause, seconds - came);
      came = seconds;
    }
}

std::optional<Flow> FlowMap::most() const {
  std::optional<Flow> most;
  for (const auto& [cell, square] : squares_) {
    const double time = square.last - square.first;
    if (time < leastTime) continue;
    const size_t row = square.along.y >= square.along.x ? 0 : 1;
    const Flow flow{square.way / (side_ * side_ * time),
                    std::max(square.pause[row], square.last - square.came[row])};
    if (!most || flow.flow > most->flow) most = flow;
  }
  return most;
}

bool legsCross(const LegLines& a, const LegLines& b) {
  return std::ranges::any_of(a, [&](const auto& leg) {
    return std::ranges::any_of(b, [&](const auto& other) { return linesCross(leg, other); });
  });
}

std::vector<bool> crossingAgents(std::span<const LegLines> agents, std::span<const glm::dvec2> places,
                                 double reach) {
  const Near near(places, 2 * reach);
  std::vector<bool> crosses(agents.size());
  for (size_t i = 0; i < agents.size(); ++i) {
    if (!std::isfinite(places[i].x)) continue;
    near.eachNear(places[i], [&](size_t j) {
      if (j <= i || (crosses[i] && crosses[j])) return;
      if (legsCross(agents[i], agents[j])) crosses[i] = crosses[j] = true;
    });
  }
  return crosses;
}

}  // namespace skitter::app
