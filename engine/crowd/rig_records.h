#pragma once

#include <vector>

#include "skitter/rig.h"

namespace skitter::crowd {

// The rig as the stages read it: per leg rigStride(rig.maxBones()) vec4 (include/skitter/records.h).
std::vector<float> rigRecords(const Rig& rig);

}  // namespace skitter::crowd
