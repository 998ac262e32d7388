#include "cpu_reference/stages/foothold.h"

#include <algorithm>

#include "cpu_reference/heightfield.h"
#include "cpu_reference/stages/gait.h"
#include "cpu_reference/stages/swing.h"
#include "cpu_reference/stages/tolerances.h"

namespace skitter::reference {
namespace {

constexpr double othersMargin = 0.6;  // of the footprint

// When the foot lands, in the middle of its stance, and at its end.
std::vector<Border> bordersOf(std::span<const Passer> passers, double landing, double stance) {
  std::vector<Border> borders;
  for (const Passer& passer : passers) {
    const double radii = passer.radius + passer.ownRadius;
    for (const double time : {landing, landing + stance / 2, landing + stance}) {
      const glm::dvec2 then = passer.place + time * (passer.velocity - passer.ownVelocity);
      const double apart = glm::length(then), goes = time * glm::length(passer.ownVelocity);
      Border border;
      border.n = then / std::max(apart, 1e-6);
      border.most = std::max(apart, radii) * passer.ownRadius / radii +
                    time * glm::dot(border.n, passer.ownVelocity) - othersMargin * passer.ownRadius;
      // The vector errs by 8 roundings of what it is the sum of, times among it; its direction by that over
      // its length.
      const double errs =
          8 * tolerance::roundoff * (glm::length(passer.place) + goes + time * glm::length(passer.velocity));
      border.turns = std::min(2.0, 2 * errs / std::max(apart, 1e-6) + 4 * tolerance::roundoff);
      border.shifts = errs + goes * border.turns + 8 * tolerance::roundoff * (apart + radii + goes);
      borders.push_back(border);
    }
  }
  return borders;
}

// How far a place is beyond the borders.
void judgeAmong(const std::vector<Border>& borders, Candidate& candidate) {
  const glm::dvec2 q{candidate.point.x, candidate.point.z};
  for (const Border& border : borders) {
    candidate.beyond = std::max(candidate.beyond, glm::dot(border.n, q) - border.most);
    candidate.beyondError = std::max(candidate.beyondError, border.turns * glm::length(q) + border.shifts);
  }
}

Candidate evaluate(const Tuning& tuning, const Heights& heights, const Limb& limb, const AgentBody& body,
                   const FootholdResult& plan, const std::vector<Border>& borders, const glm::dvec2& ground) {
  Candidate candidate;
  const glm::dvec2 position = body.world();
  glm::dvec3 q = body.orientation * glm::dvec3(ground.x, plan.target.y, ground.y);
  q.y = heightAt(heights, position.x + q.x, position.y + q.z) - body.y;
  candidate.point = q;

  const glm::dvec3 up = body.orientation * glm::dvec3(0, 1, 0);
  const double least = tuning.reachLeast * limb.reach, most = tuning.reachMost * limb.reach;
  candidate.distance = glm::length(q - body.orientation * plan.root);
  candidate.facing = glm::dot(normalAt(heights, position.x + q.x, position.y + q.z), up);
  candidate.leastMargin = candidate.distance - least;
  candidate.mostMargin = most - candidate.distance;
  candidate.facingMargin = candidate.facing - tuning.slopeLeast;
  candidate.fits = candidate.leastMargin >= 0 && candidate.mostMargin >= 0 && candidate.facingMargin >= 0;
  candidate.misfit = std::abs(candidate.distance - std::clamp(candidate.distance, least, most)) +
                     (candidate.facingMargin < 0 ? tuning.legLength : 0);

  const glm::dvec3 miss = q - body.orientation * plan.target;
  candidate.score = glm::dot(miss, miss) / (tuning.legLength * tuning.legLength);
  if (!tuning.nearestOnly) {
    const double strain = std::max(0.0, candidate.distance / limb.reach - tuning.reachComfort);
    candidate.score += tuning.slopeWeight * (1 - candidate.facing) + tuning.reachWeight * strain * strain;
  }
  judgeAmong(borders, candidate);
  candidate.score +=
      othersWeight * candidate.beyond * candidate.beyond / (tuning.legLength * tuning.legLength);
  return candidate;
}

void layLadder(const Tuning& tuning, const Heights& heights, const Limb& limb, const AgentBody& body,
               const std::vector<Border>& borders, FootholdResult& plan) {
  const glm::dvec2 target{plan.target.x, plan.target.z};
  glm::dvec2 o = target - glm::dvec2(plan.root.x, plan.root.z);
  plan.side = glm::length(o);
  plan.stretch = std::max(plan.side, 0.1 * limb.reach);
  o = plan.side < 1e-6 ? normalized(glm::dvec2(limb.home.x - limb.root.x, limb.home.z - limb.root.z))
                       : o / plan.side;
  const glm::dvec2 across{-o.y, o.x};
  for (int k = 1; k <= 4; ++k) {
    for (int j = -k; j <= k; ++j) {
      const glm::dvec2 c =
          (target - o * plan.stretch) + o * (k * plan.stretch / 3) + across * (j * plan.stretch / 6);
      plan.candidates.push_back(evaluate(tuning, heights, limb, body, plan, borders, c));
    }
  }
}

void choose(FootholdResult& plan) {
  const auto& all = plan.candidates;
  int best = -1, nearest = 0;
  for (int i = 0; i < static_cast<int>(all.size()); ++i) {
    const Candidate& candidate = all[static_cast<size_t>(i)];
    if (candidate.fits && (best < 0 || candidate.score < all[static_cast<size_t>(best)].score)) best = i;
    if (candidate.misfit < all[static_cast<size_t>(nearest)].misfit) nearest = i;
  }
  plan.lastResort = best < 0;
  plan.chosen = best < 0 ? nearest : best;
}

}  // namespace

FootholdResult foothold(const Tuning& tuning, const Heights& heights, const Limb& limb, const AgentBody& body,
                        const Gait& gait, const Step& step, bool lifts, double tick,
                        const FootholdChoices& choices, const std::optional<glm::dvec3>& hanging,
                        std::span<const Passer> passers) {
  FootholdResult result;
  const double flown = tick - 1 - step.firstTick, lasted = std::abs(step.duration);
  const double fresh = limb.stepTicks(gait.duration);
  const double duration = lifts ? fresh : std::max(lasted - flown, 2.0);
  const double seconds = duration * tuning.dt;
  const double stanceTime = gait.cycle - fresh * tuning.dt;
  result.target = predictedLanding(limb, body, seconds, stanceTime);
  result.root = predictedRoot(limb, body, seconds);
  layLadder(tuning, heights, limb, body, bordersOf(passers, seconds, stanceTime), result);
  choose(result);
  if (choices.candidate) {
    result.chosen = *choices.candidate;
    result.lastResort = choices.lastResort;
  }

  const Candidate& candidate = result.candidates[static_cast<size_t>(result.chosen)];
  const glm::dvec3 landing = candidate.point;

  Step& next = result.step;
  const double u = step.progress(tick - 1);
  const Eased time = eased(step, u);
  const SplinePoint present = splineAt(step, time.progress);
  const glm::dvec3 liftOff = hanging.value_or(step.relative(lifts ? step.landing : present.position, body));
  const double chi = lifts ? 1 : 1 - u;
  std::optional<glm::dvec3> startTangent;
  if (!lifts) startTangent = present.tangent * (time.rate * duration / lasted);
  result.route = route(tuning, heights, body, liftOff, landing, startTangent, chi);
  if (choices.way) result.route.chosen = *choices.way;
  next.lift = result.route.way().lift;
  next.startTangent = startTangent.value_or(next.lift);
  const glm::dvec3 origin{body.localX, body.y, body.localZ};
  next.landing = landing + origin;
  next.liftOff = liftOff + origin;
  next.tileX = body.tileX;
  next.tileZ = body.tileZ;
  next.firstTick = tick - 1;
  next.duration = result.lastResort ? -duration : duration;
  return result;
}

}  // namespace skitter::reference
