#include "cpu_reference/stages/gait.h"

#include <algorithm>
#include <limits>

#include "cpu_reference/heightfield.h"
#include "cpu_reference/stages/swing.h"

namespace skitter::reference {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

// How sure a disjunction is: if true, its surest true term; if false, its term nearest to being true.
class Disjunction {
 public:
  void add(bool holds, double margin) {
    if (holds) {
      surest_ = std::max(surest_, margin);
    } else {
      nearest_ = std::min(nearest_, margin);
    }
    value_ = value_ || holds;
  }
  bool value() const { return value_; }
  double margin() const { return value_ ? surest_ : nearest_; }

 private:
  bool value_ = false;
  double surest_ = 0, nearest_ = never;
};

// Has the ground moved under where the leg stands or will land, or risen into the rest of its way?
void look(const Tuning& tuning, const AgentBody& body, const Step& step, const Heights& heights,
          LegDecision& leg) {
  const glm::dvec2 position = body.world();
  const auto above = [&](const glm::dvec3& point) {
    const glm::dvec3 p = step.relative(point, body);
    return heightAt(heights, position.x + p.x, position.y + p.z) - body.y - p.y;
  };
  Disjunction moved;
  const auto exceeds = [&](double distance) {
    moved.add(distance > tuning.groundTolerance, std::abs(distance - tuning.groundTolerance));
  };
  exceeds(std::abs(above(step.landing)));
  const double way = eased(step, leg.progress).progress;
  for (int i = 0; i < 3 && !leg.planted; ++i)
    exceeds(above(splineAt(step, glm::mix(way, 1.0, i / 3.0)).position));
  leg.moved = moved.value();
  leg.movedMargin = moved.margin();
}

LegDecision judge(const Tuning& tuning, const Limb& limb, const AgentBody& body, const Step& step,
                  const Gait& gait, double stanceTime, double miss, double tick, WatchedGround watched) {
  LegDecision leg;
  leg.progress = step.progress(tick - 1);
  leg.planted = leg.progress >= 1;
  leg.mustMargin = leg.wantsMargin = leg.reaimMargin = leg.reaimProgressMargin = never;
  leg.movedMargin = never;
  if (watched) look(tuning, body, step, *watched, leg);
  const bool settled = body.still >= tuning.settleTime;
  const glm::dvec3 foot = step.relative(step.landing, body);
  const glm::dvec3 inModel = glm::conjugate(body.orientation) * foot;
  const glm::dvec2 ground{inModel.x, inModel.z};
  if (leg.planted) {
    leg.offset = glm::length(ground - glm::dvec2(limb.home.x, limb.home.z));
    leg.stretch = glm::length(foot - body.orientation * limb.root) / limb.reach;
    Disjunction must;
    must.add(leg.stretch > tuning.stretchLift, std::abs(leg.stretch - tuning.stretchLift) * limb.reach);
    must.add(leg.stretch < tuning.rootShare, std::abs(leg.stretch - tuning.rootShare) * limb.reach);
    const double astray = tuning.strayShare * gait.halfStride;
    must.add(leg.offset > astray, std::abs(leg.offset - astray));
    must.add(miss > tuning.errorLift, std::abs(miss - tuning.errorLift) * limb.reach);
    Disjunction wants;
    const double enough = (tuning.reachTriggered ? 0.6 : tuning.liftShare) * gait.halfStride;
    wants.add(leg.offset > enough, std::abs(leg.offset - enough));
    wants.add(must.value(), must.margin());
    wants.add(step.duration < 0, never);
    if (tuning.reachTriggered) must.add(leg.offset > enough, std::abs(leg.offset - enough));
    // Who stands still steps only off ground that moves.
    Disjunction now;
    if (!settled) now.add(must.value(), must.margin());
    now.add(leg.moved, leg.movedMargin);
    leg.must = now.value();
    leg.stoodSince = step.firstTick + std::abs(step.duration);
    leg.mustMargin = now.margin();
    leg.wants = !settled && wants.value();
    leg.wantsMargin = wants.margin();
  } else if (tick - 1 - step.firstTick >= 4) {
    const double remaining = (std::abs(step.duration) - (tick - 1 - step.firstTick)) * tuning.dt;
    const glm::dvec3 prediction = predictedLanding(limb, body, remaining, stanceTime);
    const double apart = glm::length(ground - glm::dvec2(prediction.x, prediction.z));
    leg.offset = apart;
    leg.reaimMargin = std::abs(apart - tuning.reaimDistance);
    leg.reaimProgressMargin = std::abs(leg.progress - tuning.reaimLatest);
    leg.wants = leg.moved || (apart > tuning.reaimDistance && leg.progress < tuning.reaimLatest);
  }
  return leg;
}

// The window of a leg: [0, windowOpen) of a group's share of the cycle after its own beginning.
void findWindow(const Tuning& tuning, const Creature& creature, const Limb& limb, const Gait& gait,
                double swingTime, LegDecision& leg) {
  const double groups = creature.groups;
  const double spread = tuning.lagShare * (1 / groups - swingTime / gait.cycle);
  double since = gait.phase - limb.group / groups - spread * limb.lag;
  since = (since - std::floor(since)) * groups;
  const bool always = tuning.reachTriggered || creature.stumbles();
  leg.open = always || since < tuning.windowOpen;
  leg.windowMargin = std::min({since, std::abs(since - tuning.windowOpen), groups - since});
  if (always) leg.windowMargin = never;
}

// A leg that decides nothing.
LegDecision idleDecision() {
  LegDecision leg;
  leg.windowMargin = leg.mustMargin = leg.wantsMargin = leg.movedMargin = never;
  leg.reaimMargin = leg.reaimProgressMargin = never;
  return leg;
}

}  // namespace

