#pragma once

#include <string>
#include <vector>

#include "skitter/clip.h"

namespace skitter::crowd {

// Key poses of a rig's legs, as the stages read them; docs/stages/key-poses.md.
struct KeyPoses {
  int keys = 0;
  float stride = 0;            // metres a cycle
  std::vector<float> records;  // include/skitter/records.h, key
};

// The key poses of the clips that are named or, without names, of all clips. Throws Error(input) that names
// the file where none of them moves forward, or there is none of a name, or `keys` is out of range.
KeyPoses keyPoses(const ClipSet& set, const std::vector<std::string>& names, uint32_t keys, const Rig& rig,
                  const std::vector<float>& rigRecords);

}  // namespace skitter::crowd
