#include "bench/cpu_crowd/avoid/orca_check.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bench/cpu_crowd/avoid/orca.h"
#include "skitter/records.h"

namespace skitter::cpu_avoid {
namespace {

double lengthOf(const Velocity& v) { return std::hypot(v.x, v.z); }

// A line n . v = at.
struct Line {
  Velocity n;
  double at;
};

// Where two lines meet; calls `visit` unless they are parallel.
template <class Visit>
void meet(const Line& a, const Line& b, const Visit& visit) {
  const double det = a.n.x * b.n.z - a.n.z * b.n.x;
  if (det == 0) return;
  visit(Velocity{(a.at * b.n.z - b.at * a.n.z) / det, (a.n.x * b.at - b.n.x * a.at) / det});
}
// Where a line meets the disc's edge, and where it is nearest to `near`.
template <class Visit>
void meetDisc(const Line& line, double speed, const Visit& visit) {
  const double size2 = dot(line.n, line.n);
  if (size2 == 0) return;
  const double squared = speed * speed - line.at * line.at / size2;
  if (squared < 0) return;
  const Velocity foot{line.n.x * line.at / size2, line.n.z * line.at / size2};
  const double half = std::sqrt(squared / size2);
  for (const double side : {-half, 0.0, half})
    visit(Velocity{foot.x - side * line.n.z, foot.z + side * line.n.x});
}

Line bisectorOf(const Allowed& a, const Allowed& b) {
  return {{a.n.x - b.n.x, a.n.z - b.n.z}, a.bound - b.bound};
}

// The agent's place in quanta.
struct Spot {
  double x, z;
};
Spot spotOf(const Walkers& walkers, size_t i) {
  const double quanta = walkers.quanta, tile = shared::TILE_SIZE * quanta;
  return {walkers.tileX[i] * tile + std::floor(walkers.localX[i] * quanta),
          walkers.tileZ[i] * tile + std::floor(walkers.localZ[i] * quanta)};
}
Velocity velocityOf(const Walkers& walkers, size_t i) {
  // As they are moved: in float.
  return {walkers.speed[i] * walkers.headingX[i], walkers.speed[i] * walkers.headingZ[i]};
}

}  // namespace

std::vector<Allowed> orcaPlanesOf(const Walkers& walkers, size_t agent) {
  struct Near {
    double distance2;
    size_t number;
    Velocity p;
  };
  const Spot self = spotOf(walkers, agent);
  const double widest = *std::ranges::max_element(walkers.radius);
  const double reach = walkers.radius[agent] + widest + walkers.look;
  std::vector<Near> near;
  for (size_t i = 0; i < walkers.size(); ++i) {
    if (i == agent) continue;
    const Spot other = spotOf(walkers, i);
    const double x = other.x - self.x, z = other.z - self.z;
    if (x * x + z * z <= reach * reach)
      near.push_back({x * x + z * z, i, {x / walkers.quanta, z / walkers.quanta}});
  }
  std::ranges::sort(near, [](const Near& a, const Near& b) {
    return a.distance2 < b.distance2 || (a.distance2 == b.distance2 && a.number < b.number);
  });
  near.resize(std::min(near.size(), orcaNeighbours));
  std::vector<Allowed> planes;
  const Velocity own = velocityOf(walkers, agent);
  for (const Near& other : near) {
    const Velocity v = velocityOf(walkers, other.number);
    const double radii = (double{1} * walkers.radius[agent] + walkers.radius[other.number]) / walkers.quanta;
    planes.push_back(orcaOf(other.p, {own.x - v.x, own.z - v.z}, own, radii, walkers.share[other.number]));
  }
  return planes;
}

double orcaSpeedOf(const Walkers& walkers, size_t agent) {
  return std::max(std::hypot(double{walkers.wantedX[agent]}, double{walkers.wantedZ[agent]}),
                  orcaPushSpeed * walkers.legLength);
}

double violationOf(std::span<const Allowed> planes, const Velocity& v) {
  double worst = 0;
  for (const Allowed& plane : planes) worst = std::max(worst, plane.violation(v));
  return worst;
}

// The largest violation is convex and piecewise linear. Its least is where three half-planes are violated
// alike, or two and the disc's edge or the place of their bisector that is nearest to 0, or at the edge
// along one normal.
double leastViolation(std::span<const Allowed> planes, double speed) {
  double least = violationOf(planes, {});
  const auto look = [&](const Velocity& v) {
    if (lengthOf(v) <= speed * (1 + 1e-12)) least = std::min(least, violationOf(planes, v));
  };
  for (size_t i = 0; i < planes.size(); ++i) {
    look({planes[i].n.x * speed, planes[i].n.z * speed});
    for (size_t j = 0; j < i; ++j) {
      const Line first = bisectorOf(planes[i], planes[j]);
      meetDisc(first, speed, look);
      for (size_t k = 0; k < j; ++k) meet(first, bisectorOf(planes[i], planes[k]), look);
    }
    // None may be violated at all.
    const Line edge{planes[i].n, planes[i].bound};
    meetDisc(edge, speed, look);
    for (size_t j = 0; j < i; ++j) meet(edge, {planes[j].n, planes[j].bound}, look);
  }
  return least;
}

double leastDistance(std::span<const Allowed> planes, double speed, const Velocity& wanted) {
  double least = std::numeric_limits<double>::infinity();
  const auto look = [&](const Velocity& v) {
    if (lengthOf(v) <= speed * (1 + 1e-12) && violationOf(planes, v) <= 1e-12)
      least = std::min(least, lengthOf({v.x - wanted.x, v.z - wanted.z}));
  };
  const double scale = std::min(1.0, speed / std::max(lengthOf(wanted), 1e-300));
  look({wanted.x * scale, wanted.z * scale});
  for (size_t i = 0; i < planes.size(); ++i) {
    const Line edge{planes[i].n, planes[i].bound};
    const double back = planes[i].violation(wanted);
    look({wanted.x + back * edge.n.x, wanted.z + back * edge.n.z});
    meetDisc(edge, speed, look);
    for (size_t j = 0; j < i; ++j) meet(edge, {planes[j].n, planes[j].bound}, look);
  }
  return least;
}

double orcaFault(const Walkers& walkers, size_t agent, const Velocity& v) {
  const std::vector<Allowed> planes = orcaPlanesOf(walkers, agent);
  const double speed = orcaSpeedOf(walkers, agent);
  return std::max(violationOf(planes, v) - leastViolation(planes, speed), lengthOf(v) - speed);
}

}  // namespace skitter::cpu_avoid
