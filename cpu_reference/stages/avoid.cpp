#include "cpu_reference/stages/avoid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <tuple>

namespace skitter::reference {
namespace {

// docs/stages/avoid.md. Seconds, shares and leg lengths a second.
constexpr double horizon = 0.7, pushTime = 0.5;
constexpr double roomOfLegs = 1.55, roomGoing = 3.55;  // times the footprints
constexpr double turnSlope = 4;
constexpr double rightBias = 0.05;
constexpr double softness = 0.05;
constexpr int sweeps = 6;
constexpr double obstacleTime = 0.5, obstacleSoftness = 0.01;
constexpr double pushSpeed = 0.3, steadySpeed = 0.05;
constexpr double deepRoom = 0.01, looseBelow = 0.9;
constexpr double shareOfSecond = 0.4, creepRate = 0.3;
constexpr double easeTime = 0.4, slackSpeed = 1e-4, freeSpeed = 100;
constexpr int cellSweeps = 2;
constexpr double turnTime = 2;
constexpr double longestRound = 1.0 / 15;

// Rounding errors of the size that a float32 computation makes; none by default.
class Rounding {
 public:
  explicit Rounding(const AvoidErrors& errors)
      : most_(errors.number), random_(static_cast<std::minstd_rand::result_type>(errors.seed)) {}

  double operator()(double value, double size) {
    if (most_ == 0) return value;
    return value + size * most_ * std::uniform_real_distribution<double>(-1, 1)(random_);
  }
  glm::dvec2 operator()(const glm::dvec2& value, double size) {
    return {(*this)(value.x, size), (*this)(value.y, size)};
  }

