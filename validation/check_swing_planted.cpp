#include "cpu_reference/stages/swing_clip.h"
#include "cpu_reference/stages/swing_planted.h"
#include "cpu_reference/stages/tolerances_clip.h"
#include "skitter/records.h"
#include "validation/checks.h"
#include "validation/clip_leg.h"
#include "validation/convert.h"
#include "validation/convert_clip.h"
#include "validation/fields.h"

namespace skitter::validation {
namespace {

namespace tolerance = reference::tolerance;
using reference::PlantedFoot;

struct Bounds {
  double horizontal = 0, vertical = 0;  // metres
};

// W errs by the clip's foot, turned to the world, and by the ground below it; a lock by the ground below
// itself too, and by what its tile leaves of it.
Bounds boundsOf(const Setting& setting, const Moment& moment, double clipFoot, const PlantedFoot& expected,
                double reach) {
  const reference::AgentBody body = bodyOf(moment.after, moment.agent);
  const glm::dvec2 position = body.world();
  const auto ground = [&](const glm::dvec3& relative, double horizontal) {
    const auto relief =
        reference::reliefNear(setting.heights, position.x + relative.x, position.y + relative.z);
    return tolerance::height(relief, setting.extent, horizontal);
  };
  Bounds bounds;
  const double place = clipFoot + tolerance::rotated(reach);
  // The device multiplies an offset by a power of the share that one tick leaves.
  const double kept =
      (static_cast<double>(moment.span) - 1) * tolerance::roundoff * glm::length(expected.plant.offset);
  bounds.horizontal = place + tolerance::relativeOver(reach) + kept;
  bounds.vertical = place + kept + ground(expected.wanted, place) +
                    ground(expected.foot.target, bounds.horizontal) +
                    16 * tolerance::roundoff * (std::abs(body.y) + reach);
  return bounds;
}

void compare(const Setting& setting, const Moment& moment, size_t leg, const PlantedFoot& expected,
             const Bounds& bounds, Sample& sample) {
  const double unit = setting.tuning.legLength;
  const reference::AgentBody body = bodyOf(moment.after, moment.agent);
  const reference::Foot foot = footOf(moment.after, leg);
  const reference::Plant got = plantOf(moment.after, leg);
  const auto place = [&](const glm::dvec3& want, const glm::dvec3& found, const char* across,
                         const char* up) {
    const glm::dvec3 apart = found - want;
    sample.compare(across, std::hypot(apart.x, apart.z) / unit, bounds.horizontal / unit, {want, 0},
                   {found, 0});
    sample.compare(up, std::abs(apart.y) / unit, bounds.vertical / unit, {want, 0}, {found, 0});
  };
  compareFields(expected.foot, foot, sample);
  sample.same("locked", expected.plant.locked, got.locked);
  sample.same("stance", expected.foot.progress, foot.progress);
  place(expected.foot.target, foot.target, "target, horizontally / leg length",
        "target's height / leg length");
  place(expected.plant.offset, got.offset, "offset, horizontally / leg length",
        "offset's height / leg length");
  // A lock that has been let go means nothing.
  if (expected.plant.locked && got.locked) {
    place(expected.plant.relative(body), got.relative(body), "lock, horizontally / leg length",
          "lock's height / leg length");
  }
}

}  // namespace

void checkPlantedSwing(const Setting& setting, const Moment& moment, Judge& judge) {
  const reference::AgentBody body = bodyOf(moment.after, moment.agent);
  const reference::Play play = playOf(moment.after, moment.agent, setting.clips);
  const size_t legs = static_cast<size_t>(setting.legs);
  for (size_t l = 0; l < legs; ++l) {
    const size_t leg = moment.agent * legs + l;
    const reference::Limb& limb = setting.creature.limbs[l];
    const reference::ClipLeg clipLeg = reference::clipLeg(setting.clips, limb, l, play);
    const ClipLegBounds legBounds = boundsOf(setting, limb, l, play, clipLeg);

    Sample common;
    common.finite("foot", records(moment.after.foot, leg, shared::FOOT_STRIDE));
    common.finite("step", records(moment.after.step, leg, shared::STEP_STRIDE));
    common.finite("start", records(moment.after.start, leg, shared::startStride(setting.bones)));
    const reference::PlantedStart start = startOf(moment.after, leg, setting.bones);
    compareDirections(clipLeg, legBounds, start.directions, common);
    common.compare(
        "root / leg length", glm::length(start.root - clipLeg.joints.front()) / setting.tuning.legLength,
        legBounds.joints.front() / setting.tuning.legLength, {clipLeg.joints.front(), 0}, {start.root, 0});

    const auto run = [&](const std::optional<bool>& locked) {
      if (!limb.carries) return reference::idlePlantedFoot(plantOf(moment.before, leg));
      return reference::plantedSwing(setting.tuning, setting.heights, body, clipLeg.joints.back(),
                                     clipLeg.stands, plantOf(moment.before, leg), locked);
    };
    const PlantedFoot expected = run({});
    const double reach = glm::length(clipLeg.joints.back()) + glm::length(expected.plant.offset);
    const Bounds bounds = boundsOf(setting, moment, legBounds.joints.back(), expected, reach);
    Sample sample = common;
    compare(setting, moment, leg, expected, bounds, sample);
    const bool tie = !sample.passes() && expected.strayMargin <= bounds.horizontal;
    if (tie) {
      sample = common;
      compare(setting, moment, leg, run(!expected.plant.locked), bounds, sample);
    }
    judge.add(moment.n, moment.number(), static_cast<int>(l), sample, tie);
  }
}

}  // namespace skitter::validation
