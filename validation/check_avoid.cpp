#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "cpu_reference/stages/avoid.h"
#include "cpu_reference/stages/tolerances.h"
#include "skitter/error.h"
#include "skitter/records.h"
#include "validation/checks.h"
#include "validation/convert.h"

namespace skitter::validation {
namespace {

namespace tolerance = reference::tolerance;

// More ties than this at once are not tried: two half-planes in doubt are rare already.
constexpr size_t mostSidesInDoubt = 6;
// Solves with errors of float32's size, from whose spread the velocity's tolerance is measured.
constexpr int erringSolves = 16;

// An agent, and what the stage of it is given.
struct Avoiding {
  const Setting& setting;
  const Moment& moment;
  reference::AgentBody body;
  reference::Walker self;
  glm::dvec2 desired;
  bool mayRest;

  // It looks again after a round, or in its own next tick.
  reference::AvoidTick tick() const {
    const auto span = static_cast<int>(moment.span);
    const double dt = setting.tuning.dt / span;
    const int until = std::max(span, reference::roundTicks(dt));
    return {static_cast<int64_t>(moment.n), until * dt, until};
  }

  reference::AvoidResult run(const reference::AvoidChoices& choices) const {
    return reference::avoid(setting.avoid, tick(), body, self, moment.around, desired, mayRest, choices);
  }
};

// The agent of that number; the end where it is not around.
Surroundings::const_iterator walkerAt(const Moment& moment, int64_t number) {
  const auto found = std::ranges::lower_bound(moment.around, number, {}, &reference::Walker::number);
  return found != moment.around.end() && found->number == number ? found : moment.around.end();
}

Avoiding avoidingOf(const Setting& setting, const Moment& moment) {
  Avoiding agent{.setting = setting,
                 .moment = moment,
                 .body = bodyOf(moment.before, moment.agent),
                 .self = {},
                 .desired = desiredOf(moment.after, moment.agent),
                 .mayRest = mayRest(moment.after, moment.agent)};
  if (agent.body.absent) return agent;
  agent.self = selfAround(setting, moment);
  return agent;
}

// The sizes of what a half-plane is computed from, m/s.
double sizeOf(const Avoiding& agent) {
  double fastest = glm::length(agent.self.velocity) + glm::length(agent.desired);
  int64_t widest = 0;
  for (const reference::Walker& other : agent.moment.around) {
    fastest = std::max(fastest, glm::length(other.velocity));
    widest = std::max(widest, other.radius);
  }
  // Lengths are at most a reach; a horizon of 2 s makes half as many m/s of them.
  const auto reach = static_cast<double>(agent.self.radius + widest + agent.setting.avoid.look);
  return 2 * fastest + reach / agent.setting.avoid.quanta;
}

struct Allowed {
  double velocity = 0, mostSpeed = 0;  // m/s
};

// How far a float32 solve may be off. It is six standard deviations of solves that err at random, which take
// the same sides, for where rounding leads depends on how the half-planes lie to each other; and what float32
// errs by where no half-plane is met: a normalisation, a root and ten operations.
Allowed bound(const Avoiding& agent, const reference::AvoidResult& result, bool otherObstacle = false) {
  reference::AvoidChoices same{.otherObstacle = otherObstacle};
  std::vector<reference::Walker> neighbours;
  for (const reference::HalfPlane& plane : result.planes) {
    same.right.push_back(plane.right);
    neighbours.push_back(*walkerAt(agent.moment, plane.neighbour));
  }
  double squares = 0, speedSquares = 0;
  for (int i = 0; i < erringSolves; ++i) {
    const reference::AvoidErrors errors{.number = tolerance::roundoff, .seed = static_cast<uint64_t>(i) + 1};
    const reference::AvoidResult erring =
        reference::avoid(agent.setting.avoid, agent.tick(), agent.body, agent.self, neighbours, agent.desired,
                         agent.mayRest, same, errors);
    const glm::dvec2 apart = erring.velocity - result.velocity;
    const double faster = erring.mostSpeed - result.mostSpeed;
    squares += glm::dot(apart, apart);
    speedSquares += faster * faster;
  }
  const auto spread = [](double sum) { return tolerance::deviations * std::sqrt(sum / erringSolves); };
  // A speed follows from a gap, which errs by roundings of the lengths that it is the difference of, in a
  // tick.
  const double inATick = sizeOf(agent) / agent.tick().dt;
  return {spread(squares) + 16 * tolerance::roundoff * sizeOf(agent),
          spread(speedSquares) + 16 * tolerance::roundoff * (inATick + result.mostSpeed)};
}

Sample compareAvoid(const Avoiding& agent, const reference::AvoidResult& expected, const Allowed& allowed) {
  const Moment& moment = agent.moment;
  const glm::dvec2 got = velocityOf(moment.after, moment.agent);
  Sample sample;
  sample.finite("avoid", records(moment.after.avoid, moment.agent, shared::AVOID_STRIDE));
  sample.same("agents in reach", static_cast<double>(expected.seen), seenOf(moment.after, moment.agent));
  sample.same("asleep", expected.asleep, asleepOf(moment.after, moment.agent));
  const double mostSpeed = *mostSpeedOf(moment.after, moment.agent);
  sample.compare("speed along the heading, m/s", std::abs(mostSpeed - expected.mostSpeed), allowed.mostSpeed,
                 {expected.mostSpeed, 0, 0, 0}, {mostSpeed, 0, 0, 0});
  sample.compare("velocity, m/s", glm::length(got - expected.velocity), allowed.velocity,
                 {expected.velocity, 0, 0}, {got, 0, 0});
  return sample;
}

}  // namespace

const reference::Walker& selfAround(const Setting& setting, const Moment& moment) {
  const auto found = walkerAt(moment, setting.firstNumber + static_cast<int64_t>(moment.number()));
  if (found == moment.around.end())
    throw inputError("replay: the surroundings lack an agent whose herd avoids");
  return *found;
}

void checkAvoid(const Setting& setting, const Moment& moment, Judge& judge) {
  const Avoiding agent = avoidingOf(setting, moment);
  const reference::AvoidResult result = agent.run({});
  const Allowed allowed = agent.body.absent ? Allowed{} : bound(agent, result);
  const Sample sample = compareAvoid(agent, result, allowed);
  if (sample.passes()) return judge.add(moment.n, moment.number(), -1, sample);

  // Which side of somebody to pass on: the cross product over the distance errs by 16 roundings of
  // velocities.
  std::vector<size_t> inDoubt;
  const double near = 16 * tolerance::roundoff * sizeOf(agent);
  for (size_t k = 0; k < result.planes.size() && inDoubt.size() < mostSidesInDoubt; ++k)
    if (result.planes[k].sideMargin < near) inDoubt.push_back(k);
  // And which obstacle is the last that counts: a distance errs by 4 roundings of what it follows from.
  const bool obstacleInDoubt = result.obstacleMargin < 4 * tolerance::roundoff;
  for (size_t way = 0; way < size_t{obstacleInDoubt ? 2u : 1u} << inDoubt.size(); ++way) {
    reference::AvoidChoices choices{.otherObstacle = (way >> inDoubt.size() & 1) != 0};
    choices.right.assign(result.planes.size(), -1);
    for (size_t i = 0; i < inDoubt.size(); ++i) choices.right[inDoubt[i]] = static_cast<int>(way >> i & 1);
    const reference::AvoidResult other = agent.run(choices);
    const Allowed otherAllowed = bound(agent, other, choices.otherObstacle);
    for (const int stands : {-1, 0, 1}) {
      if (stands >= 0 && !(other.standMargin < otherAllowed.velocity)) continue;
      choices.stands = stands;
      const Sample tie = compareAvoid(agent, agent.run(choices), otherAllowed);
      if (tie.passes()) return judge.add(moment.n, moment.number(), -1, tie, true);
    }
  }
  judge.add(moment.n, moment.number(), -1, sample);
}

}  // namespace skitter::validation