glm::dvec3 predictedLanding(const Limb& limb, const AgentBody& body, double seconds, double stanceTime) {
  const double ahead = seconds + stanceTime / 2;
  return Turn(body.turnRate * ahead)(limb.home) + glm::dvec3(0, 0, body.surfaceSpeed * ahead);
}

glm::dvec3 predictedRoot(const Limb& limb, const AgentBody& body, double seconds) {
  return Turn(body.turnRate * seconds)(limb.root) + glm::dvec3(0, 0, body.surfaceSpeed * seconds);
}

Stride strideOf(const Tuning& tuning, int groups, const AgentBody& body,
                const std::optional<double>& duration, double slowest, double hurry) {
  Stride stride;
  const double pace = body.pace(tuning) + hurry;
  const double unrounded = tuning.swingStill / (1 + pace / tuning.swingSpeed) / tuning.dt + 0.5;
  stride.duration = duration.value_or(std::max(2.0, std::floor(unrounded)));
  stride.durationMargin = std::abs(unrounded - std::round(unrounded));
  stride.swingTime = stride.duration * tuning.dt;
  const double duty = std::max(tuning.dutyLeast, tuning.dutyStill - tuning.dutyGain * pace);
  stride.cycle = std::min(tuning.cycleMax, stride.swingTime / (1 - duty));
  const double longest = std::floor(slowest * stride.duration + 0.5) * tuning.dt;
  stride.cycle = std::max(stride.cycle, groups * longest * tuning.windowSlack);
  const double stanceTime = stride.cycle - stride.swingTime;
  stride.half = std::clamp(pace * stanceTime / 2, tuning.halfStrideStill, tuning.halfStrideMax);
  return stride;
}

GaitResult gait(const Tuning& tuning, const Creature& creature, const AgentBody& body, double phase,
                std::span<const Step> steps, std::span<const double> misses, double tick,
                const GaitChoices& choices, WatchedGround watched, uint32_t idleBefore) {
  GaitResult result;
  Gait& next = result.gait;

  const Stride stride =
      strideOf(tuning, creature.groups, body, choices.duration, creature.slowest(), creature.hurry());
  next.halfStride = stride.half;
  next.duration = stride.duration;
  next.cycle = stride.cycle;
  result.durationMargin = stride.durationMargin;
  phase += tuning.dt / next.cycle;
  next.phase = phase - std::floor(phase);

  result.mustMargin = never;
  uint32_t rising = 0;
  for (size_t l = 0; l < creature.limbs.size(); ++l) {
    const Limb& limb = creature.limbs[l];
    const bool wasIdle = (idleBefore >> l & 1u) != 0;
    if (!limb.carries || wasIdle) {
      // A leg that carries again is in the air, and comes down by a step.
      uint32_t& mask = limb.carries ? rising : next.idle;
      mask |= 1u << l;
      result.legs.push_back(idleDecision());
      continue;
    }
    LegDecision leg =
        judge(tuning, limb, body, steps[l], next, stride.cycle - limb.stepTicks(stride.duration) * tuning.dt,
              misses[l], tick, watched);
    findWindow(tuning, creature, limb, next, stride.swingTime, leg);
    if (!leg.planted) next.air |= 1u << l;
    if (!leg.planted && leg.wants) next.reaim |= 1u << l;
    if (leg.planted) result.mustMargin = std::min(result.mustMargin, leg.mustMargin);
    if (leg.must &&
        (result.first < 0 || leg.stoodSince < result.legs[static_cast<size_t>(result.first)].stoodSince))
      result.first = static_cast<int>(l);
    result.legs.push_back(leg);
  }

  result.settleMargin = std::abs(body.still - tuning.settleTime);
  next.air |= rising;
  uint32_t yielding = 0;
  if (result.first >= 0) {
    yielding = creature.limbs[static_cast<size_t>(result.first)].neighbours;
    if ((next.air & yielding) == 0) next.lift = 1u << result.first;
  }
  for (size_t l = 0; l < creature.limbs.size(); ++l) {
    const LegDecision& leg = result.legs[l];
    const bool yields = (yielding >> l & 1u) != 0;
    const bool neighboursStand = (creature.limbs[l].neighbours & (next.air | next.lift)) == 0;
    if (leg.planted && leg.wants && leg.open && !yields && neighboursStand) next.lift |= 1u << l;
  }
  next.lift |= rising;
  next.reaim |= rising;
  return result;
}

}  // namespace skitter::reference
