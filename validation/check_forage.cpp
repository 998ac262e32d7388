#include <algorithm>

#include "cpu_reference/stages/navigate.h"
#include "cpu_reference/stages/tolerances.h"
#include "cpu_reference/ways/forage.h"
#include "skitter/records.h"
#include "validation/checks.h"
#include "validation/convert.h"
#include "validation/convert_forage.h"
#include "validation/fields.h"

namespace skitter::validation {
namespace {

void compareForager(const reference::Forager& expected, const reference::Forager& got, Sample& sample) {
  const auto same = [&](const char* what, int64_t want, int64_t found) {
    sample.same(what, static_cast<double>(want), static_cast<double>(found));
  };
  same("cell that it goes to", expected.cell, got.cell);
  same("heading x", expected.headingX, got.headingX);
  same("heading z", expected.headingZ, got.headingZ);
  same("state of foraging", static_cast<int64_t>(expected.state), static_cast<int64_t>(got.state));
  same("cells since nest or food", expected.steps, got.steps);
  same("branch", expected.lastBranch, got.lastBranch);
}

void compareDeed(const reference::ForageDeed& expected, const reference::ForageDeed& got, Sample& sample) {
  sample.same("cell entered", static_cast<double>(expected.entered), static_cast<double>(got.entered));
  sample.same("grains laid", expected.grains, got.grains);
  sample.same("deed", static_cast<double>(expected.kind), static_cast<double>(got.kind));
  sample.same("source or branch of a deed", static_cast<double>(expected.of), static_cast<double>(got.of));
}

Sample compareForaging(const Setting& setting, const Moment& moment, const reference::AgentBody& body,
                       const reference::ForageResult& expected, bool asleep) {
  const reference::Goal goal = goalOf(moment.before, moment.agent);
  const glm::dvec2 got = desiredOf(moment.after, moment.agent);
  Sample sample;
  sample.finite("forager", records(moment.after.forager, moment.agent, shared::FORAGER_STRIDE));
  sample.finite("steer", records(moment.after.steer, moment.agent, shared::STEER_STRIDE));
  compareFields(goal, goalOf(moment.after, moment.agent), sample);
  compareForager(expected.forager, foragerOf(moment.after, moment.agent), sample);
  compareDeed(expected.deed, deedOf(moment.after, moment.agent), sample);
  sample.same("asleep", asleep, records(moment.after.steer, moment.agent, shared::STEER_STRIDE)[2]);
  const bool stands = body.absent || expected.forager.state == reference::Foraging::rest;
  // A place and the middle of a cell, as a goal to cross to.
  const double allowed =
      reference::tolerance::desiredVelocity(setting.extent, expected.distance, setting.tuning.slowRadius);
  sample.compare("desired velocity / speed",
                 glm::length(got - expected.velocity) / std::max(goal.speed, 1e-6), stands ? 0 : allowed,
                 {expected.velocity, 0, 0}, {got, 0, 0});
  return sample;
}

}  // namespace

void checkForage(const Setting& setting, const Moment& moment, Judge& judge) {
  const ForageFacts& facts = *setting.forage;
  const reference::AgentBody body = bodyOf(moment.before, moment.agent);
  const reference::ForageResult result =
      reference::forage(facts.tuning, facts.map, trailOf(moment.before, facts.map), body,
                        foragerOf(moment.before, moment.agent), goalOf(moment.before, moment.agent).speed,
                        facts.firstNumber + static_cast<int64_t>(moment.number()), moment.n);
  // Sleep follows from the velocity as in other herds; that has no say in what it is.
  reference::Goal going;
  going.kind = reference::GoalKind::velocity;
  going.target = result.velocity;
  going.speed = glm::length(result.velocity) + 1;
  const reference::Rest rest = restOf(setting, moment);
  const reference::NavigateResult sleep = reference::navigate(setting.tuning, body, going, rest);
  const Sample sample = compareForaging(setting, moment, body, result, sleep.asleep);
  const double breath = reference::tolerance::breathedOut(setting.tuning, rest.round, rest.gait);
  if (sample.passes() || !(sleep.breathMargin < breath))
    return judge.add(moment.n, moment.number(), -1, sample);
  const Sample other = compareForaging(setting, moment, body, result, !sleep.asleep);
  const bool slept = mayRest(moment.before, moment.agent) && mayRest(moment.after, moment.agent);
  judge.add(moment.n, moment.number(), -1, other.passes() ? other : sample, other.passes() && !slept);
}

void checkTrail(const Setting& setting, uint64_t n, const HerdState& before, const HerdState& after,
                Judge& judge) {
  const ForageFacts& facts = *setting.forage;
  if (before.agents != facts.agents) return;
  reference::ForageTrail expected = trailOf(before, facts.map);
  for (size_t agent = 0; agent < after.agents; ++agent)
    if (hasTurn(n, after, agent)) reference::layTrail(deedOf(after, agent), expected);
  reference::evaporate(facts.tuning, n, expected);
  const reference::ForageTrail got = trailOf(after, facts.map);
  const auto same = [](const char* what, const auto& want, const auto& found, Sample& sample) {
    for (size_t i = 0; i < want.size(); ++i)
      sample.same(what, static_cast<double>(want[i]), static_cast<double>(found[i]));
  };
  Sample sample;
  same("pheromone of a cell, grains", expected.grains, got.grains, sample);
  same("loads taken", expected.taken, got.taken, sample);
  same("entries of a branch", expected.passed, got.passed, sample);
  sample.same("loads brought", static_cast<double>(expected.brought), static_cast<double>(got.brought));
  sample.same("empty returns", static_cast<double>(expected.empty), static_cast<double>(got.empty));
  judge.add(n, before.sample.first, -1, sample);
}

}  // namespace skitter::validation
