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
  // What does not move is only to stand, and the first of that is enough.
  bool stands = false;
  for (const Clip& clip : set.clips) {
    if (!names.empty() || clip.speed < 0 || (clip.speed == 0 && stands)) continue;
    stands = stands || clip.speed == 0;
    clips.push_back(&clip);
  }
  if (clips.empty()) {
    std::string message = set.name + ": no clip that can be played";
    for (const std::string& note : set.notes) message += "; " + note;
    throw inputError(message);
  }
  return clips;
}

ClipRecords clipRecords(const ClipSet& set, const std::vector<std::string>& names, int maxBones) {
  ClipRecords records;
  records.joints = static_cast<int>(set.joints.size());
  int first = 0;
  for (const Clip* clip : chosenClips(set, names)) {
    const auto frames = static_cast<int>(clip->frames());
    if (clip->speed == 0 && records.heads.empty()) records.standing = records.clips;
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
