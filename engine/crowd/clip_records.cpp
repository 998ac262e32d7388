#include "crowd/clip_records.h"

#include <algorithm>

#include "skitter/error.h"

namespace skitter::crowd {
namespace {

void push(std::vector<float>& records, float a, float b, float c, float d) {
  records.insert(records.end(), {a, b, c, d});
}

void appendFrames(const Clip& clip, size_t joints, size_t legs, ClipRecords& records) {
  for (size_t f = 0; f < clip.frames(); ++f) {
    const float to = f + 1 < clip.frames() ? clip.times[f + 1] - clip.times[f] : 0;
    uint32_t standing = 0;
    for (size_t l = 0; l < legs; ++l) standing |= clip.stance[f * legs + l] ? 1u << l : 0u;
    push(records.times, clip.times[f], to > 0 ? 1 / to : 0, static_cast<float>(standing), 0);
    for (size_t j = 0; j < joints; ++j)
      for (size_t r = 0; r < 3; ++r) {
        const glm::vec4& row = clip.rows[(f * joints + j) * 3 + r];
        push(records.rows, row.x, row.y, row.z, row.w - (r == 1 ? clip.ground : 0));
      }
  }
}

}  // namespace

std::vector<const Clip*> chosenClips(const ClipSet& set, const std::vector<std::string>& names) {
  std::vector<const Clip*> clips;
  for (const std::string& name : names) clips.push_back(&set.clip(name));
  if (names.empty()) clips = set.locomotion();
  if (!clips.empty()) return clips;
  std::string message = set.name + ": no clip to walk or to stand by";
  if (!set.clips.empty()) message += ", of";
  for (const Clip& clip : set.clips) message += " '" + clip.name + "'";
  if (!set.clips.empty()) message += "; name one by `clips`";
  for (const std::string& note : set.notes) message += "; " + note;
  throw inputError(message);
}

ClipRecords clipRecords(const ClipSet& set, const std::vector<std::string>& names, int maxBones) {
  ClipRecords records;
  records.joints = static_cast<int>(set.joints.size());
  int first = 0;
  const std::vector<const Clip*> chosen = chosenClips(set, names);
  const auto stands = std::ranges::find_if(chosen, [](const Clip* clip) { return !(clip->speed > 0); });
  if (stands != chosen.end()) records.standing = static_cast<int>(stands - chosen.begin());
  for (const Clip* clip : chosen) {
    const auto frames = static_cast<int>(clip->frames());
    push(records.heads, static_cast<float>(first), static_cast<float>(frames),
         static_cast<float>(clip->seconds), std::max(clip->speed, 0.0f));
    appendFrames(*clip, set.joints.size(), set.legs.size(), records);
    first += frames;
    ++records.clips;
    records.frames = std::max(records.frames, frames);
  }
  // What follows the last frame is loaded, and counts for nothing.
  records.rows.insert(records.rows.end(), set.joints.size() * 12, 0.0f);

  for (const ClipLeg& leg : set.legs)
    for (int i = 0; i <= maxBones; ++i) {
      const size_t own = std::min(static_cast<size_t>(i), leg.joints.size() - 1);
      push(records.legs, leg.starts[own].x, leg.starts[own].y, leg.starts[own].z, leg.joints[own]);
    }
  for (const ClipJoint& joint : set.joints)
    push(records.bones, static_cast<float>(joint.leg < 0 ? -1 : joint.leg * maxBones + joint.bone), 0, 0, 0);
  return records;
}

}  // namespace skitter::crowd
