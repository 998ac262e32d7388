#pragma once

#include <string>
#include <vector>

#include "skitter/clip.h"

namespace skitter::crowd {

// The clips that a herd plays, as the stages read them (include/skitter/records.h).
struct ClipRecords {
  int clips = 0, joints = 0, frames = 0;  // frames of the longest clip
  int standing = 0;  // the clip that an agent begins with: the first that stands, else the first
  std::vector<float> heads, times, rows, legs, bones;
};

// Those that are named or, without names, ClipSet::locomotion. Throws
// Error(input) that names the file where there is none, or none of that name.
std::vector<const Clip*> chosenClips(const ClipSet& set, const std::vector<std::string>& names);

// The records of the clips that are named.
ClipRecords clipRecords(const ClipSet& set, const std::vector<std::string>& names, int maxBones);

}  // namespace skitter::crowd
