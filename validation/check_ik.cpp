#include "cpu_reference/ik.h"
#include "cpu_reference/kinematics.h"
#include "cpu_reference/swing.h"
#include "cpu_reference/tolerances.h"
#include "shared/records.h"
#include "validation/checks.h"
#include "validation/convert.h"
#include "validation/solve.h"

namespace skitter::validation {
namespace {

namespace tolerance = reference::tolerance;

// What must hold of any result, whichever way the solver went. The error that is left is returned, a share of
// the reach.
double checkGoals(const Setting& setting, const reference::Limb& limb, const reference::AgentBody& body,
                  const glm::dvec3& target, const reference::Chain& previous, const reference::Chain& got,
                  const reference::Posture& posture, double targetError, bool hasTips, Sample& sample) {
  for (size_t i = 0; i < limb.bones.size(); ++i) {
    const double t = limb.bones[i].tanHalfCone;
    const double violation = 2 * (glm::length(got.directions[i]) - t) / (1 + t * t);
    sample.compare("limit violation, rad", std::max(0.0, violation), tolerance::limit,
                   {t, static_cast<double>(i), 0, 0}, {got.directions[i], 0, 0});
  }
  const double kinematics = kinematicsError(setting, limb);
  if (hasTips) {
    const glm::dvec3 tip = body.orientation * (limb.root + limb.reach * posture.tip());
    sample.compare("tip against its directions / reach", glm::length(tip - got.tip) / limb.reach, kinematics,
                   {tip, 0}, {got.tip, 0});
  }
  const bool finite = std::isfinite(target.x + target.y + target.z);
  const double error = finite ? glm::length(target - posture.tip()) : 0;
  if (hasTips) {
    sample.compare("reported error / reach", std::abs(error - got.reachError / limb.reach),
                   kinematics + targetError, {error * limb.reach, 0, 0, 0}, {got.reachError, 0, 0, 0});
  }
  for (size_t i = 0; i < limb.bones.size() && !finite; ++i) {
    sample.compare("pose kept", glm::length(previous.directions[i] - got.directions[i]), 0,
                   {previous.directions[i], 0, 0}, {got.directions[i], 0, 0});
  }
  return error;
}

// What body and gait are told of it.
void checkMiss(const Setting& setting, const Moment& moment, size_t l, const reference::Limb& limb,
               const reference::Foot& foot, double error, double targetError, Sample& sample) {
  sample.finite("miss", records(moment.after.miss, moment.agent, shared::missStride(setting.legs)));
  const double bound = kinematicsError(setting, limb) + targetError;
  const double found = missOf(moment.after, moment.agent, l, setting.legs, moment.n);
  // Near the least that is told of, either is right.
  const double least = setting.tuning.missLeast + (found > 0 ? -bound : bound);
  const double want = foot.progress >= 1 && error > least ? error : 0;
  sample.compare("miss / reach", std::abs(want - found), bound, {want, 0, 0, 0}, {found, 0, 0, 0});
}

// Of the approach's iterations the best is kept, and rounding decides between those that are equally near:
// from another of them the polish ends elsewhere. In reaches, the larger error of those from the first and
// the last of them.
double tiedError(const Setting& setting, const reference::Limb& limb, const reference::AgentBody& body,
                 const reference::Foot& foot, const reference::Chain& previous,
                 const reference::Chain& first) {
  const double tie = 2 * kinematicsError(setting, limb);
  const reference::Chain last = reference::ik(setting.tuning, limb, body, foot, previous, setting.ik, tie);
  return std::max(first.reachError, last.reachError) / limb.reach;
}

}  // namespace

double kinematicsError(const Setting& setting, const reference::Limb& limb) {
  double widest = 0;
  for (const reference::BoneRest& bone : limb.bones) widest = std::max(widest, bone.tanHalfCone);
  return tolerance::forwardKinematics(setting.bones, widest);
}

SolveVerdict compareSolve(const Setting& setting, const Moment& moment, size_t l, const reference::Limb& limb,
                          const reference::Chain& previous) {
  const reference::AgentBody body = bodyOf(moment.after, moment.agent);
  const size_t leg = moment.agent * static_cast<size_t>(setting.legs) + l;
  // What is made at once with swing and looked at by nobody has no foot records.
  const bool hasFeet = !moment.after.foot.empty();
  const reference::Step step = stepOf(moment.after, leg);
  const reference::Foot foot =
      hasFeet ? footOf(moment.after, leg) : reference::swing(step, body, static_cast<double>(moment.n));
  const double targetError = hasFeet ? 0 : tolerance::foot(step, body, foot.progress >= 1) / limb.reach;
  const reference::Chain got = chainOf(moment.after, leg, setting.bones);
  const reference::Chain expected = reference::ik(setting.tuning, limb, body, foot, previous, setting.ik);
  const reference::Posture posture(limb, got.directions), wanted(limb, expected.directions);

  SolveVerdict verdict;
  Sample& sample = verdict.sample;
  sample.finite("chain", records(moment.after.chain, leg, shared::chainStride(setting.bones)));
  const double error = checkGoals(setting, limb, body, reference::ikTarget(limb, body, foot.target), previous,
                                  got, posture, targetError, !moment.after.tip.empty(), sample);
  if (!moment.after.miss.empty()) checkMiss(setting, moment, l, limb, foot, error, targetError, sample);

  double apart = 0;
  for (size_t i = 1; i <= posture.bones(); ++i) {
    apart = std::max(apart, glm::length(posture.joint(i) - wanted.joint(i)));
  }
  verdict.tie = apart > tolerance::jointPosition;
  if (verdict.tie) {
    const double wantedError = tiedError(setting, limb, body, foot, previous, expected);
    sample.compare("error beyond the reference's / reach", std::max(0.0, error - wantedError),
                   tolerance::ikTie, {wantedError, apart, 0, 0}, {error, 0, 0, 0});
  } else {
    sample.compare("joint positions / reach", apart, tolerance::jointPosition);
  }
  return verdict;
}

void checkIk(const Setting& setting, const Moment& moment, Judge& judge) {
  for (size_t l = 0; l < static_cast<size_t>(setting.legs); ++l) {
    const size_t leg = moment.agent * static_cast<size_t>(setting.legs) + l;
    const reference::Chain previous = chainOf(moment.before, leg, setting.bones);
    const auto verdict = compareSolve(setting, moment, l, setting.creature.limbs[l], previous);
    judge.add(moment.n, moment.number(), static_cast<int>(l), verdict.sample, verdict.tie);
  }
}

}  // namespace skitter::validation
