#include "json.h"

#include <fmt/format.h>

#include <set>
#include <vector>

#include "skitter/error.h"

namespace skitter {

nlohmann::json parseJson(std::string_view text, const std::string& name) {
  // Deep nesting would overflow the stack of recursive visitors; of a repeated key all but the last would be
  // ignored without a word.
  constexpr int maxDepth = 64;
  using Event = nlohmann::json::parse_event_t;
  std::vector<std::set<std::string>> keys;
  const auto visit = [&](int depth, Event event, nlohmann::json& value) {
    if (depth > maxDepth) throw inputError(fmt::format("{}: JSON is nested over {} levels", name, maxDepth));
    if (event == Event::object_start) keys.emplace_back();
    if (event == Event::object_end) keys.pop_back();
    if (event == Event::key && !keys.back().insert(value.get<std::string>()).second) {
      throw inputError(fmt::format("{}: key {} appears twice in one object", name, describeJson(value)));
    }
    return true;
  };
  try {
    return nlohmann::json::parse(text.begin(), text.end(), visit);
  } catch (const nlohmann::json::exception& exception) {
    std::string what = exception.what();
    // The library prefixes an identifier such as "[json.exception.parse_error.101] ".
    if (const size_t end = what.find("] "); what.front() == '[' && end != std::string::npos) {
      what.erase(0, end + 2);
    }
    throw inputError(fmt::format("{}: is not valid JSON: {}", name, what));
  }
}

std::string describeJson(const nlohmann::json& value) {
  if (value.is_object()) return "an object";
  if (value.is_array()) return fmt::format("an array of {}", value.size());
  std::string text = value.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
  if (text.size() > 64) text = text.substr(0, 60) + "...\"";
  return text;
}

}  // namespace skitter
