#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "skitter/device.h"

// Where and with what a figure was measured, as it belongs beside the figure. No date, no path.
namespace skitter::bench {

nlohmann::ordered_json describeMachine(const DeviceReport&);
// With how the CPU opponent was compiled.
std::string machineLines(const DeviceReport&, const std::string& opponentBuild);

// Software devices are held against the CPU by the CPU time that they take; others by the wall clock.
inline bool isCpu(const DeviceReport& report) { return report.type == VK_PHYSICAL_DEVICE_TYPE_CPU; }

}  // namespace skitter::bench
