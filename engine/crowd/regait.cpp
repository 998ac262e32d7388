#include "crowd/regait.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <ranges>
#include <utility>

#include "crowd/leg_order.h"

namespace skitter::crowd {
namespace {

// Leg lengths: how far the centre must be inside the support polygon to count as supported.
constexpr double wantedMargin = 0.03;
// Leg lengths, or a share of time: candidates that are nearer to each other than this are equally good, so
// that rounding does not choose between the patterns of a symmetric rig.
constexpr double sameWithin = 1e-6;
// Shares of the way from the mean of all homes to that of the legs that carry.
constexpr double shares[] = {0, 0.25, 0.5, 0.75, 1};
// Below so many legs that carry a creature lies down.
constexpr size_t fewestThatWalk = 3;
// Most of the body's height by which it is lowered.
constexpr float lowestShare = 0.3f;

using Points = std::vector<glm::dvec2>;

double crossOf(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

// Counter-clockwise, without points within its edges (Andrew 1979).
Points hullOf(Points points) {
  std::ranges::sort(points, [](const glm::dvec2& a, const glm::dvec2& b) {
    return a.x < b.x || (a.x == b.x && a.y < b.y);
  });
  Points hull;
  const auto goAlong = [&](auto&& range) {
    const size_t begin = hull.size();
    for (const glm::dvec2& point : range) {
      while (hull.size() > begin + 1 &&
             crossOf(hull.back() - hull[hull.size() - 2], point - hull[hull.size() - 2]) <= 0)
        hull.pop_back();
      hull.push_back(point);
    }
    hull.pop_back();
  };
  if (points.size() < 3) return points;
  goAlong(points);
  goAlong(points | std::views::reverse);
  return hull;
}

double distanceToSegment(const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b) {
  const glm::dvec2 way = b - a;
  const double square = glm::dot(way, way);
  const double t = square > 0 ? std::clamp(glm::dot(p - a, way) / square, 0.0, 1.0) : 0;
  return glm::length(p - a - t * way);
}

// How far the centre is inside the polygon of the points; below 0 outside of it.
double marginOf(const Points& points, const glm::dvec2& centre) {
  const Points hull = hullOf(points);
  if (hull.empty()) return -std::numeric_limits<double>::infinity();
  if (hull.size() < 3) return -distanceToSegment(centre, hull.front(), hull.back());
  double margin = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < hull.size(); ++i) {
    const glm::dvec2 edge = hull[(i + 1) % hull.size()] - hull[i];
    margin = std::min(margin, crossOf(edge, centre - hull[i]) / glm::length(edge));
  }
  return margin;
}

// A walk at one leg length per second: seconds per step, and per cycle of so many groups.
struct Walk {
  double step, cycle;
};
Walk walkOf(const Tuning& tuning, int groups, double slowest) {
  const double step = double{tuning.swingStill} / (1 + 1 / double{tuning.swingSpeed});
  const double duty = std::max(double{tuning.dutyLeast}, double{tuning.dutyStill} - double{tuning.dutyGain});
  const double cycle = std::min(double{tuning.cycleMax}, step / (1 - duty));
  return {slowest * step, std::max(cycle, groups * slowest * step * double{tuning.windowSlack})};
}

// Legs by their place in a list, and the group of each.
struct Grouping {
  int groups = 0;
  std::vector<int> ofLeg;
};

// One leg after the other around the body, from the `first` one on and in either direction, takes the next
// group. None where two neighbours would have one.
std::optional<Grouping> groupingOf(size_t legs, int groups, size_t first, bool backward) {
  Grouping made{groups, std::vector<int>(legs)};
  const auto g = static_cast<size_t>(groups);
  const bool meets = legs % g == 1;  // the last leg would be of the first one's group
  if (meets && groups == 2) return {};
  const auto place = [&](size_t k) {
    const size_t forward = (first + k) % legs;
    return backward ? legs - 1 - forward : forward;
  };
  for (size_t k = 0; k < legs; ++k) made.ofLeg[place(k)] = static_cast<int>(k % g);
  if (meets) made.ofLeg[place(legs - 1)] = 1;
  return made;
}

// How stable a grouping is with the body's centre in a place.
struct Stability {
  double unstable;  // share of the time
  double margin;    // the least, in leg lengths
};

// `homes` are those of the legs that carry, in leg lengths. While a group is in the air each of the others
// goes back from half a stride in front of its homes, since when it landed: its legs are looked at when the
// step begins, in its middle and when it ends.
Stability stabilityOf(const Points& homes, const Grouping& grouping, const Walk& walk,
                      const glm::dvec2& centre) {
  Stability found{0, std::numeric_limits<double>::infinity()};
  for (int air = 0; air < grouping.groups; ++air) {
    double margin = std::numeric_limits<double>::infinity();
    for (const double part : {0.0, 0.5, 1.0}) {
      Points feet;
      for (size_t leg = 0; leg < homes.size(); ++leg) {
        const int before = (air - grouping.ofLeg[leg] + grouping.groups) % grouping.groups;
        if (before == 0) continue;
        const double stood = before * walk.cycle / grouping.groups + (part - 1) * walk.step;
        feet.push_back(homes[leg] + glm::dvec2(0, (walk.cycle - walk.step) / 2 - stood));
      }
      margin = std::min(margin, marginOf(feet, centre));
    }
    if (margin < wantedMargin) found.unstable += walk.step / walk.cycle;
    found.margin = std::min(found.margin, margin);
  }
  return found;
}

struct Choice {
  Grouping grouping;
  glm::dvec2 centre{0};  // leg lengths
  Stability stability{std::numeric_limits<double>::infinity(), 0};

