#include <optional>

#include "cpu_reference/ik/kinematics.h"
#include "cpu_reference/stages/hurt.h"
#include "cpu_reference/stages/ik.h"
#include "cpu_reference/stages/swing.h"
#include "cpu_reference/stages/tolerances.h"
#include "skitter/records.h"
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

// Erring solves a way, and ways that are tried at most.
constexpr uint64_t trials = 32;
constexpr size_t mostWays = 64;
// Erring solves of a leg whose errors have a long tail.
constexpr uint64_t tailTrials = 1 << 16;

// A leg's solve, as the reference is given it.
struct Solve {
  const Setting& setting;
  const reference::Limb& limb;
  const reference::AgentBody& body;
  const reference::Foot& foot;
  const reference::Chain& previous;

  reference::Posture run(reference::Arithmetic& arithmetic) const {
    const reference::IkPlan& plan = setting.ik;
    return {limb, reference::ik(setting.tuning, limb, body, foot, previous, plan, arithmetic).directions};
  }
};

// The largest distance of two poses' joints, share of the reach.
double farthest(const reference::Posture& a, const reference::Posture& b) {
  double apart = 0;
  for (size_t i = 1; i <= a.bones(); ++i) apart = std::max(apart, glm::length(a.joint(i) - b.joint(i)));
  return apart;
}

// Where a solve ends that decides in one way.
struct Ending {
  double apart = 0, tolerance = 0;    // of the pose that was found from it
  std::vector<bool> decisions, open;  // open: within its margin, so that float32 may decide otherwise

  double ratio() const { return apart / tolerance; }
};

// The errors of erring solves, all of which decide alike, are those that float32 may have: of the pose, and
// of each margin.
Ending endingOf(const Solve& solve, const reference::Arithmetic::Roundings& roundings,
                const std::vector<bool>& told, const reference::Posture& got, double least) {
  reference::Arithmetic exact(told);
  const reference::Posture end = solve.run(exact);
  const std::vector<double>& margins = exact.margins();
  double squares = 0;
  std::vector<double> marginSquares(margins.size(), 0.0);
  for (uint64_t trial = 0; trial < trials; ++trial) {
    reference::Arithmetic erring(exact.decisions(), roundings, trial);
    const double off = farthest(solve.run(erring), end);
    squares += off * off;
    for (size_t i = 0; i < std::min(margins.size(), erring.margins().size()); ++i) {
      const double moved = erring.margins()[i] - margins[i];
      marginSquares[i] += moved * moved;
    }
  }
  const auto bound = [](double sum) { return tolerance::deviations * std::sqrt(sum / trials); };
  Ending ending{farthest(got, end), std::max(least, bound(squares)), exact.decisions(), {}};
  for (size_t i = 0; i < margins.size(); ++i)
    ending.open.push_back(std::abs(margins[i]) <= bound(marginSquares[i]));
  return ending;
}

// Tries all ways to decide what is open: the first that ends where `got` is, or else the one that ends
// nearest. The exact one is the first.
Ending nearestEnding(const Solve& solve, const reference::Arithmetic::Roundings& roundings,
                     const reference::Posture& got, double least, bool& tie) {
  std::vector<std::vector<bool>> ways = {{}};
  Ending nearest;
  for (size_t w = 0; w < ways.size() && w < mostWays; ++w) {
    const std::vector<bool> told = ways[w];
    const Ending ending = endingOf(solve, roundings, told, got, least);
    if (w == 0 || ending.ratio() < nearest.ratio()) nearest = ending;
    tie = w > 0 && ending.ratio() <= 1;
    if (ending.ratio() <= 1) break;
    for (size_t i = told.size(); i < ending.decisions.size(); ++i) {
      if (!ending.open[i]) continue;
      ways.emplace_back(ending.decisions.begin(), ending.decisions.begin() + static_cast<ptrdiff_t>(i) + 1);
      ways.back().back().flip();
    }
  }
  return nearest;
}

// A tip that is at its target but for rounding may still be moved far by a step that divides by the arm's
// least singular value: one solve in a thousand then errs by a hundred times the median, and a deviation that
// some solves show says little. Such a leg may be as far off as the farthest of many erring solves that
// decide as `nearest` does. They are drawn until one errs as much, whose error is returned. A leg whose
// arithmetic errs as theirs is farther off than all of them once in 65,537.
std::optional<double> errorInTail(const Solve& solve, const reference::Arithmetic::Roundings& roundings,
                                  const Ending& nearest) {
  reference::Arithmetic exact(nearest.decisions);
  const reference::Posture end = solve.run(exact);
  for (uint64_t trial = 0; trial < tailTrials; ++trial) {
    reference::Arithmetic erring(nearest.decisions, roundings, trials + trial);
    const double off = farthest(solve.run(erring), end);
    if (off >= nearest.apart) return off;
  }
  return {};
}

double widestOf(const std::vector<glm::dvec2>& directions) {
  double widest = 0;
  for (const glm::dvec2& xy : directions) widest = std::max(widest, glm::length(xy));
  return widest;
}

}  // namespace

