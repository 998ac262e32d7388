#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/settings.h"
#include "skitter/device.h"

namespace skitter::experiments {

// With what, where and when it was measured, as name and value.
struct Setup {
  std::vector<std::pair<std::string, std::string>> facts;
  std::string warning;  // of times that mean little, in a sentence; or empty
};
// `otherWork`: the share of the machine's CPU time that others took meanwhile, if it is known.
Setup describeSetup(const DeviceReport& device, const Settings& settings, const std::string& command,
                    std::optional<double> otherWork);

}  // namespace skitter::experiments
