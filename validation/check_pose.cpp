#include "cpu_reference/stages/pose.h"
#include "cpu_reference/stages/tolerances.h"
#include "skitter/records.h"
#include "validation/checks.h"
#include "validation/convert.h"
#include "validation/fields.h"

namespace skitter::validation {
namespace {

namespace tolerance = reference::tolerance;

void compareBone(const reference::BonePose& expected, const reference::BonePose& got, int bones, double reach,
                 double unit, Sample& sample) {
  compareFields(expected, got, sample);
  sample.same("lost bone", expected.lost, got.lost);
  const glm::dquat &e = expected.rotation, &g = got.rotation;
  const glm::dvec4 u{e.x, e.y, e.z, e.w}, v{g.x, g.y, g.z, g.w};
  sample.compare("rotation", std::min(glm::length(u - v), glm::length(u + v)), tolerance::boneRotation(bones),
                 u, v);
  sample.compare("position / leg length", glm::length(expected.position - got.position) / unit,
                 tolerance::bonePosition(bones) * reach / unit, {expected.position, 0}, {got.position, 0});
}

}  // namespace

void checkPose(const Setting& setting, const Moment& moment, Judge& judge) {
  const reference::AgentBody body = bodyOf(moment.after, moment.agent);
  const size_t legs = static_cast<size_t>(setting.legs), bones = static_cast<size_t>(setting.bones);
  const size_t first = moment.agent * (1 + legs * bones);
  const double unit = setting.tuning.legLength;
  for (size_t l = 0; l < legs; ++l) {
    const reference::Limb& limb = setting.creature.limbs[l];
    Sample sample;
    const size_t entry = first + 1 + l * bones;
    sample.finite("pose", records(moment.after.pose, entry, shared::POSE_STRIDE, bones));
    if (l == 0) {
      sample.finite("pose", records(moment.after.pose, first, shared::POSE_STRIDE));
      compareBone(reference::bodyPose(body), boneOf(moment.after, first), 0, limb.reach, unit, sample);
    }
    const reference::Chain chain = chainOf(moment.after, moment.agent * legs + l, setting.bones);
    const auto expected = reference::pose(limb, body, chain.directions);
    const double length = limb.reach + glm::length(limb.root);
    for (size_t b = 0; b < bones; ++b) {
      compareBone(expected[b], boneOf(moment.after, entry + b), static_cast<int>(b) + 1, length, unit,
                  sample);
    }
    judge.add(moment.n, moment.number(), static_cast<int>(l), sample);
  }
}

}  // namespace skitter::validation
