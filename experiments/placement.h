#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/course.h"
#include "experiments/settings.h"
#include "skitter/controller.h"
#include "skitter/device.h"
#include "skitter/heightfield.h"

namespace skitter::experiments {

// Figures 12 to 14: one agent of each kind at the same rough place, from near by.
struct PlacementPicture {
  Controller controller;
  uint32_t width = 0, height = 0;
  std::vector<uint8_t> rgba;
  double roughness = 0;    // of the ground below its feet, leg lengths
  double penetration = 0;  // deepest foot, leg lengths
  double floating = 0;     // highest foot in stance above the ground, leg lengths
};

std::vector<PlacementPicture> measurePlacement(Device& device, const Heightfield& ground,
                                               const Settings& settings, Course& course);

}  // namespace skitter::experiments