  bool isWorseThan(const Choice& other) const {
    const double gain = stability.unstable - other.stability.unstable;
    if (std::abs(gain) > sameWithin) return gain > 0;
    return other.grouping.groups == grouping.groups && other.stability.margin > stability.margin + sameWithin;
  }
};

// The best of all: the least unstable time, then the fewest groups, then the largest margin.
Choice chosen(const Points& homes, const glm::dvec2& offset, const Tuning& tuning, double slowest) {
  Choice best;
  for (int groups = 2; groups <= static_cast<int>(homes.size()); ++groups) {
    const Walk walk = walkOf(tuning, groups, slowest);
    for (size_t way = 0; way < 2 * static_cast<size_t>(groups); ++way) {
      const std::optional<Grouping> grouping = groupingOf(homes.size(), groups, way / 2, way % 2 == 1);
      if (!grouping) continue;
      for (const double share : shares) {
        const glm::dvec2 centre = share * offset;
        Choice choice{*grouping, centre, stabilityOf(homes, *grouping, walk, centre)};
        if (best.isWorseThan(choice)) best = std::move(choice);
      }
    }
    if (best.stability.unstable == 0) break;
  }
  return best;
}

glm::vec2 homeOf(const Leg& leg) { return {leg.home.x, leg.home.z}; }

glm::vec2 meanHome(const Rig& rig, const std::vector<size_t>& legs) {
  glm::vec2 sum(0);
  for (const size_t l : legs) sum += homeOf(rig.legs[l]);
  return sum / static_cast<float>(legs.size());
}

// How much lower the body must be for every leg to reach its home as well as before, or comfortably.
float loweringFor(const Rig& rig, const Tuning& tuning, const std::vector<size_t>& carriers,
                  const glm::vec2& centre) {
  float lowering = 0;
  for (const size_t l : carriers) {
    const Leg& leg = rig.legs[l];
    const float reach = std::max(tuning.reachComfort * leg.reach, glm::distance(leg.home, leg.root()));
    const glm::vec2 aside = homeOf(leg) - centre - glm::vec2(leg.root().x, leg.root().z);
    const float above = leg.root().y - leg.home.y;
    const float most = std::sqrt(std::max(0.0f, reach * reach - glm::dot(aside, aside)));
    lowering = std::max(lowering, above - most);
  }
  return std::min(lowering, lowestShare * rig.bodyHeight);
}

// Every leg that carries must stand while one of another group is in the air: all feet but those of a group
// are on the ground, which is what its stability was found for.
void setNeighbours(const std::vector<size_t>& carriers, Regait& gait) {
  for (const size_t a : carriers)
    for (const size_t b : carriers)
      if (gait.legs[a].group != gait.legs[b].group) gait.legs[a].neighbours |= 1u << b;
}

void regroup(const Rig& rig, const Tuning& tuning, const std::vector<size_t>& carriers, double slowest,
             Regait& gait) {
  std::vector<size_t> all(rig.legs.size());
  for (size_t l = 0; l < all.size(); ++l) all[l] = l;
  Points homes;
  for (const size_t l : carriers) homes.push_back(glm::dvec2(homeOf(rig.legs[l])) / double{rig.legLength});
  const glm::dvec2 offset = glm::dvec2(meanHome(rig, carriers) - meanHome(rig, all)) / double{rig.legLength};
  const Choice choice = chosen(homes, offset, tuning, slowest);
  gait.groups = choice.grouping.groups;
  for (size_t k = 0; k < carriers.size(); ++k) gait.legs[carriers[k]].group = choice.grouping.ofLeg[k];
  const glm::vec2 centre = glm::vec2(choice.centre) * rig.legLength;
  gait.shift = {-centre.x, loweringFor(rig, tuning, carriers, centre), -centre.y};
}

// On its belly, without a step that it need not make.
void lieDown(const Rig& rig, const std::vector<size_t>& carriers, Regait& gait) {
  gait.groups = std::max(1, static_cast<int>(carriers.size()));
  for (size_t k = 0; k < carriers.size(); ++k) gait.legs[carriers[k]].group = static_cast<int>(k);
  gait.shift = {0, rig.bodyHeight, 0};
  gait.speed = 0;
}

void takeOwnGait(const Rig& rig, Regait& gait) {
  const std::vector<LegOrder> order = legOrder(rig);
  gait.groups = rig.groupCount();
  for (size_t l = 0; l < rig.legs.size(); ++l)
    gait.legs[l] = {rig.legs[l].group, order[l].lag, order[l].neighbours, gait.legs[l].slowness};
}

}  // namespace

Regait regaitByRule(const Rig& rig, const Tuning& tuning, const LegPattern& pattern) {
  const auto isIn = [](uint32_t mask, size_t leg) { return (mask >> leg & 1u) != 0; };
  std::vector<size_t> carriers;
  for (const size_t l : legsAround(rig))
    if (!isIn(pattern.idle, l)) carriers.push_back(l);
  Regait gait;
  gait.legs.resize(rig.legs.size());
  size_t lame = 0;
  for (const size_t l : carriers)
    if (isIn(pattern.lame, l)) gait.legs[l].slowness = lameSlowness, ++lame;
  if (lame > 0) gait.speed = 1 - static_cast<float>(lame) / (2 * static_cast<float>(carriers.size()));
  if (carriers.size() == rig.legs.size()) {
    takeOwnGait(rig, gait);
    return gait;
  }
  if (carriers.size() < fewestThatWalk)
    lieDown(rig, carriers, gait);
  else
    regroup(rig, tuning, carriers, lame > 0 ? double{lameSlowness} : 1.0, gait);
  setNeighbours(carriers, gait);
  return gait;
}

}  // namespace skitter::crowd
