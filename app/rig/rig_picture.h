#pragma once

#include <filesystem>

#include "app/common/values.h"
#include "skitter/rig.h"

namespace skitter::app {

// A rig at rest from four sides, its chains drawn over it in the colour of their group, the cones of their
// joints as circles, homes as crosses on the ground. Drawn in software: it needs no device.
void drawRig(const Rig& rig, Size size, const std::filesystem::path& file);

}  // namespace skitter::app
