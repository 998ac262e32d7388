#include "cpu_reference/stages/measure.h"

#include <algorithm>
#include <limits>

#include "cpu_reference/heightfield.h"
#include "cpu_reference/stages/pose.h"

namespace skitter::reference {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr uint64_t watchTicks = 128;

double areaOf(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// Twice the area over the lengths that an error of the points is multiplied by.
double sideOf(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  return areaOf(a, b, c) / std::max(glm::distance(a, b) + glm::distance(a, c), 1e-30);
}

double straddle(double one, double other) { return std::max(std::min(one, -other), std::min(-one, other)); }

double distanceToSegment(const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b) {
  const glm::dvec2 along = b - a;
  const double square = glm::dot(along, along);
  const double t = square > 0 ? glm::clamp(glm::dot(p - a, along) / square, 0.0, 1.0) : 0;
  return glm::distance(p, a + t * along);
}

double tileChange(double difference) { return tileSize * std::round(difference / tileSize); }

// Where a tick lies among the windows of a watch.
struct Place {
  Place(uint64_t ticks, const Tuning& tuning)
      : watched(ticks), window(static_cast<uint64_t>(tuning.jerkTicks)) {}
  bool known() const { return watched >= 3; }
  bool opens() const { return known() && (watched - 3) % window == 0; }
  bool closes() const { return known() && (watched - 3) % window == window - 1; }
  uint64_t watched, window;
};

void advance(Trail& trail, const glm::dvec3& here, const Place& place) {
  const Trail old = trail;
  trail.at = here;
  trail.first = trail.second = glm::dvec3(0);
  if (place.watched >= 1) {
    trail.first = here - old.at;
    trail.first.x -= tileChange(trail.first.x);
    trail.first.z -= tileChange(trail.first.z);
  }
  if (place.watched >= 2) trail.second = trail.first - old.first;
  if (!place.known() || place.opens()) trail.path = trail.jerk = 0;
  if (!place.known()) return;
  const glm::dvec3 third = trail.second - old.second;
  trail.path += glm::length(trail.first);
  trail.jerk += glm::dot(third, third);
}

double scaledJerk(const Trail& trail, double ticks) { return std::pow(ticks, 5) * trail.jerk; }

double violationOf(const Limb& limb, const std::vector<glm::dvec2>& directions) {
  double most = 0;
  for (size_t i = 0; i < limb.bones.size(); ++i) {
    const double angle = 2 * std::atan(glm::length(directions[i]));
    most = std::max(most, angle - 2 * std::atan(limb.bones[i].tanHalfCone));
  }
  return most;
}

double depthOf(const Heights& heights, const AgentBody& body, const std::vector<glm::dvec3>& joints) {
  double deepest = 0;
  const auto look = [&](const glm::dvec3& model) {
    const glm::dvec3 p = body.orientation * model;
    const glm::dvec2 world = body.world();
    deepest = std::max(deepest, heightAt(heights, world.x + p.x, world.y + p.z) - (body.y + p.y));
  };
  for (size_t i = 0; i + 1 < joints.size(); ++i) {
    look((joints[i] + joints[i + 1]) / 2.0);
    if (i > 0) look(joints[i]);
  }
  return deepest;
}

double crossingOf(const std::vector<glm::dvec3>& one, const std::vector<glm::dvec3>& other) {
  const auto seen = [](const glm::dvec3& p) { return glm::dvec2(p.x, p.z); };
  double most = -infinite;
  for (size_t i = 0; i + 1 < one.size(); ++i)
    for (size_t j = 0; j + 1 < other.size(); ++j)
      most = std::max(most, reachOver(seen(one[i]), seen(one[i + 1]), seen(other[j]), seen(other[j + 1])));
  return most;
}

// The stance of a tip whose trail is this tick's.
void addStance(const Tuning& tuning, const Place& place, bool planted, TipTrail& trail,
               LegDecisions& decisions, Metric& metric) {
  const double slide = std::hypot(trail.first.x, trail.first.z);
  const double slip = trail.slip;
  if (place.watched == 0) {
    trail.slip = planted ? TipTrail::unseen : TipTrail::air;
  } else if (!planted) {
    if (slip >= 0) {
      metric.slip += slip;
      metric.stances += 1;
    }
    trail.slip = TipTrail::air;
  } else if (slip == TipTrail::air) {
    trail.slip = 0;
  } else {
    decisions.stays = true;
    decisions.slide = slide - tuning.skateSpeed * tuning.dt;
    metric.stays += 1;
    if (decisions.slide > 0) metric.skates += 1;
    if (slip >= 0) trail.slip += slide;
  }
}

// A tip so high above the ground.
void addHeight(const Tuning& tuning, double above, bool planted, Metric& metric) {
  metric.penetration += std::max(0.0, -above);
  metric.penetrationBeyond += std::max(0.0, -above - tuning.deadZone);
  if (!planted) return;
  metric.floating += std::max(0.0, above);
  metric.floatingBeyond += std::max(0.0, above - tuning.deadZone);
}

// What closes a trail's window: its path beyond the least that counts.
double addWindow(const Tuning& tuning, const Trail& trail, double& jerk, double& path) {
  const double beyond = trail.path - tuning.jerkPath;
  if (beyond > 0) {
    jerk += scaledJerk(trail, tuning.jerkTicks);
    path += std::pow(trail.path, 2);
  }
  return beyond;
}

// The planted tips as seen from above, about the body.
void addSupport(const Tuning& tuning, const Creature& creature, const AgentBody& body,
                const std::vector<glm::dvec2>& support, Measured& result) {
  Metric& metric = result.metric;
  result.supported = !support.empty();
  if (!result.supported) {
    metric.unstable += 1;
    return;
  }
  const glm::dvec3 centre = body.orientation * (glm::dvec3(0, tuning.bodyHeight, 0) + creature.centre);
  result.margin = stabilityMargin(support, {centre.x, centre.z});
  metric.leastMargin = metric.supported > 0 ? std::min(metric.leastMargin, result.margin) : result.margin;
  metric.supported += 1;
  metric.margin += result.margin;
  if (result.margin < 0) metric.unstable += 1;
}

}  // namespace

WatchTurn watchTurn(uint64_t n, uint64_t every) {
  if (every == 1) return {0, n - 1};
  return {(n - 1) / watchTicks % every, (n - 1) % watchTicks};
}

double reachOver(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c, const glm::dvec2& d) {
  return std::min(straddle(sideOf(a, b, c), sideOf(a, b, d)), straddle(sideOf(c, d, a), sideOf(c, d, b)));
}

std::vector<glm::dvec3> jointsOf(const Limb& limb, const std::vector<glm::dvec2>& directions) {
  std::vector<glm::dvec3> joints;
  for (const BonePose& bone : pose(limb, AgentBody{}, directions)) joints.push_back(bone.position);
  const BoneRest& last = limb.bones.back();
  const glm::dquat rotation = pose(limb, AgentBody{}, directions).back().rotation;
  joints.push_back(joints.back() + last.length * limb.reach * (rotation * last.direction()));
  return joints;
}

size_t neighbourOf(const Creature& creature, size_t limb) {
  const size_t none = creature.limbs.size();
  const auto homeOf = [&](size_t l) { return creature.limbs[l].home - creature.shift; };
  const glm::dvec3 home = homeOf(limb);
  size_t found = none;
  for (size_t other = 0; other < none; ++other) {
    const glm::dvec3 at = homeOf(other);
    if ((at.x < 0) != (home.x < 0) || at.z >= home.z) continue;
    if (found == none || at.z > homeOf(found).z) found = other;
  }
  return found;
}

// The hull by Andrew's monotone chain (1979).
double stabilityMargin(std::vector<glm::dvec2> points, const glm::dvec2& centre) {
  std::sort(points.begin(), points.end(),
            [](const glm::dvec2& a, const glm::dvec2& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  std::vector<glm::dvec2> hull;
  for (int side = 0; side < 2; ++side) {
    const size_t start = hull.size();
    for (const glm::dvec2& p : points) {
      while (hull.size() >= start + 2 && areaOf(hull[hull.size() - 2], hull.back(), p) <= 0) hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();  // the other side begins with it
    std::reverse(points.begin(), points.end());
  }
  if (hull.empty()) hull.push_back(points.front());

  bool inside = hull.size() > 2;
  double nearest = infinite;
  for (size_t i = 0; i < hull.size(); ++i) {
    const glm::dvec2 &a = hull[i], &b = hull[(i + 1) % hull.size()];
    inside = inside && areaOf(a, b, centre) >= 0;
    nearest = std::min(nearest, distanceToSegment(centre, a, b));
  }
  return inside ? nearest : -nearest;
}

Measured measure(const Tuning& tuning, const Heights& heights, const Creature& creature,
                 const AgentBody& body, const std::vector<Foot>& feet, const std::vector<Chain>& chains,
                 uint64_t ticks, const Watched& before, const Metric& sums) {
  Measured result;
  result.metric = sums;
  result.watched = before;
  Metric& metric = result.metric;
  const Place place(ticks, tuning);
  const glm::dvec3 local(body.localX, body.y, body.localZ);
  const glm::dvec2 world = body.world();
  const size_t legs = creature.limbs.size();
  result.watched.tips.resize(legs);
  result.closes = place.closes();
  metric.ticks += 1;

  advance(result.watched.body, local, place);
  if (result.closes)
    result.bodyPath = addWindow(tuning, result.watched.body, metric.bodyJerk, metric.bodyPath);

  std::vector<std::vector<glm::dvec3>> joints;
  for (size_t l = 0; l < legs; ++l) joints.push_back(jointsOf(creature.limbs[l], chains[l].directions));
  std::vector<glm::dvec2> support;
  for (size_t l = 0; l < legs; ++l) {
    const bool planted = feet[l].progress >= 1;
    const glm::dvec3 tip = chains[l].tip;
    LegDecisions decisions;
    if (planted) {
      support.emplace_back(tip.x, tip.z);
      metric.planted += 1;
    }

    TipTrail& trail = result.watched.tips[l];
    advance(trail, tip + local, place);
    addStance(tuning, place, planted, trail, decisions, metric);
    decisions.closes = result.closes;
    if (creature.limbs[l].lost) {
      metric.lost += 1;
      decisions.closes = false;
      result.legs.push_back(decisions);
      continue;
    }
    if (result.closes) decisions.path = addWindow(tuning, trail, metric.footJerk, metric.footPath);

    const double above = body.y + tip.y - heightAt(heights, world.x + tip.x, world.y + tip.z);
    addHeight(tuning, above, planted, metric);
    const double depth = depthOf(heights, body, joints[l]);
    metric.depth += depth;
    metric.deepest = std::max(metric.deepest, depth);

    metric.largestError = std::max(metric.largestError, chains[l].reachError);
    const double violation = violationOf(creature.limbs[l], chains[l].directions);
    decisions.violation = violation - tuning.limitDeadZone;
    metric.largestViolation = std::max(metric.largestViolation, violation);
    if (decisions.violation > 0) metric.violations += 1;

    const size_t neighbour = neighbourOf(creature, l);
    decisions.paired = neighbour < legs && !creature.limbs[neighbour].lost;
    if (decisions.paired) {
      decisions.crossing = crossingOf(joints[l], joints[neighbour]);
      metric.pairs += 1;
      if (decisions.crossing > 0) metric.crossings += 1;
    }
    result.legs.push_back(decisions);
  }
  addSupport(tuning, creature, body, support, result);
  return result;
}

}  // namespace skitter::reference
