#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace skitter::app {

// What a state holds, for people and for programs. Both throw Error(input).
void printState(const std::string& file);
nlohmann::ordered_json describeState(const std::string& file);

}  // namespace skitter::app