 private:
  double most_;
  std::minstd_rand random_;  // begins at once, and there are many
};

// Another agent, relative to the one that looks.
struct Seen {
  const Walker* walker;
  int64_t x, z;       // quanta
  int64_t distance2;  // between the middles, squared
  int64_t radii;      // of both
};

std::vector<Seen> inReach(const AvoidTuning& tuning, const Walker& self, std::span<const Walker> all) {
  std::vector<Seen> seen;
  for (const Walker& other : all) {
    if (other.number == self.number) continue;
    const int64_t x = other.x - self.x, z = other.z - self.z, radii = self.radius + other.radius;
    const int64_t reach = radii + tuning.look;
    if (x * x + z * z <= reach * reach) seen.push_back({&other, x, z, x * x + z * z, radii});
  }
  std::ranges::sort(seen, [](const Seen& a, const Seen& b) {
    const int64_t powerA = a.distance2 - a.radii * a.radii, powerB = b.distance2 - b.radii * b.radii;
    return std::tie(powerA, a.walker->number) < std::tie(powerB, b.walker->number);
  });
  return seen;
}

// Turned by a right angle to its right: an agent that faces +z has +x to its left.
glm::dvec2 rightOf(const glm::dvec2& v) { return {-v.y, v.x}; }

// Two agents in one place part along a line that depends on their numbers only.
glm::dvec2 partingLine(int64_t a, int64_t b) {
  const auto low = static_cast<uint32_t>(std::min(a, b)), high = static_cast<uint32_t>(std::max(a, b));
  const uint32_t drawn = (low * 0x9E3779B1u) ^ (high * 0x85EBCA77u);
  const glm::dvec2 line{(drawn >> 28) - 7.5, (drawn >> 24 & 15) - 7.5};
  return glm::normalize(a < b ? line : -line);
}

// How many times the footprints are apart that agents try to keep.
double roomOf(double speed, double wanted) {
  return std::lerp(roomOfLegs, roomGoing, std::min(1.0, 2 * speed / std::max(wanted, 1e-6)));
}

HalfPlane planeOf(const AvoidTuning& tuning, const Walker& self, const Seen& seen, double room, int right,
                  Rounding& rounded) {
  const Walker& other = *seen.walker;
  HalfPlane plane{.neighbour = other.number, .sideMargin = std::numeric_limits<double>::infinity()};
  const glm::dvec2 p = glm::dvec2(seen.x, seen.z) / tuning.quanta;
  const double d = std::sqrt(static_cast<double>(seen.distance2)) / tuning.quanta;
  const double footprints = static_cast<double>(seen.radii) / tuning.quanta;
  // Nobody is kept from who is out of reach.
  const double reach = footprints + static_cast<double>(tuning.look) / tuning.quanta;
  const double radii = std::min(rounded(room, 4 * room) * footprints, reach);
  const double power = rounded(d * d - radii * radii, 4 * (d * d + radii * radii));
  const double size = glm::length(self.velocity) + glm::length(other.velocity) + (d + radii) / horizon;
  const glm::dvec2 v = rounded(self.velocity - other.velocity, 2 * size);
  glm::dvec2 change;
  if (power <= 0) {
    plane.n = seen.distance2 > 0 ? -p / d : partingLine(self.number, other.number);
    // Footprints part at once, what is between them slowly.
    const double push =
        std::max(0.0, footprints - d) / pushTime + (radii - std::max(footprints, d)) / horizon;
    change = (push - glm::dot(plane.n, v)) * plane.n;
  } else {
    const glm::dvec2 w = rounded(v - p / horizon, 2 * size);
    const double along = glm::dot(w, p), speed = glm::length(w);
    if (along < 0 && along * along > radii * radii * speed * speed) {
      plane.n = w / std::max(speed, 1e-9);
      change = (radii / horizon - speed) * plane.n;
    } else {
      const double leg = std::sqrt(power);
      const double across = p.x * w.y - p.y * w.x + rightBias * d * speed;
      plane.sideMargin = std::abs(across) / d;
      plane.right = right >= 0 ? right : (across >= 0 ? 1 : 0);
      const double side = plane.right == 1 ? 1 : -1;
      const glm::dvec2 edge =
          side * glm::dvec2(p.x * leg - side * p.y * radii, side * p.x * radii + p.y * leg) / (d * d);
      plane.n = {-edge.y, edge.x};
      change = glm::dot(v, edge) * edge - v;
    }
  }
  plane.n = rounded(plane.n, 8);
  const double share = other.yields ? 0.5 : 1;
  plane.bound = rounded(glm::dot(plane.n, self.velocity + share * change), 8 * size);
  return plane;
}

// An obstacle as an agent sees it.
struct Beside {
  size_t obstacle;
  glm::dvec2 away;  // unit, out of the obstacle the shortest way
  double distance;  // from it, less than 0 inside
  double length;    // of what these are computed from
};

// The nearest point of a side, and how far it is.
struct OnSide {
  glm::dvec2 delta, way;  // from the point to the place; along the side
  double distance;
};
OnSide nearestOnSide(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& place) {
  const glm::dvec2 way = b - a;
  const double squared = glm::dot(way, way);
  const double along = squared > 0 ? std::clamp(glm::dot(place - a, way) / squared, 0.0, 1.0) : 0;
  const glm::dvec2 delta = place - (a + along * way);
  return {delta, way, glm::length(delta)};
}

double crossOf(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

Beside besideOf(size_t number, const AvoidObstacle& obstacle, const glm::dvec2& place) {
  std::vector<glm::dvec2> corners = obstacle.corners;
  const size_t n = corners.size();
  const bool isPolygon = n > 2;
  if (isPolygon && crossOf(corners[1] - corners[0], corners[2] - corners[1]) < 0)
    std::ranges::reverse(corners);
  OnSide nearest{.delta = {}, .way = {}, .distance = std::numeric_limits<double>::infinity()};
  bool inside = isPolygon;
  double longest = 0;
  for (size_t i = 0; i < (isPolygon ? n : 1); ++i) {
    const glm::dvec2 a = corners[i], b = corners[(i + 1) % n];
    const OnSide side = nearestOnSide(a, b, place);
    if (side.distance < nearest.distance) nearest = side;
    inside = inside && crossOf(b - a, place - a) > 0;
    longest = std::max(longest, glm::length(place - a) + glm::length(b - a));
  }
  const double sign = inside ? -1 : 1;
  Beside beside{number, {1, 0}, sign * nearest.distance - obstacle.radius, longest};
  if (nearest.distance > 0)
    beside.away = sign * nearest.delta / nearest.distance;
  else if (glm::length(nearest.way) > 0)
    beside.away = glm::dvec2(nearest.way.y, -nearest.way.x) / glm::length(nearest.way);
  return beside;
}

// The obstacles that count, in their order. `margin` is AvoidResult::obstacleMargin.
std::vector<Beside> obstaclesBeside(const AvoidTuning& tuning, const Walker& self, bool other,
                                    double& margin) {
  const glm::dvec2 place = glm::dvec2(self.x, self.z) / tuning.quanta;
  const double reach = static_cast<double>(self.radius + tuning.look) / tuning.quanta;
  std::vector<Beside> all;
  for (size_t i = 0; i < tuning.obstacles.size(); ++i) {
    const Beside beside = besideOf(i, tuning.obstacles[i], place);
    if (beside.distance < reach) all.push_back(beside);
  }
  margin = std::numeric_limits<double>::infinity();
  if (all.size() <= mostObstacles) return all;
  std::ranges::stable_sort(all, {}, &Beside::distance);
  const Beside &last = all[mostObstacles - 1], &next = all[mostObstacles];
  margin = (next.distance - last.distance) / std::max(next.length + last.length, 1e-9);
  if (other) std::swap(all[mostObstacles], all[mostObstacles - 1]);
  all.resize(mostObstacles);
  std::ranges::sort(all, {}, &Beside::obstacle);
  return all;
}

ObstaclePlane planeOf(const AvoidTuning& tuning, const Walker& self, const Beside& beside,
                      Rounding& rounded) {
  const double radius = static_cast<double>(self.radius) / tuning.quanta;
  // The distance errs by roundings of what it is the difference of, and its direction by as much over it.
  const double distance = rounded(beside.distance, 4 * (beside.length + radius));
  const double from = std::abs(beside.distance + tuning.obstacles[beside.obstacle].radius);
  const glm::dvec2 n = rounded(beside.away, 4 + 4 * beside.length / std::max(from, 1e-9));
  return {beside.obstacle, n / std::max(glm::length(n), 1e-9), (radius - distance) / obstacleTime};
}

// One step of projected Gauss-Seidel on the multiplier of a soft half-plane.
template <class Plane>
void project(const Plane& plane, double soft, double& push, glm::dvec2& v, Rounding& rounded) {
  const double lacking = plane.bound - glm::dot(plane.n, v) - soft * push;
  const double pushed =
      std::max(0.0, rounded(push + lacking / (1 + soft), 4 * (std::abs(plane.bound) + glm::length(v))));
  v = rounded(v + (pushed - push) * plane.n, 2 * (glm::length(v) + pushed));
  push = pushed;
}

// Nearest to `wanted`: the nearest neighbour after the others, then obstacles.
glm::dvec2 solved(const std::vector<HalfPlane>& planes, const std::vector<ObstaclePlane>& obstacles,
                  const glm::dvec2& wanted, Rounding& rounded) {
  std::vector<double> pushes(planes.size(), 0.0), holds(obstacles.size(), 0.0);
  glm::dvec2 v = wanted;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (size_t k = planes.size(); k-- > 0;) project(planes[k], softness, pushes[k], v, rounded);
    for (size_t k = 0; k < obstacles.size(); ++k)
      project(obstacles[k], obstacleSoftness, holds[k], v, rounded);
  }
  return v;
}

// The side of an agent's cell that faces a neighbour: velocities of at most these numbers along n, m/s.
struct CellSide {
  glm::dvec2 n;
  double near, deep;
  double eased;  // as the deep one, for the body's speed
};

// Whether somebody of that number goes before another one, in that tick. The order is another one in each
// turn.
bool isBefore(int64_t number, int64_t other, int64_t tick, double dt) {
  const int64_t turn = tick / std::max<int64_t>(1, std::llround(turnTime / dt));
  const auto mixed = static_cast<uint32_t>(turn * int64_t{0x9E3779B1});
  return (static_cast<uint32_t>(number) ^ mixed) < (static_cast<uint32_t>(other) ^ mixed);
}

CellSide sideOf(const AvoidTuning& tuning, const AvoidTick& tick, const Walker& self, const Seen& seen,
                Rounding& rounded) {
  const Walker& other = *seen.walker;
  const glm::dvec2 p = glm::dvec2(seen.x, seen.z) / tuning.quanta;
  const double d = glm::length(p), radii = static_cast<double>(seen.radii) / tuning.quanta;
  const double smaller = static_cast<double>(std::min(self.radius, other.radius)) / tuning.quanta;
  const glm::dvec2 n = seen.distance2 > 0 ? rounded(p / d, 4) : glm::dvec2(0);
  const bool givesWay =
      !other.yields || isBefore(other.number, self.number, tick.number, tick.dt / tick.span);
  const double leaves = std::max(0.0, rounded(glm::dot(n, other.velocity), 4 * glm::length(other.velocity)));
  // The neighbour takes its part of the way between them, if it avoids. Agents that overlap much are free.
  const double size = 4 * (d + 2 * radii);
  const double half = other.yields ? 0.5 : 1;
  const double wishes = !other.yields ? 1 : givesWay ? shareOfSecond : 1 - shareOfSecond;
  const double loose = std::max(0.0, rounded(looseBelow * radii - d, size));
  const double betweenLegs = rounded(d - roomOfLegs * radii, size);
  const double near = wishes * std::max(0.0, betweenLegs) + loose;
  const double deep = half * std::max(0.0, rounded(d - radii - deepRoom * smaller, size)) + loose;
  const auto eased = [&](double way) { return std::min(way / tick.dt, way / easeTime + leaves); };
  const double back =
      givesWay ? std::min(std::max(0.0, -betweenLegs) / easeTime, pushSpeed * tuning.legLength) : 0;
  const double creep = creepRate * half * std::max(0.0, rounded(d - radii, size));
  const double slack = slackSpeed * tuning.legLength;
  return {n, eased(near) - back + creep, deep / tick.dt + slack, eased(deep) + slack};
}

// How fast the body may go on along its heading.
double speedAlong(const CellSide& side, const glm::dvec2& heading, Rounding& rounded) {
  const double speed = side.eased / std::max(rounded(glm::dot(side.n, heading), 4), 1e-6);
  return rounded(speed, 8 * speed);
}

// Moves a wish into the cell: onto one side after the other, obstacles after neighbours, then back toward
// rest.
glm::dvec2 withinCell(const AvoidTuning& tuning, const std::vector<CellSide>& sides,
                      const std::vector<ObstaclePlane>& obstacles, glm::dvec2 v, Rounding& rounded) {
  const double fastestOut = pushSpeed * tuning.legLength;
  for (int sweep = 0; sweep < cellSweeps; ++sweep) {
    for (auto side = sides.rbegin(); side != sides.rend(); ++side) {
      const double beyond = glm::dot(side->n, v) - side->near;
      if (beyond > 0) v = rounded(v - beyond * side->n, 4 * (glm::length(v) + std::abs(side->near)));
    }
    for (const ObstaclePlane& plane : obstacles) {
      const double least = std::min(plane.bound, fastestOut);
      const double lacking = least - glm::dot(plane.n, v);
      if (lacking > 0) v = rounded(v + lacking * plane.n, 4 * (glm::length(v) + std::abs(least)));
    }
  }
  double part = 1;
  for (const CellSide& side : sides)
    if (const double toward = glm::dot(side.n, v); toward > side.deep)
      part = std::min(part, rounded(side.deep / toward, 8));
  return part * v;
}

}  // namespace

int roundTicks(double dt) {
  // 1/60 may have been a float.
  for (const int ticks : {4, 2})
    if (ticks * dt <= longestRound + 5e-7) return ticks;
  return 1;
}

bool looksAround(int64_t numberInKind, uint64_t tick, int roundTicks) {
  constexpr int64_t block = 8;
  return (numberInKind / block + static_cast<int64_t>(tick)) % roundTicks == 0;
}

Walker walkerOf(const AgentBody& body, int64_t number, int64_t radius, bool yields, double quanta) {
  const auto inQuanta = [&](double tile, double local) {
    return static_cast<int64_t>(tile * tileSize * quanta) + static_cast<int64_t>(std::floor(local * quanta));
  };
  return {number, inQuanta(body.tileX, body.localX), inQuanta(body.tileZ, body.localZ),
          radius, body.speed * body.heading,         yields};
}

std::vector<Walker> neighboursOf(const AvoidTuning& tuning, const Walker& self, std::span<const Walker> all) {
  std::vector<Walker> neighbours;
  for (const Seen& seen : inReach(tuning, self, all))
    if (neighbours.size() < mostNeighbours) neighbours.push_back(*seen.walker);
  return neighbours;
}

AvoidResult avoid(const AvoidTuning& tuning, const AvoidTick& tick, const AgentBody& body, const Walker& self,
                  std::span<const Walker> all, const glm::dvec2& desired, bool asleep,
                  const AvoidChoices& choices, const AvoidErrors& errors) {
  AvoidResult result;
  result.standMargin = result.obstacleMargin = std::numeric_limits<double>::infinity();
  if (body.absent) {
    result.asleep = true;
    return result;
  }
  result.mostSpeed = freeSpeed * tuning.legLength;
  Rounding rounded(errors);
  std::vector<Seen> seen = inReach(tuning, self, all);
  result.seen = static_cast<int64_t>(seen.size());
  if (seen.size() > mostNeighbours) seen.resize(mostNeighbours);

  const double speed = glm::length(desired);
  const double room = roomOf(body.speed, speed);
  double close = 0, right = 0, left = 0;
  std::vector<CellSide> sides;
  for (const Seen& other : seen) {
    const double d = std::sqrt(static_cast<double>(other.distance2)) / tuning.quanta;
    const double radii = static_cast<double>(other.radii) / tuning.quanta;
    const double closeness = std::clamp(2 - d / (roomOfLegs * radii), 0.0, 1.0);
    const glm::dvec2 p = glm::dvec2(other.x, other.z) / tuning.quanta;
    close = std::max(close, closeness);
    // Away from the neighbour: to the right, or to the left of one that is on the right.
    const double product = std::max(d * speed, 1e-6), sine = crossOf(desired, p) / product;
    const double turn = closeness * std::max(0.0, glm::dot(desired, p) / product) *
                        std::clamp(1 - turnSlope * sine, -1.0, 1.0);
    (turn > 0 ? right : left) = std::max(turn > 0 ? right : left, std::abs(turn));
    const size_t place = result.planes.size();
    const int passes = place < choices.right.size() ? choices.right[place] : -1;
    result.planes.push_back(planeOf(tuning, self, other, room, passes, rounded));
    sides.push_back(sideOf(tuning, tick, self, other, rounded));
    result.mostSpeed = std::min(result.mostSpeed, speedAlong(sides.back(), body.heading, rounded));
  }

  for (const Beside& beside : obstaclesBeside(tuning, self, choices.otherObstacle, result.obstacleMargin))
    result.obstaclePlanes.push_back(planeOf(tuning, self, beside, rounded));

  // Each turn errs by its closeness, its cosine and four times its sine.
  const double aside =
      rounded((right - left) * std::max(0.0, 1 - body.speed / std::max(speed, 1e-6)), 2 * 24 + 8);
  const glm::dvec2 wanted =
      rounded((desired + aside * rightOf(desired)) / std::sqrt(1 + aside * aside), 8 * speed);
  glm::dvec2 v = solved(result.planes, result.obstaclePlanes, wanted, rounded);
  const double most = std::max(speed, pushSpeed * tuning.legLength);
  v *= std::min(1.0, most / std::max(glm::length(v), 1e-6));
  const double slow = steadySpeed * tuning.legLength * close, moves = glm::length(v);
  v = (v + slow * body.heading) * (moves / std::max(moves + slow, 1e-6));
  v = withinCell(tuning, sides, result.obstaclePlanes, v, rounded);
  result.velocity = v;

  const double standing = 1e-2 * tuning.legLength;
  if (asleep) {
    result.standMargin = std::abs(glm::length(v) - standing);
    result.asleep = choices.stands >= 0 ? choices.stands == 1 : glm::length(v) < standing;
  }
  return result;
}

}  // namespace skitter::reference
