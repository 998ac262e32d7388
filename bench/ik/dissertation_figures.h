#pragma once

#include <filesystem>

#include "skitter/device.h"

namespace skitter::bench {

// The dissertation's Figures 3, 4 and 5 (time against the iterations allowed, the accuracy asked for, and
// both), each in both readings of "altered in multiples of 100", and the cost of more iterations beside that
// of more instances. Writes one CSV file each into `folder` for scripts/plots.
void writeDissertationFigures(Device&, const std::filesystem::path& folder, bool quick);

}  // namespace skitter::bench
