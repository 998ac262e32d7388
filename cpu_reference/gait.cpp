#include "cpu_reference/gait.h"

#include <algorithm>
#include <limits>

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

LegDecision judge(const Tuning& tuning, const Limb& limb, const AgentBody& body, const Step& step,
                  const Gait& gait, double stanceTime, double reachError, double tick) {
  LegDecision leg;
  leg.progress = step.progress(tick - 1);
  leg.planted = leg.progress >= 1;
  leg.mustMargin = leg.wantsMargin = leg.reaimMargin = leg.reaimProgressMargin = never;
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
    const double amiss = tuning.errorLift * limb.reach;
    must.add(reachError > amiss, std::abs(reachError - amiss));
    Disjunction wants;
    const double enough = tuning.liftShare * gait.halfStride;
    wants.add(leg.offset > enough, std::abs(leg.offset - enough));
    wants.add(must.value(), must.margin());
    wants.add(step.duration < 0, never);
    leg.must = must.value();
    if (leg.must) {
      leg.urgency = leg.stretch < tuning.rootShare ? 3 : leg.stretch + leg.offset / tuning.legLength;
    }
    leg.mustMargin = must.margin();
    leg.wants = wants.value();
    leg.wantsMargin = wants.margin();
  } else if (tick - 1 - step.firstTick >= 4) {
    const double remaining = (std::abs(step.duration) - (tick - 1 - step.firstTick)) * tuning.dt;
    const glm::dvec3 prediction = predictedLanding(limb, body, remaining, stanceTime);
    const double apart = glm::length(ground - glm::dvec2(prediction.x, prediction.z));
    leg.offset = apart;
    leg.reaimMargin = std::abs(apart - tuning.reaimDistance);
    leg.reaimProgressMargin = std::abs(leg.progress - tuning.reaimLatest);
    leg.wants = apart > tuning.reaimDistance && leg.progress < tuning.reaimLatest;
  }
  return leg;
}

// The leg of the largest urgency, lowest index first, and by how much it leads those of other groups.
struct Neediest {
  size_t leg = 0;
  double margin = never;
};
Neediest neediest(const Creature& creature, const std::vector<LegDecision>& legs) {
  Neediest found;
  for (size_t l = 1; l < legs.size(); ++l) {
    if (legs[l].urgency > legs[found.leg].urgency) found.leg = l;
  }
  const double most = legs[found.leg].urgency;
  for (size_t l = 0; l < legs.size(); ++l) {
    found.margin = std::min(found.margin, legs[l].mustMargin);
    // Legs that need nothing are equal exactly, and so are two at their roots: no ties of rounding.
    const bool sameConstant = legs[l].urgency == most && (most == 0 || most == 3);
    if (creature.limbs[l].group != creature.limbs[found.leg].group && !sameConstant) {
      found.margin = std::min(found.margin, most - legs[l].urgency);
    }
  }
  return found;
}

}  // namespace

glm::dvec3 predictedLanding(const Limb& limb, const AgentBody& body, double seconds, double stanceTime) {
  const double ahead = seconds + stanceTime / 2;
  return Turn(body.turnRate * ahead)(limb.home) + glm::dvec3(0, 0, body.v3 * ahead);
}

glm::dvec3 predictedRoot(const Limb& limb, const AgentBody& body, double seconds) {
  return Turn(body.turnRate * seconds)(limb.root) + glm::dvec3(0, 0, body.v3 * seconds);
}

GaitResult gait(const Tuning& tuning, const Creature& creature, const AgentBody& body, double phase,
                std::span<const Step> steps, std::span<const double> reachErrors, double tick,
                const GaitChoices& choices) {
  GaitResult result;
  Gait& next = result.gait;
  const double groups = creature.groups;

  const double pace = body.v3 + std::abs(body.turnRate) * tuning.homeRadius;
  next.halfStride = std::min(tuning.halfStrideStill + tuning.halfStrideGain * pace, tuning.halfStrideMax);
  const double unrounded = tuning.swingStill / (1 + pace / tuning.swingSpeed) / tuning.dt + 0.5;
  next.duration = choices.duration.value_or(std::max(3.0, std::floor(unrounded)));
  result.durationMargin = std::abs(unrounded - std::round(unrounded));
  const double swingTime = next.duration * tuning.dt;
  next.cycle = std::min(tuning.cycleMax, 2 * next.halfStride / std::max(pace, 1e-3) + swingTime);
  next.cycle = std::max(next.cycle, groups * swingTime * tuning.windowSlack);
  phase += tuning.dt / next.cycle;
  phase -= std::floor(phase);
  result.unmovedPhase = phase;

  bool someMust = false;
  for (size_t l = 0; l < creature.limbs.size(); ++l) {
    result.legs.push_back(
        judge(tuning, creature.limbs[l], body, steps[l], next, next.cycle - swingTime, reachErrors[l], tick));
    const LegDecision& leg = result.legs.back();
    if (!leg.planted) next.air |= 1u << l;
    if (!leg.planted && leg.wants) next.reaim |= 1u << l;
    someMust = someMust || leg.must;
  }

  double window = std::min(std::floor(phase * groups), groups - 1);
  double into = phase * groups - window;
  const auto marginOf = [&](double t) {
    return std::min({std::abs(t), std::abs(t - tuning.windowOpen), std::abs(1 - t)});
  };
  result.phaseMargin = marginOf(into);
  result.emergencyMargin = never;
  if (next.air == 0) {
    const Neediest needy = neediest(creature, result.legs);
    result.emergencyMargin = needy.margin;
    const double group = creature.limbs[needy.leg].group;
    if (someMust && !(window == group && into < tuning.windowOpen)) {
      result.emergency = true;
      phase = group / groups;
      window = group;
      into = 0;
    }
  }
  next.phase = phase;

  result.settleMargin = std::abs(body.still - tuning.settleTime);
  if (body.still >= tuning.settleTime || into >= tuning.windowOpen) return result;
  for (size_t l = 0; l < creature.limbs.size(); ++l) {
    if ((next.air >> l & 1u) != 0 && creature.limbs[l].group != window) return result;
  }
  for (size_t l = 0; l < creature.limbs.size(); ++l) {
    if (creature.limbs[l].group == window && result.legs[l].planted && result.legs[l].wants) {
      next.lift |= 1u << l;
    }
  }
  return result;
}

}  // namespace skitter::reference
