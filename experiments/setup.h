#pragma once

#include <string>
#include <utility>
#include <vector>

#include "experiments/settings.h"
#include "skitter/device.h"

namespace skitter::experiments {

// With what, where and when it was measured, as name and value.
using Setup = std::vector<std::pair<std::string, std::string>>;
Setup describeSetup(const DeviceReport& device, const Settings& settings, const std::string& command);

}  // namespace skitter::experiments
