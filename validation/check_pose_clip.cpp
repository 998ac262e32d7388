#include "cpu_reference/stages/pose_clip.h"
#include "cpu_reference/stages/tolerances_clip.h"
#include "skitter/records.h"
#include "validation/checks.h"
#include "validation/convert.h"
#include "validation/convert_clip.h"

namespace skitter::validation {
namespace {

namespace tolerance = reference::tolerance;
using reference::Affine;

// Two turns at most of each column err by a share of its length, and a correction's move by one of its own,
// which may be far longer than what comes of it.
void compare(const Setting& setting, const Moment& moment, const reference::Play& play, size_t joint,
             const Affine& expected, double moved, Judge& judge) {
  const size_t entry = moment.agent * setting.clips.joints() + joint;
  const Affine got = matrixOf(moment.after, entry);
  const double unit = setting.tuning.legLength;
  Sample sample;
  sample.finite("pose", records(moment.after.pose, entry, shared::MATRIX_STRIDE));
  for (int c = 0; c < 3; ++c) {
    glm::dvec4 axis(0);
    axis[c] = 1;
    const double column = tolerance::blended(setting.clips, play, joint, axis);
    sample.compare("column", glm::length(expected[c] - got[c]),
                   column + 3 * tolerance::rotated(glm::length(expected[c])), {expected[c], c}, {got[c], c});
  }
  const double place = tolerance::blended(setting.clips, play, joint, {0, 0, 0, 1});
  sample.compare("place / leg length", glm::length(expected[3] - got[3]) / unit,
                 (place + 3 * tolerance::rotated(glm::length(expected[3]) + moved)) / unit, {expected[3], 0},
                 {got[3], 0});
  judge.add(moment.n, moment.number(), static_cast<int>(joint), sample);
}

// How far the end of a stump may be off: the joint as the frames have it, two turns and a move.
double stumpError(const Setting& setting, const reference::Play& play,
                  const reference::ClipTable::LegJoint& joint, const Affine& expected,
                  const reference::BoneFix& fix) {
  const double place = tolerance::blended(setting.clips, play, joint.joint, glm::dvec4(joint.start, 1));
  return place + 3 * tolerance::rotated(glm::length(expected[3]) + glm::length(fix.move));
}

void compareStump(const Setting& setting, const Moment& moment, size_t joint, const Affine& expected,
                  double error, Judge& judge) {
  const size_t entry = moment.agent * setting.clips.joints() + joint;
  const Affine got = matrixOf(moment.after, entry);
  const double unit = setting.tuning.legLength;
  Sample sample;
  sample.finite("pose", records(moment.after.pose, entry, shared::MATRIX_STRIDE));
  for (int c = 0; c < 3; ++c)
    sample.compare("column of a lost bone", glm::length(got[c]), 0, {expected[c], c}, {got[c], c});
  sample.compare("end of a stump / leg length", glm::length(expected[3] - got[3]) / unit, error / unit,
                 {expected[3], 0}, {got[3], 0});
  judge.add(moment.n, moment.number(), static_cast<int>(joint), sample);
}

}  // namespace

void checkClipPose(const Setting& setting, const Moment& moment, Judge& judge) {
  const reference::AgentBody body = bodyOf(moment.after, moment.agent);
  const reference::Play play = playOf(moment.after, moment.agent, setting.clips);
  for (size_t joint = 0; joint < setting.clips.joints(); ++joint) {
    compare(setting, moment, play, joint, reference::clipPose(setting.clips, body, play, joint), 0, judge);
  }
}

void checkPlantedPose(const Setting& setting, const Moment& moment, Judge& judge) {
  const reference::AgentBody body = bodyOf(moment.after, moment.agent);
  const reference::Play play = playOf(moment.after, moment.agent, setting.clips);
  for (size_t joint = 0; joint < setting.clips.joints(); ++joint) {
    const reference::ClipTable::BoneOf& owner = setting.clips.bones[joint];
    const auto fixOfBone = [&](int bone) -> reference::BoneFix {
      const size_t leg = moment.agent * static_cast<size_t>(setting.legs) + static_cast<size_t>(owner.leg);
      const FixRecord record = fixOf(moment.after, leg, setting.bones, bone);
      return {glm::mat3_cast(record.turn), record.move};
    };
    reference::BoneFix fix;
    if (owner.leg >= 0) {
      const auto leg = static_cast<size_t>(owner.leg);
      const size_t left = setting.creature.limbs[leg].left;
      if (static_cast<size_t>(owner.bone) >= left) {
        fix = fixOfBone(static_cast<int>(left));
        const Affine expected = reference::stumpPose(setting.clips, body, play, leg, left, fix);
        const double error = stumpError(setting, play, setting.clips.legs[leg][left], expected, fix);
        compareStump(setting, moment, joint, expected, error, judge);
        continue;
      }
      fix = fixOfBone(owner.bone);
    }
    compare(setting, moment, play, joint, reference::plantedPose(setting.clips, body, play, joint, fix),
            glm::length(fix.move), judge);
  }
}

}  // namespace skitter::validation
