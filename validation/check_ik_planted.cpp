#include "cpu_reference/ik/kinematics.h"
#include "cpu_reference/stages/ik_planted.h"
#include "cpu_reference/stages/tolerances.h"
#include "skitter/records.h"
#include "validation/convert.h"
#include "validation/convert_clip.h"
#include "validation/solve.h"

namespace skitter::validation {
namespace {

namespace tolerance = reference::tolerance;

// What the corrections must be for the chain that was found. An arc between two bones, each as well known as
// forward kinematics has it, is as ill-conditioned as the two are opposite.
void compareFixes(const Setting& setting, const Moment& moment, size_t leg, const reference::Limb& limb,
                  const reference::PlantedStart& start, Sample& sample) {
  const reference::Chain got = chainOf(moment.after, leg, setting.bones);
  const auto fixes = reference::boneFixes(limb, start, got.directions);
  const reference::Posture played(limb, start.directions), found(limb, got.directions);
  double widest = 0;
  for (const glm::dvec2& xy : start.directions) widest = std::max(widest, glm::length(xy));
  const double kinematics =
      std::max(kinematicsError(setting, limb), tolerance::forwardKinematics(setting.bones, widest));
  for (size_t i = 0; i < fixes.size(); ++i) {
    const FixRecord fix = fixOf(moment.after, leg, setting.bones, static_cast<int>(i));
    const glm::dvec3 along = limb.bones[i].along;
    const double cosine = glm::dot(played.turned(i) * along, found.turned(i) * along);
    const double arc = (2 * kinematics + 16 * tolerance::roundoff) * 2 / std::max(1 + cosine, 1e-6);
    const glm::dquat want = glm::quat_cast(fixes[i].turn);
    const glm::dvec4 e{want.x, want.y, want.z, want.w}, g{fix.turn.x, fix.turn.y, fix.turn.z, fix.turn.w};
    sample.compare("correction's turn", std::min(glm::length(e - g), glm::length(e + g)), arc, e, g);
    const double far = glm::length(start.root) + limb.reach;
    const double move = 2 * arc * far + 2 * limb.reach * kinematics + tolerance::rotated(far);
    sample.compare("correction's move / leg length",
                   glm::length(fixes[i].move - fix.move) / setting.tuning.legLength,
                   move / setting.tuning.legLength, {fixes[i].move, 0}, {fix.move, 0});
  }
}

}  // namespace

void checkPlantedIk(const Setting& setting, const Moment& moment, Judge& judge) {
  const size_t legs = static_cast<size_t>(setting.legs), bones = static_cast<size_t>(setting.bones);
  for (size_t l = 0; l < legs; ++l) {
    const size_t leg = moment.agent * legs + l;
    const reference::PlantedStart start = startOf(moment.after, leg, setting.bones);
    const reference::Limb limb = reference::plantedLimb(setting.creature.limbs[l], start);
    reference::Chain clips;
    clips.directions = start.directions;
    SolveVerdict verdict;
    if (limb.carries)
      verdict = compareSolve(setting, moment, l, limb, clips, !judge.hasRefused());
    else
      verdict.sample = compareHeld(setting, moment, l, limb);
    verdict.sample.finite("fix", records(moment.after.fix, leg * bones, shared::FIX_STRIDE, bones));
    compareFixes(setting, moment, leg, limb, start, verdict.sample);
    judge.add(moment.n, moment.number(), static_cast<int>(l), verdict.sample, verdict.tie);
  }
}

}  // namespace skitter::validation
