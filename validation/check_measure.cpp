#include <algorithm>
#include <cstring>

#include "cpu_reference/heightfield.h"
#include "cpu_reference/stages/adapt.h"
#include "cpu_reference/stages/measure.h"
#include "cpu_reference/stages/tolerances.h"
#include "skitter/records.h"
#include "validation/checks.h"
#include "validation/convert.h"
#include "validation/fields.h"

namespace skitter::validation {
namespace {

namespace tolerance = reference::tolerance;
using reference::Metric;

// Sums are compared with the rounding that adding one tick's legs to them costs.
class MetricComparison {
 public:
  MetricComparison(Sample& sample, const Metric& expected, const Metric& got, double unit, double legs)
      : sample_(sample), expected_(expected), got_(got), unit_(unit), legs_(legs) {}

  void length(const char* quantity, double Metric::*member, double bound) {
    const double e = expected_.*member, g = got_.*member;
    sample_.compare(quantity, std::abs(e - g) / unit_, (bound + rounding(e)) / unit_, {e, 0, 0, 0},
                    {g, 0, 0, 0});
  }
  void number(const char* quantity, double Metric::*member, double bound) {
    const double e = expected_.*member, g = got_.*member;
    sample_.compare(quantity, std::abs(e - g), bound + rounding(e), {e, 0, 0, 0}, {g, 0, 0, 0});
  }
  bool agrees(double Metric::*member, double bound) const {
    const double e = expected_.*member, g = got_.*member;
    return std::abs(e - g) <= bound + rounding(e);
  }
  // A count; `close` of its decisions could have gone the other way.
  void count(const char* quantity, double Metric::*member, double close = 0) {
    const double e = expected_.*member, g = got_.*member;
    if (e != g && close > 0) ties_ = true;
    sample_.compare(quantity, std::max(0.0, std::abs(e - g) - close), 0, {e, 0, 0, 0}, {g, 0, 0, 0});
  }
  bool ties() const { return ties_; }

 private:
  double rounding(double sum) const { return (legs_ + 2) * tolerance::roundoff * std::abs(sum); }

