#include "cpu_reference/stages/body.h"

#include <vector>

#include "cpu_reference/stages/react.h"
#include "cpu_reference/stages/tolerances.h"
#include "skitter/records.h"
#include "validation/checks.h"
#include "validation/convert.h"
#include "validation/fields.h"

namespace skitter::validation {
namespace {

namespace tolerance = reference::tolerance;

// Where there are levels of rate, the device makes the blend of 1, 2, 4 or 8 ticks. What a tick keeps is
// rounded once, which its power has `span` times; that is a product of log2(span) roundings, and 1 less it is
// another.
double blendError(const Moment& moment) {
  return moment.after.rate.empty() ? 0 : 2 * static_cast<double>(moment.span) * tolerance::roundoff;
}

// Cosine to straight backward below which either way round is right.
constexpr double eitherWay = 16 * tolerance::roundoff;
// Share of the speed above which a body goes where it is led, by which both may be off: two squares, a sum, a
// root, and a product with a number that is rounded itself. An agent that is shut in by others is led at just
// this speed. On steep ground the velocity errs, too.
double goesOrNot(const Setting& setting, double wished) {
  return 8 * tolerance::roundoff + wished / (1e-4 * setting.tuning.legLength);
}

// What rounding may decide otherwise.
std::vector<reference::BodyChoices> tiesOf(const Setting& setting, const tolerance::BodyInputs& inputs,
                                           const reference::BodyResult& result) {
  std::vector<reference::BodyChoices> ties;
  const double wished =
      tolerance::body(setting.tuning, setting.heights, setting.extent, setting.creature, inputs, result)
          .wished;
  const bool mayGo = result.goMargin < goesOrNot(setting, wished);
  const bool mayTurn = result.turnMargin < eitherWay + wished / std::max(result.wantedSpeed, 1e-20);
  for (const int goes : mayGo ? std::vector{0, 1} : std::vector{-1})
    for (const int sign : mayTurn ? std::vector{-1, 1} : std::vector{0})
      ties.push_back({.follow = {}, .turnSign = sign, .goes = goes});
  return ties;
}

// Components of q and -q are the same rotation; the sign rule makes them the same numbers too, but for a dot
// product near 0 it may fall either way.
double difference(const glm::dquat& a, const glm::dquat& b) {
  const glm::dvec4 u{a.x, a.y, a.z, a.w}, v{b.x, b.y, b.z, b.w};
  return std::min(glm::length(u - v), glm::length(u + v));
}

Sample compare(const Setting& setting, const Moment& moment, const reference::AgentBody& previous,
               const tolerance::BodyInputs& inputs, const reference::BodyResult& result) {
  const reference::AgentBody got = bodyOf(moment.after, moment.agent);
  const reference::AgentBody& expected = result.body;
  const auto bound =
      tolerance::body(setting.tuning, setting.heights, setting.extent, setting.creature, inputs, result);
  const double unit = setting.tuning.legLength;
  Sample sample;
  sample.finite("body", records(moment.after.body, moment.agent, shared::BODY_STRIDE));
  compareFields(expected, got, sample);
  const auto scalar = [&](const char* quantity, double want, double found, double bounded) {
    sample.compare(quantity, std::abs(want - found), bounded, {want, 0, 0, 0}, {found, 0, 0, 0});
  };
  scalar("follow factor", expected.follow, got.follow, bound.follow);
  scalar("turn rate, rad/s", expected.turnRate, got.turnRate, bound.turnRate);
  sample.compare("heading", glm::length(expected.heading - got.heading), bound.heading,
                 {expected.heading, 0, 0}, {got.heading, 0, 0});
  scalar("speed, m/s", expected.speed, got.speed, bound.speed);
  // Just below a tile's edge one side may have crossed it: the place is what must agree.
  const glm::dvec2 apart{(expected.tileX - got.tileX) * reference::tileSize + expected.localX - got.localX,
                         (expected.tileZ - got.tileZ) * reference::tileSize + expected.localZ - got.localZ};
  sample.compare("position / leg length", glm::length(apart) / unit, bound.position / unit,
                 {expected.tileX, expected.localX, expected.tileZ, expected.localZ},
                 {got.tileX, got.localX, got.tileZ, got.localZ});
  const auto outside = [](double local) { return std::max({0.0, -local, local - reference::tileSize}); };
  scalar("local x outside its tile", 0, outside(got.localX), 0);
  scalar("local z outside its tile", 0, outside(got.localZ), 0);
  sample.same("tile is a whole number", std::round(got.tileZ), got.tileZ);
  const glm::dquat &q = expected.orientation, &r = got.orientation;
  sample.compare("orientation", difference(q, r), bound.orientation, {q.x, q.y, q.z, q.w},
                 {r.x, r.y, r.z, r.w});
  sample.compare("orientation's sign", std::max(0.0, -glm::dot(r, previous.orientation)), bound.orientation,
                 {q.x, q.y, q.z, q.w}, {r.x, r.y, r.z, r.w});
  sample.compare("height / leg length", std::abs(expected.y - got.y) / unit, bound.height / unit,
                 {expected.y, 0, 0, 0}, {got.y, 0, 0, 0});
  scalar("surface speed, m/s", expected.surfaceSpeed, got.surfaceSpeed, bound.surfaceSpeed);
  double still = std::abs(expected.still - got.still);
  // Speeds are judged against a hundredth of a leg length a second.
  if (result.stillMargin < 1e-4 + (bound.wished + bound.speed) / (1e-2 * unit)) {
    still = std::min({still, std::abs(got.still), std::abs(got.still - previous.still - setting.tuning.dt)});
  }
  sample.compare("still time, s", still, 4 * tolerance::roundoff * (1 + previous.still),
                 {expected.still, 0, 0, 0}, {got.still, 0, 0, 0});
  return sample;
}

// A body that goes as its reaction says: numbers of that record, in sums, and a rotation that they make.
Sample compareLoose(const Setting& setting, const Moment& moment, const reference::AgentBody& previous) {
  const reference::Reaction& reaction = *setting.creature.reaction;
  const reference::AgentBody expected = reference::looseBody(setting.tuning, previous, reaction);
  const reference::AgentBody got = bodyOf(moment.after, moment.agent);
  const double dt = setting.tuning.dt, unit = setting.tuning.legLength;
  Sample sample;
  sample.finite("body", records(moment.after.body, moment.agent, shared::BODY_STRIDE));
  const glm::dvec2 apart{(expected.tileX - got.tileX) * reference::tileSize + expected.localX - got.localX,
                         (expected.tileZ - got.tileZ) * reference::tileSize + expected.localZ - got.localZ};
  sample.compare(
      "position / leg length", glm::length(apart) / unit,
      (3 * tolerance::local + 2 * tolerance::roundoff * dt * glm::length(reaction.velocity)) / unit,
      {expected.tileX, expected.localX, expected.tileZ, expected.localZ},
      {got.tileX, got.localX, got.tileZ, got.localZ});
  sample.compare("height / leg length", std::abs(expected.y - got.y) / unit,
                 4 * tolerance::roundoff * (std::abs(previous.y) + std::abs(reaction.sink) * dt) / unit,
                 {expected.y, 0, 0, 0}, {got.y, 0, 0, 0});
  // As in tolerance::react, of an exact axis and tilt.
  const glm::dquat &q = expected.orientation, &r = got.orientation;
  sample.compare("orientation", difference(q, r),
                 (48 + 32 / std::max(reaction.ground.y, 1e-3)) * tolerance::roundoff, {q.x, q.y, q.z, q.w},
                 {r.x, r.y, r.z, r.w});
  sample.compare("orientation's sign", std::max(0.0, -glm::dot(r, previous.orientation)),
                 64 * tolerance::roundoff, {q.x, q.y, q.z, q.w}, {r.x, r.y, r.z, r.w});
  sample.same("heading x", previous.heading.x, got.heading.x);
  sample.same("heading z", previous.heading.y, got.heading.y);
  sample.same("speed", 0, got.speed);
  sample.same("turn rate", 0, got.turnRate);
  sample.same("still time", 0, got.still);
  sample.same("surface speed", 0, got.surfaceSpeed);
  sample.compare("follow factor", std::abs(setting.tuning.followLeast - got.follow), tolerance::roundoff,
                 {setting.tuning.followLeast, 0, 0, 0}, {got.follow, 0, 0, 0});
  return sample;
}

}  // namespace

void checkBody(const Setting& setting, const Moment& moment, Judge& judge) {
  const reference::AgentBody previous = bodyOf(moment.before, moment.agent);
  if (setting.creature.reaction && setting.creature.reaction->isLoose()) {
    judge.add(moment.n, moment.number(), -1, compareLoose(setting, moment, previous));
    return;
  }
  const reference::Wish wish{velocityOf(moment.after, moment.agent), mostSpeedOf(moment.after, moment.agent)};
  std::vector<reference::Step> steps;
  const size_t legs = static_cast<size_t>(setting.legs);
  std::vector<double> misses;
  for (size_t l = 0; l < legs; ++l) {
    steps.push_back(moment.stepOf(moment.before, moment.agent * legs + l));
    misses.push_back(missOf(moment.before, moment.agent, l, setting.legs, moment.n - moment.span));
  }
  const double phase = gaitOf(moment.before, moment.agent).phase;
  const auto run = [&](const reference::BodyChoices& choices) {
    return reference::body(setting.tuning, setting.heights, setting.creature, previous, wish, steps, misses,
                           moment.now(), phase, choices);
  };
  auto inputs = tolerance::feltGround(setting.tuning, setting.creature, previous);
  inputs.blend = blendError(moment);
  const reference::BodyResult result = run({});
  const Sample sample = compare(setting, moment, previous, inputs, result);
  if (sample.passes()) return judge.add(moment.n, moment.number(), -1, sample);

  // A leg square to the way counts or not; a desired velocity straight backward is turned to either way
  // round; one that is hardly any is followed or not.
  double without = 1, with = 1;
  const double square = 4 * tolerance::footDistance(2 * setting.tuning.legLength) / setting.tuning.legLength;
  for (const reference::LegFollow& leg : result.follow) {
    with = std::min(with, leg.errorFactor);
    without = std::min(without, leg.errorFactor);
    if (!leg.planted) continue;
    if (leg.behind > -square) with = std::min(with, leg.factor);
    if (leg.behind > square) without = std::min(without, leg.factor);
  }
  for (const double follow : {with, without}) {
    for (reference::BodyChoices choices : tiesOf(setting, inputs, result)) {
      if (with != without) choices.follow = follow;
      const Sample other = compare(setting, moment, previous, inputs, run(choices));
      if (other.passes()) return judge.add(moment.n, moment.number(), -1, other, true);
    }
  }
  judge.add(moment.n, moment.number(), -1, sample);
}

void checkBlindBody(const Setting& setting, const Moment& moment, Judge& judge) {
  const reference::AgentBody previous = bodyOf(moment.before, moment.agent);
  const reference::Wish wish{velocityOf(moment.after, moment.agent), mostSpeedOf(moment.after, moment.agent)};
  auto inputs = tolerance::blindGround(setting.heights, setting.extent, setting.creature, previous);
  inputs.blend = blendError(moment);
  const auto run = [&](const reference::BodyChoices& choices) {
    return reference::blindBody(setting.tuning, setting.heights, setting.creature, previous, wish, choices);
  };
  const reference::BodyResult result = run({});
  const Sample sample = compare(setting, moment, previous, inputs, result);
  if (sample.passes()) return judge.add(moment.n, moment.number(), -1, sample);
  for (const reference::BodyChoices& choices : tiesOf(setting, inputs, result)) {
    const Sample other = compare(setting, moment, previous, inputs, run(choices));
    if (other.passes()) return judge.add(moment.n, moment.number(), -1, other, true);
  }
  judge.add(moment.n, moment.number(), -1, sample);
}

}  // namespace skitter::validation
