#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace skitter {

// Parses JSON of at most 64 levels and 2,097,152 keys and values without repeated keys. Whole numbers are
// integers however they are written, those from 0 on unsigned. `comments`: // to the end of the line and /*
// */ are passed over. A fault is an Error(input) that begins with `name`.
nlohmann::json parseJson(std::string_view text, const std::string& name, bool comments = false);

// What a message says was found: the value itself where short, its type otherwise.
std::string describeJson(const nlohmann::json& value);

}  // namespace skitter
