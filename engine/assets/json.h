#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace skitter {

// Parses JSON of at most 64 levels and 2,097,152 keys and values without repeated keys; a fault is an
// Error(input) that begins with `name`.
nlohmann::json parseJson(std::string_view text, const std::string& name);

// What a message says was found: the value itself where short, its type otherwise.
std::string describeJson(const nlohmann::json& value);

}  // namespace skitter
