#pragma once

#include <nlohmann/json.hpp>

namespace skitter::bench {

// FABRIK on chains set up as the library Caliko sets them up, by Caliko's own measure of a solve: straight at
// rest, balls of 90 degrees on a bone that turns freely about the base, 20 iterations at most, solved within
// 1 of a chain of 90, given up where an iteration gains less than 0.01. In double. Prints it; the same as
// JSON.
nlohmann::ordered_json runCaliko(int targets);

}  // namespace skitter::bench