  Sample& sample_;
  const Metric &expected_, &got_;
  double unit_, legs_;
  bool ties_ = false;
};

struct TrailBounds {
  double at, first, second, third;
};

// `apart` is how far the points may be from their body along x or z.
TrailBounds compareTrail(const reference::Trail& expected, const reference::Trail& got, double at,
                         double apart, double unit, Sample& sample) {
  // x_n - x_(n-1) of tile-local coordinates: both are records or have just been compared.
  const double step = at + tolerance::relativeOver(apart);
  const TrailBounds bound{at, step, step + 2 * tolerance::roundoff * glm::length(expected.second),
                          step + 8 * tolerance::roundoff * glm::length(expected.second)};
  compareFields(expected, got, sample);
  const auto vector = [&](const char* quantity, const glm::dvec3& e, const glm::dvec3& g, double by) {
    sample.compare(quantity, glm::length(e - g) / unit, by / unit, {e, 0}, {g, 0});
  };
  vector("position / leg length", expected.at, got.at, bound.at);
  vector("first difference / leg length", expected.first, got.first, bound.first);
  vector("second difference / leg length", expected.second, got.second, bound.second);
  sample.compare("path / leg length", std::abs(expected.path - got.path) / unit,
                 (bound.first + 8 * tolerance::roundoff * expected.path) / unit, {expected.path, 0, 0, 0},
                 {got.path, 0, 0, 0});
  // Bounds the tick's |e3|, whose square is at most all of Q.
  const double third = std::sqrt(expected.jerk);
  sample.compare("sum of squared third differences", std::abs(expected.jerk - got.jerk),
                 (2 * third + bound.third) * bound.third + 8 * tolerance::roundoff * expected.jerk,
                 {expected.jerk, 0, 0, 0}, {got.jerk, 0, 0, 0});
  return bound;
}

// The bound of W^5 Q and P^2, from the errors of Q and P in the tick that closes the window.
double jerkBound(const reference::Trail& trail, const TrailBounds& bound, double ticks) {
  const double sum = (2 * std::sqrt(trail.jerk) + bound.third) * bound.third;
  return std::pow(ticks, 5) * (sum + 16 * tolerance::roundoff * trail.jerk);
}
double pathBound(const reference::Trail& trail, const TrailBounds& bound) {
  return (2 * trail.path + bound.first) * bound.first + 20 * tolerance::roundoff * trail.path * trail.path;
}

// A window that closes with a path as long as the least that counts, to within rounding: all of its sums are
// added or nothing.
struct CloseWindow {
  double jerk, squaredPath;
  bool counted;  // by the reference
};

CloseWindow closeWindow(const reference::Trail& trail, double beyond, double ticks) {
  return {std::pow(ticks, 5) * trail.jerk, trail.path * trail.path, beyond > 0};
}

struct BoundedSum {
  double Metric::*member;
  double bound;
};

// Counts the windows in `want` as the device did, if there is a way to. Whether it is another way.
bool decideWindows(const MetricComparison& metric, Metric& want, const BoundedSum& jerk,
                   const BoundedSum& path, const std::vector<CloseWindow>& windows) {
  const Metric exact = want;
  // If there are more windows, only the first ten are decided.
  const size_t ways = size_t{1} << std::min<size_t>(windows.size(), 10);
  for (size_t way = 0; way < ways; ++way) {
    want = exact;
    for (size_t w = 0; w < windows.size(); ++w) {
      if ((way >> w & 1) == 0) continue;
      const double sign = windows[w].counted ? -1 : 1;
      want.*jerk.member += sign * windows[w].jerk;
      want.*path.member += sign * windows[w].squaredPath;
    }
    if (metric.agrees(jerk.member, jerk.bound) && metric.agrees(path.member, path.bound)) return way != 0;
  }
  want = exact;
  return false;
}

void compareUnwatched(const Moment& moment, Judge& judge) {
  Sample sample;
  const auto before = records(moment.before.metric, moment.agent, shared::METRIC_STRIDE);
  const auto after = records(moment.after.metric, moment.agent, shared::METRIC_STRIDE);
  sample.same("metric of an agent that is not watched", 0,
              std::memcmp(before.data(), after.data(), before.size_bytes()) == 0 ? 0 : 1);
  judge.add(moment.n, moment.number(), -1, sample);
}

// How far the sums of one tick may be off, and which decisions are close.
struct Bounds {
  double footJerk = 0, footPath = 0, bodyJerk = 0, bodyPath = 0;
  double lengths = 0, vertical = 0, deepest = 0;
  double skates = 0, violations = 0, crossings = 0;
  std::vector<CloseWindow> closeBody, closeFeet;
};

// An agent's legs after the tick.
struct Legs {
  reference::AgentBody body;
  std::vector<reference::Foot> feet;
  std::vector<reference::Chain> chains;
};
Legs legsOf(const Setting& setting, const Moment& moment) {
  Legs legs{bodyOf(moment.after, moment.agent), {}, {}};
  const size_t count = static_cast<size_t>(setting.legs);
  for (size_t l = 0; l < count; ++l) {
    legs.feet.push_back(footOf(moment.after, moment.agent * count + l));
    legs.chains.push_back(chainOf(moment.after, moment.agent * count + l, setting.bones));
  }
  return legs;
}

// Adds what one leg adds to the bounds; compares its trail.
void addLeg(const Setting& setting, const Legs& legs, const reference::Measured& expected,
            const reference::Watched& got, size_t l, Bounds& bounds, Sample& sample) {
  const double unit = setting.tuning.legLength, ticks = setting.tuning.jerkTicks;
  const reference::AgentBody& body = legs.body;
  const reference::Limb& limb = setting.creature.limbs[l];
  const reference::Chain& chain = legs.chains[l];
  const reference::TipTrail& trail = expected.watched.tips[l];
  const reference::LegDecisions& leg = expected.legs[l];
  // Adding a tip to its body rounds once, in x and z below 32 m or a tile and the reach, in y with the
  // height.
  const double aside = tolerance::relativeOver(limb.reach);
  const double height = 6 * tolerance::roundoff * (std::abs(body.y) + limb.reach);
  const TrailBounds bound = compareTrail(trail, got.tips[l], aside + height, limb.reach, unit, sample);
  sample.compare("slip of the stance / leg length", std::abs(trail.slip - got.tips[l].slip) / unit,
                 (2 * aside + 4 * tolerance::roundoff * std::abs(trail.slip)) / unit, {trail.slip, 0, 0, 0},
                 {got.tips[l].slip, 0, 0, 0});

  if (limb.lost) return;
  const glm::dvec2 world = body.world();
  const auto relief = reference::reliefNear(setting.heights, world.x + chain.tip.x, world.y + chain.tip.z);
  bounds.vertical += tolerance::height(relief, setting.extent, 2 * tolerance::roundoff * limb.reach) + height;

  const double length = limb.reach + glm::length(limb.root);
  const double joint = tolerance::bonePosition(setting.bones) * length;
  double steepest = 0;
  for (const glm::dvec3& p : reference::jointsOf(limb, chain.directions)) {
    const glm::dvec3 q = body.orientation * p;
    const auto below = reference::reliefNear(setting.heights, world.x + q.x, world.y + q.z);
    steepest =
        std::max(steepest, tolerance::height(below, setting.extent, joint + tolerance::rotated(length)));
  }
  const double depth = steepest + joint + tolerance::rotated(length) + height;
  bounds.lengths += depth;
  bounds.deepest = std::max(bounds.deepest, depth);

  if (leg.stays && std::abs(leg.slide) <= 2 * bound.first) ++bounds.skates;
  if (std::abs(leg.violation) <= tolerance::violation) ++bounds.violations;
  if (leg.paired && std::abs(leg.crossing) <= 4 * joint + 4 * tolerance::roundoff * length)
    ++bounds.crossings;
  if (!leg.closes || leg.path < -2 * bound.first) return;
  if (leg.path <= 2 * bound.first) bounds.closeFeet.push_back(closeWindow(trail, leg.path, ticks));
  bounds.footJerk += jerkBound(trail, bound, ticks);
  bounds.footPath += pathBound(trail, bound);
}

// Compares trails; what follows for the sums.
Bounds compareTrails(const Setting& setting, const Legs& legs, const reference::Measured& expected,
                     const reference::Watched& got, Sample& sample) {
  Bounds bounds;
  const double ticks = setting.tuning.jerkTicks;
  const reference::Trail& body = expected.watched.body;
  const TrailBounds bound = compareTrail(body, got.body, 0, 0, setting.tuning.legLength, sample);
  if (expected.closes) {
    bounds.bodyJerk = jerkBound(body, bound, ticks);
    bounds.bodyPath = pathBound(body, bound);
    if (std::abs(expected.bodyPath) <= 2 * bound.first)
      bounds.closeBody.push_back(closeWindow(body, expected.bodyPath, ticks));
  }
  for (size_t l = 0; l < legs.feet.size(); ++l) addLeg(setting, legs, expected, got, l, bounds, sample);
  return bounds;
}

// Whether something was decided the other way.
bool compareSums(const Setting& setting, const Legs& legs, const reference::Measured& expected,
                 const Metric& got, const Bounds& bounds, Sample& sample) {
  const double unit = setting.tuning.legLength;
  compareFields(expected.metric, got, sample);
  Metric want = expected.metric;
  MetricComparison metric(sample, want, got, unit, static_cast<double>(legs.feet.size()));
  metric.count("ticks", &Metric::ticks);
  metric.count("planted leg-ticks", &Metric::planted);
  metric.count("leg-ticks planted twice", &Metric::stays);
  metric.count("skating leg-ticks", &Metric::skates, bounds.skates);
  metric.count("finished stances", &Metric::stances);
  metric.length("slip over finished stances / leg length", &Metric::slip, 0);
  metric.length("largest reach error / leg length", &Metric::largestError, 0);
  metric.number("largest limit violation, rad", &Metric::largestViolation, tolerance::violation);
  metric.count("leg-ticks beyond a limit", &Metric::violations, bounds.violations);
  metric.length("penetration / leg length", &Metric::penetration, bounds.vertical);
  metric.length("penetration beyond the dead zone / leg length", &Metric::penetrationBeyond, bounds.vertical);
  metric.length("float / leg length", &Metric::floating, bounds.vertical);
  metric.length("float beyond the dead zone / leg length", &Metric::floatingBeyond, bounds.vertical);
  metric.length("segment penetration / leg length", &Metric::depth, bounds.lengths);
  metric.length("largest segment penetration / leg length", &Metric::deepest, bounds.deepest);
  metric.count("leg-ticks of lost legs", &Metric::lost);
  metric.count("pair-ticks", &Metric::pairs);
  metric.count("crossings", &Metric::crossings, bounds.crossings);

  const double farthest = 2 * unit + glm::length(setting.creature.centre);  // a tip, from the centre of mass
  const double margin = tolerance::supportMargin(reference::plantedTips(0, legs.feet, legs.chains), farthest);
  metric.count("ticks with a support", &Metric::supported);
  metric.count("unstable ticks", &Metric::unstable,
               expected.supported && std::abs(expected.margin) <= margin ? 1 : 0);
  metric.length("stability margin / leg length", &Metric::margin, margin);
  metric.length("least stability margin / leg length", &Metric::leastMargin, margin);

  const bool footTie = decideWindows(metric, want, {&Metric::footJerk, bounds.footJerk},
                                     {&Metric::footPath, bounds.footPath}, bounds.closeFeet);
  const bool bodyTie = decideWindows(metric, want, {&Metric::bodyJerk, bounds.bodyJerk},
                                     {&Metric::bodyPath, bounds.bodyPath}, bounds.closeBody);
  metric.number("jerk of the feet", &Metric::footJerk, bounds.footJerk);
  metric.number("squared path of the feet", &Metric::footPath, bounds.footPath);
  metric.number("jerk of the body", &Metric::bodyJerk, bounds.bodyJerk);
  metric.number("squared path of the body", &Metric::bodyPath, bounds.bodyPath);
  return metric.ties() || footTie || bodyTie;
}

}  // namespace

void checkMeasure(const Setting& setting, const Moment& moment, Judge& judge) {
  const uint64_t every = moment.after.watchEvery;
  const reference::WatchTurn turn = reference::watchTurn(moment.n, every);
  const uint64_t number = moment.after.watchOffset + moment.number();
  if (number % every != turn.turn) return compareUnwatched(moment, judge);

  const Legs legs = legsOf(setting, moment);
  const size_t slot = number / every;
  const reference::Measured expected = reference::measure(
      setting.tuning, setting.heights, setting.creature, legs.body, legs.feet, legs.chains, turn.watched,
      watchedOf(moment.before, slot, setting.legs), metricOf(moment.before, moment.agent));

  Sample sample;
  sample.finite("metric", records(moment.after.metric, moment.agent, shared::METRIC_STRIDE));
  sample.finite("watch", records(moment.after.watch, slot, shared::watchStride(setting.legs)));
  const reference::Watched watched = watchedOf(moment.after, slot, setting.legs);
  const Bounds bounds = compareTrails(setting, legs, expected, watched, sample);
  const bool tie = compareSums(setting, legs, expected, metricOf(moment.after, moment.agent), bounds, sample);
  judge.add(moment.n, moment.number(), -1, sample, tie);
}

}  // namespace skitter::validation