double kinematicsError(const Setting& setting, const reference::Limb& limb) {
  double widest = 0;
  for (const reference::BoneRest& bone : limb.bones) widest = std::max(widest, bone.tanHalfCone);
  return tolerance::forwardKinematics(setting.bones, widest);
}

SolveVerdict compareSolve(const Setting& setting, const Moment& moment, size_t l, const reference::Limb& limb,
                          const reference::Chain& previous, bool tails) {
  const reference::AgentBody body = bodyOf(moment.after, moment.agent);
  const size_t leg = moment.agent * static_cast<size_t>(setting.legs) + l;
  // What is made at once with swing and looked at by nobody has no foot records.
  const bool hasFeet = !moment.after.foot.empty();
  const reference::Step step = stepOf(moment.after, leg);
  const reference::Foot foot =
      hasFeet ? footOf(moment.after, leg) : reference::swing(step, body, static_cast<double>(moment.n));
  const glm::dvec3 target = reference::ikTarget(limb, body, foot.target);
  const double targetError = tolerance::farTarget(glm::length(target)) +
                             (hasFeet ? 0 : tolerance::foot(step, body, foot.progress >= 1) / limb.reach);
  const reference::Chain got = chainOf(moment.after, leg, setting.bones);
  const Solve solve{setting, limb, body, foot, previous};
  reference::Arithmetic exact;
  const reference::Posture posture(limb, got.directions), wanted = solve.run(exact);

  SolveVerdict verdict;
  Sample& sample = verdict.sample;
  sample.finite("chain", records(moment.after.chain, leg, shared::chainStride(setting.bones)));
  const double error = checkGoals(setting, limb, body, target, previous, got, posture, targetError,
                                  !moment.after.tip.empty(), sample);
  if (!moment.after.miss.empty()) checkMiss(setting, moment, l, limb, foot, error, targetError, sample);

  const double swing = std::max(widestOf(wanted.directions()), widestOf(previous.directions));
  const double least = tolerance::samePose(limb.bones.size(), swing);
  Ending ending{farthest(posture, wanted), least, {}, {}};
  if (!(ending.ratio() <= 1)) {
    const auto roundings = tolerance::solving(limb, foot, swing, targetError);
    ending = nearestEnding(solve, roundings, posture, least, verdict.tie);
    if (tails && !(ending.ratio() <= 1) && std::isfinite(ending.apart)) {
      if (const auto tail = errorInTail(solve, roundings, ending)) {
        ending.tolerance = *tail;
        verdict.tie = true;
      }
    }
  }
  sample.compare("joint positions / reach", ending.apart, ending.tolerance, {wanted.tip(), 0},
                 {posture.tip(), 0});
  return verdict;
}

Sample compareHeld(const Setting& setting, const Moment& moment, size_t l, const reference::Limb& limb) {
  const size_t leg = moment.agent * static_cast<size_t>(setting.legs) + l;
  const reference::Chain before = chainOf(moment.before, leg, setting.bones);
  const reference::Chain got = chainOf(moment.after, leg, setting.bones);
  const reference::Chain held = reference::heldLeg(limb, bodyOf(moment.after, moment.agent), before);
  Sample sample;
  for (size_t i = 0; i < limb.bones.size(); ++i)
    sample.compare("pose held", glm::length(before.directions[i] - got.directions[i]), 0,
                   {before.directions[i], 0, 0}, {got.directions[i], 0, 0});
  if (!moment.after.miss.empty())
    sample.same("miss of a leg that does not carry", 0,
                missOf(moment.after, moment.agent, l, setting.legs, moment.n));
  if (moment.after.tip.empty()) return sample;
  sample.finite("tip", records(moment.after.tip, leg, shared::TIP_STRIDE));
  const double bound =
      kinematicsError(setting, limb) * limb.reach + tolerance::rotated(glm::length(limb.root) + limb.reach);
  sample.compare("tip of a held pose / leg length",
                 glm::length(held.tip - got.tip) / setting.tuning.legLength, bound / setting.tuning.legLength,
                 {held.tip, 0}, {got.tip, 0});
  sample.same("reach error of a leg that does not carry", 0, got.reachError);
  return sample;
}

void checkIk(const Setting& setting, const Moment& moment, Judge& judge) {
  for (size_t l = 0; l < static_cast<size_t>(setting.legs); ++l) {
    const size_t leg = moment.agent * static_cast<size_t>(setting.legs) + l;
    const reference::Limb& limb = setting.creature.limbs[l];
    if (!limb.carries && !limb.folds) {
      judge.add(moment.n, moment.number(), static_cast<int>(l), compareHeld(setting, moment, l, limb));
      continue;
    }
    const reference::Chain previous = chainOf(moment.before, leg, setting.bones);
    const auto verdict = compareSolve(setting, moment, l, limb, previous, !judge.hasRefused());
    judge.add(moment.n, moment.number(), static_cast<int>(l), verdict.sample, verdict.tie);
  }
}

}  // namespace skitter::validation
