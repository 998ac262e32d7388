#include "validation/clip_leg.h"

#include "cpu_reference/stages/tolerances_clip.h"

namespace skitter::validation {

namespace tolerance = reference::tolerance;

// A bone's direction is as well known as its ends, seen over its length, and as the frame before it. Its
// stereographic coordinates see that over what they are divided by, 2 / (1 + t^2) but for a bone that is
// folded back, and so does the frame that it leaves to the next bone.
ClipLegBounds boundsOf(const Setting& setting, const reference::Limb& limb, size_t l,
                       const reference::Play& play, const reference::ClipLeg& leg) {
  ClipLegBounds bounds;
  for (const reference::ClipTable::LegJoint& joint : setting.clips.legs[l]) {
    bounds.joints.push_back(tolerance::blended(setting.clips, play, joint.joint, {joint.start, 1}));
  }
  double frame = 0;
  for (size_t i = 0; i < limb.bones.size(); ++i) {
    const double length = glm::length(leg.joints[i + 1] - leg.joints[i]);
    const double ends = length > 0 ? (bounds.joints[i] + bounds.joints[i + 1]) / length : 0;
    const double amplified = std::max(1.0, 1 / leg.divisors[i]);
    const double direction = frame + ends + 16 * tolerance::roundoff;
    bounds.directions.push_back(direction * amplified);
    frame += (direction + 24 * tolerance::roundoff) * amplified;
  }
  return bounds;
}

void compareDirections(const reference::ClipLeg& expected, const ClipLegBounds& bounds,
                       const std::vector<glm::dvec2>& got, Sample& sample) {
  for (size_t i = 0; i < got.size(); ++i) {
    sample.compare("direction", glm::length(expected.directions[i] - got[i]), bounds.directions[i],
                   {expected.directions[i], i, 0}, {got[i], i, 0});
  }
}

}  // namespace skitter::validation
