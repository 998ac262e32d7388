#include "json.h"

#include <fmt/format.h>

#include <set>
#include <vector>

#include "skitter/error.h"

namespace skitter {

namespace {

constexpr size_t maxDepth = 64;

// Deep nesting would overflow the stack of recursive visitors; of a repeated key all but the last would be
// ignored without a word. A pass of its own, because a callback makes the library's parser visit all of an
// array's elements at the end of each.
class Checker : public nlohmann::json_sax<nlohmann::json> {
 public:
  explicit Checker(const std::string& name) : name_(name) {}

  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t) override { return true; }
  bool number_unsigned(number_unsigned_t) override { return true; }
  bool number_float(number_float_t, const string_t&) override { return true; }
  bool string(string_t&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool start_object(size_t) override { return enter(); }
  bool end_object() override { return leave(); }
  bool start_array(size_t) override { return enter(); }
  bool end_array() override { return leave(); }
  bool key(string_t& key) override {
    if (!keys_.back().insert(key).second) {
      throw inputError(fmt::format("{}: key {} appears twice in one object", name_, describeJson(key)));
    }
    return true;
  }
  // The parser that follows says it better.
  bool parse_error(size_t, const std::string&, const nlohmann::json::exception&) override { return false; }

 private:
  bool enter() {
    keys_.emplace_back();
    if (keys_.size() > maxDepth) {
      throw inputError(fmt::format("{}: JSON is nested over {} levels", name_, maxDepth));
    }
    return true;
  }
  bool leave() {
    keys_.pop_back();
    return true;
  }

  const std::string& name_;
  std::vector<std::set<std::string>> keys_;  // of each level
};

}  // namespace

nlohmann::json parseJson(std::string_view text, const std::string& name) {
  Checker checker(name);
  nlohmann::json::sax_parse(text.begin(), text.end(), &checker);
  try {
    return nlohmann::json::parse(text.begin(), text.end());
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
