#pragma once

#include <string>

#include "skitter/heightfield.h"

namespace skitter::app {

// Generated ground as an option's value: "noise", or "noise:amplitude=4,seed=7". The keys are those of a
// scene's terrain of kind "noise".
bool isNoise(const std::string& text);
// Throws Error(input) naming the option and the key at fault.
TerrainNoise parseNoise(const std::string& option, const std::string& text);

}  // namespace skitter::app
