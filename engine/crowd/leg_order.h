#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "skitter/rig.h"

namespace skitter::crowd {

// A leg's place in the gait, from where its home is and its group alone; any number of legs.
struct LegOrder {
  // 0 for the rearmost leg of its group, 1 for the foremost, by position between: a group's legs lift from
  // the rear to the front, as spiders' do (4-2-3-1 along a side of alternating tetrapods).
  float lag = 0;
  // Bit m: leg m must stand while this one is in the air. The next legs around the body, where they are of
  // another group; below eight legs every leg of another group.
  uint32_t neighbours = 0;
};

std::vector<LegOrder> legOrder(const Rig& rig);

// Legs in the order in which their homes lie around the mean of all homes.
std::vector<size_t> legsAround(const Rig& rig);

}  // namespace skitter::crowd
