#pragma once

#include <nlohmann/json.hpp>

#include "skitter/device.h"

namespace skitter::bench {

// Table 1 of Aristidou & Lasenby 2011 with every solver of it that there is: 10 joints without limits,
// targets within and out of reach. Prints it; the same as JSON.
nlohmann::ordered_json runTable1(Device&, int targets);

}  // namespace skitter::bench
