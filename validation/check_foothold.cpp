#include <algorithm>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "cpu_reference/heightfield.h"
#include "cpu_reference/stages/avoid.h"
#include "cpu_reference/stages/foothold.h"
#include "cpu_reference/stages/hurt.h"
#include "cpu_reference/stages/tolerances.h"
#include "skitter/records.h"
#include "validation/checks.h"
#include "validation/convert.h"
#include "validation/fields.h"

namespace skitter::validation {
namespace {

namespace tolerance = reference::tolerance;

// Everything that the recomputation of one leg's step needs.
struct Case {
  const Setting& setting;
  const Moment& moment;
  const reference::Limb& limb;
  size_t leg;
  reference::AgentBody body;
  reference::Gait gait;
  reference::Step before, got;
  bool lifts;
  std::span<const reference::Passer> passers;
  std::optional<glm::dvec3> hanging;  // where its foot is, of a leg that lifts without having carried

  reference::FootholdResult run(const reference::FootholdChoices& choices) const {
    return reference::foothold(setting.tuning, setting.heights, limb, body, gait, before, lifts, moment.now(),
                               choices, hanging, passers);
  }
};

// How far a candidate's numbers may be off.
struct CandidateBounds {
  double horizontal, vertical, distance, facing, score;
};

CandidateBounds boundsOf(const Case& c, const reference::FootholdResult& result,
                         const reference::Candidate& candidate) {
  const reference::Tuning& t = c.setting.tuning;
  const glm::dvec2 position = c.body.world();
  const double x = position.x + candidate.point.x, z = position.y + candidate.point.z;
  CandidateBounds bound{};
  bound.horizontal = tolerance::foothold(t, result).candidate;
  const reference::Relief relief = reference::reliefNear(c.setting.heights, x, z);
  bound.vertical = tolerance::candidateHeight(relief, c.setting.extent, bound.horizontal, c.body.y);
  bound.distance = tolerance::candidateDistance(c.limb, bound.horizontal, bound.vertical);
  // Normals jump at the edges between cells: look to either side within the error of the position.
  const double shift = bound.horizontal + 6 * tolerance::roundoff * c.setting.extent;
  const glm::dvec3 up = c.body.orientation * glm::dvec3(0, 1, 0);
  for (const double sx : {-shift, shift}) {
    for (const double sz : {-shift, shift}) {
      const double facing = glm::dot(reference::normalAt(c.setting.heights, x + sx, z + sz), up);
      bound.facing = std::max(bound.facing, std::abs(facing - candidate.facing));
    }
  }
  bound.facing += 24 * tolerance::roundoff;
  const glm::dvec3 miss = candidate.point - c.body.orientation * result.target;
  bound.score = 2 * glm::length(miss) * (bound.horizontal + bound.vertical) / (t.legLength * t.legLength) +
                8 * tolerance::roundoff * candidate.score;
  const double beyond = bound.horizontal + candidate.beyondError;
  bound.score +=
      2 * reference::othersWeight * (candidate.beyond + beyond) * beyond / (t.legLength * t.legLength);
  if (!t.nearestOnly) {
    const double strain = std::max(0.0, candidate.distance / c.limb.reach - t.reachComfort);
    bound.score += t.slopeWeight * bound.facing +
                   2 * t.reachWeight * (strain + bound.distance) * bound.distance / c.limb.reach;
  }
  return bound;
}

// The candidates that may rightly win once every number is only known to within its bound.
std::vector<reference::FootholdChoices> alternatives(const Case& c, const reference::FootholdResult& result) {
  const auto& all = result.candidates;
  std::vector<bool> mayFit;
  std::vector<double> lowest;
  double surelyBest = std::numeric_limits<double>::infinity();
  double leastMisfit = std::numeric_limits<double>::infinity();
  std::vector<CandidateBounds> bounds;
  std::vector<double> spared;  // of a misfit, by a candidate that may face the body after all
  for (const reference::Candidate& candidate : all) {
    const CandidateBounds b = boundsOf(c, result, candidate);
    bounds.push_back(b);
    const double margin = std::min({candidate.leastMargin / b.distance, candidate.mostMargin / b.distance,
                                    candidate.facingMargin / b.facing});
    mayFit.push_back(margin >= -1);
    lowest.push_back(candidate.score - b.score);
    if (margin > 1) surelyBest = std::min(surelyBest, candidate.score + b.score);
    // What may face the body or not may have the misfit of either.
    const double faces = std::abs(candidate.facingMargin) < b.facing ? c.setting.tuning.legLength : 0;
    spared.push_back(candidate.facingMargin < 0 ? faces : 0);
    leastMisfit =
        std::min(leastMisfit, candidate.misfit + b.distance + (candidate.facingMargin < 0 ? 0 : faces));
  }
  std::vector<reference::FootholdChoices> choices;
  for (size_t i = 0; i < all.size(); ++i) {
    if (mayFit[i] && lowest[i] <= surelyBest) {
      choices.push_back({static_cast<int>(i), false, {}});
    }
    const bool noneSurelyFits = !std::isfinite(surelyBest);
    if (noneSurelyFits && all[i].misfit - spared[i] - bounds[i].distance <= leastMisfit) {
      choices.push_back({static_cast<int>(i), true, {}});
    }
  }
  return choices;
}

// How far a way's lift and cost may be off, where its ends are.
struct WayBounds {
  double lift, cost;
};

WayBounds wayBound(const Case& c, const reference::Way& way, double horizontal, double vertical) {
  const glm::dvec2 position = c.body.world();
  double gap = 0;
  for (const glm::dvec2& place : way.places) {
    const reference::Relief relief =
        reference::reliefNear(c.setting.heights, position.x + place.x, position.y + place.y);
    gap = std::max(gap, tolerance::height(relief, c.setting.extent, horizontal) + vertical);
  }
  const reference::Tuning& t = c.setting.tuning;
  const double least = 24 * tolerance::roundoff * (1 + t.stepHeightMax);
  WayBounds bound{};
  // The height errs by what the ground does over the least share of the lift; the lane's direction, a
  // normalised product, by the error of the ends over their distance.
  const double apart = glm::length(glm::dvec2(way.places[6] - way.places[0]));
  const double turned = 2 * horizontal / std::max(apart, 1e-6) + 16 * tolerance::roundoff;
  bound.lift = gap * way.heightError + std::abs(way.side) * t.routeWidth * std::min(2.0, turned) + least;
  const double capped = std::min(way.height, t.stepHeightMax), over = way.height - capped;
  bound.cost = 2 * (glm::length(way.lift) + 100 * over) * bound.lift + 101 * bound.lift * bound.lift +
               16 * tolerance::roundoff * way.cost;
  return bound;
}

struct StepBounds {
  double landing, landingHeight, liftOff, liftOffHeight, lift, tangent;
};

StepBounds stepBounds(const Case& c, const reference::FootholdResult& result) {
  const auto& candidate = result.candidates[static_cast<size_t>(result.chosen)];
  const CandidateBounds b = boundsOf(c, result, candidate);
  const double world = tolerance::stepHeight(c.before, c.body);
  StepBounds bound{};
  bound.landing = b.horizontal + 2 * tolerance::local;
  bound.landingHeight = b.vertical + 2 * tolerance::roundoff * world;
  // A hanging foot is where forward kinematics has it.
  const double hangs =
      c.hanging ? tolerance::bonePosition(c.setting.bones) * (c.limb.reach + glm::length(c.limb.root)) : 0;
  bound.liftOff = c.lifts ? tolerance::relativeOver(tolerance::stepAside(c.before, c.body)) + hangs
                          : tolerance::footAside(c.before, c.body, false);
  bound.liftOffHeight = (c.lifts ? 6 : 20) * tolerance::roundoff * world + hangs;
  // A present tangent shifts the way by at most 4/27 of its error.
  const double tangent = c.lifts ? 0 : 6 * tolerance::local + 24 * tolerance::roundoff * world;
  const double horizontal = std::max(bound.landing, bound.liftOff) + tangent / 6;
  const double vertical = std::max(bound.landingHeight, bound.liftOffHeight) + tangent / 6;
  bound.lift = wayBound(c, result.route.way(), horizontal, vertical).lift;
  // dP/ds has coefficients up to 6 in the control points, and time's rate is at most 3/2.
  bound.tangent = c.lifts ? bound.lift : 2 * tangent;
  return bound;
}

Sample compare(const Case& c, const reference::FootholdResult& result) {
  const reference::Step &expected = result.step, &got = c.got;
  const StepBounds bound = stepBounds(c, result);
  const double unit = c.setting.tuning.legLength;
  Sample sample;
  sample.finite("step", records(c.moment.after.step, c.leg, shared::STEP_STRIDE));
  sample.finite("arc", records(c.moment.after.arc, c.leg, shared::ARC_STRIDE));
  sample.same("tile x", expected.tileX, got.tileX);
  sample.same("tile z", expected.tileZ, got.tileZ);
  compareFields(expected, got, sample);
  sample.same("duration, ticks", expected.duration, got.duration);
  const auto point = [&](const char* across, const char* height, const glm::dvec3& e, const glm::dvec3& g,
                         double horizontal, double vertical) {
    const glm::dvec3 apart = g - e;
    sample.compare(across, std::hypot(apart.x, apart.z) / unit, horizontal / unit, {e, 0}, {g, 0});
    sample.compare(height, std::abs(apart.y) / unit, vertical / unit, {e, 0}, {g, 0});
  };
  point("landing, horizontally / leg length", "landing's height / leg length", expected.landing, got.landing,
        bound.landing, bound.landingHeight);
  point("lift-off, horizontally / leg length", "lift-off's height / leg length", expected.liftOff,
        got.liftOff, bound.liftOff, bound.liftOffHeight);
  sample.compare("lift vector / leg length", glm::length(expected.lift - got.lift) / unit, bound.lift / unit,
                 {expected.lift, 0}, {got.lift, 0});
  sample.compare("start tangent / leg length", glm::length(expected.startTangent - got.startTangent) / unit,
                 bound.tangent / unit, {expected.startTangent, 0}, {got.startTangent, 0});
  return sample;
}

// Where the costs of ways are the same within their bounds, any way may be taken.
bool passesAnyWay(const Case& c, const reference::FootholdChoices& choices, Sample& passed) {
  const reference::FootholdResult result = c.run(choices);
  passed = compare(c, result);
  if (passed.passes()) return true;
  const StepBounds bound = stepBounds(c, result);
  const double horizontal = std::max(bound.landing, bound.liftOff);
  const double vertical = std::max(bound.landingHeight, bound.liftOffHeight);
  const auto boundOf = [&](const reference::Way& way) { return wayBound(c, way, horizontal, vertical).cost; };
  const reference::Way& best = result.route.way();
  for (size_t w = 0; w < result.route.ways.size(); ++w) {
    const reference::Way& way = result.route.ways[w];
    if (way.cost - best.cost > boundOf(way) + boundOf(best)) continue;
    reference::FootholdChoices other = choices;
    other.way = static_cast<int>(w);
    passed = compare(c, c.run(other));
    if (passed.passes()) return true;
  }
  return false;
}

void checkLeg(const Case& c, size_t l, Judge& judge) {
  const reference::FootholdResult result = c.run({});
  const Sample sample = compare(c, result);
  const int leg = static_cast<int>(l);
  if (sample.passes()) return judge.add(c.moment.n, c.moment.number(), leg, sample);
  Sample other;
  if (passesAnyWay(c, {}, other)) return judge.add(c.moment.n, c.moment.number(), leg, other, true);
  for (const reference::FootholdChoices& choices : alternatives(c, result)) {
    if (passesAnyWay(c, choices, other)) return judge.add(c.moment.n, c.moment.number(), leg, other, true);
  }
  judge.add(c.moment.n, c.moment.number(), leg, sample);
}

// Whom the agent's feet keep clear of, where its herd avoids.
std::vector<reference::Passer> passersOf(const Setting& setting, const Moment& moment) {
  const bool avoids = setting.avoid.look > 0;
  if (!avoids) return {};
  const reference::Walker& self = selfAround(setting, moment);
  const double quanta = setting.avoid.quanta;
  std::vector<reference::Passer> passers;
  for (const reference::Walker& other : reference::neighboursOf(setting.avoid, self, moment.around))
    passers.push_back({.place = glm::dvec2(other.x - self.x, other.z - self.z) / quanta,
                       .velocity = other.velocity,
                       .ownVelocity = self.velocity,
                       .radius = static_cast<double>(other.radius) / quanta,
                       .ownRadius = static_cast<double>(self.radius) / quanta});
  return passers;
}

}  // namespace

void checkFoothold(const Setting& setting, const Moment& moment, Judge& judge) {
  const reference::Gait gait = gaitOf(moment.after, moment.agent);
  const reference::AgentBody body = bodyOf(moment.after, moment.agent);
  const std::vector<reference::Passer> passers = passersOf(setting, moment);
  const size_t legs = static_cast<size_t>(setting.legs);
  for (size_t l = 0; l < legs; ++l) {
    const size_t leg = moment.agent * legs + l;
    const bool lifts = (gait.lift >> l & 1u) != 0, reaims = (gait.reaim >> l & 1u) != 0;
    if (lifts || reaims) {
      const reference::Limb& limb = setting.creature.limbs[l];
      Case c{setting,
             moment,
             limb,
             leg,
             body,
             gait,
             moment.stepOf(moment.before, leg),
             moment.stepOf(moment.after, leg),
             lifts,
             passers,
             {}};
      if (lifts && reaims)
        c.hanging = reference::heldLeg(limb, body, chainOf(moment.before, leg, setting.bones)).tip;
      checkLeg(c, l, judge);
      continue;
    }
    Sample sample;
    const auto stays = [&](const char* what, const auto& before, const auto& after) {
      if (std::equal(before.begin(), before.end(), after.begin())) return;
      for (size_t i = 0; i < before.size(); ++i) sample.same(what, before[i], after[i]);
    };
    stays("step of a leg that neither lifts nor is aimed anew",
          records(moment.before.step, leg, shared::STEP_STRIDE),
          records(moment.after.step, leg, shared::STEP_STRIDE));
    stays("arc of a leg that neither lifts nor is aimed anew",
          records(moment.before.arc, leg, shared::ARC_STRIDE),
          records(moment.after.arc, leg, shared::ARC_STRIDE));
    if (sample.passes())
      judge.keep();
    else
      judge.add(moment.n, moment.number(), static_cast<int>(l), sample);
  }
}

}  // namespace skitter::validation
