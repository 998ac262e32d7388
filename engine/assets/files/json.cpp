#include "assets/files/json.h"

#include <fmt/format.h>

#include <cmath>
#include <set>
#include <vector>

#include "skitter/error.h"

namespace skitter {

namespace {

constexpr size_t maxDepth = 64, maxParts = size_t{1} << 21;
constexpr size_t maxFaultBytes = 200;

// Deep nesting would overflow the stack of recursive visitors, and a value takes many times the memory of its
// text; of a repeated key all but the last would be ignored without a word. A pass of its own, because a
// callback makes the library's parser visit all of an array's elements at the end of each.
class Checker : public nlohmann::json_sax<nlohmann::json> {
 public:
  explicit Checker(const std::string& name) : name_(name) {}

  bool null() override { return count(); }
  bool boolean(bool) override { return count(); }
  bool number_integer(number_integer_t) override { return count(); }
  bool number_unsigned(number_unsigned_t) override { return count(); }
  bool number_float(number_float_t, const string_t&) override { return count(); }
  bool string(string_t&) override { return count(); }
  bool binary(binary_t&) override { return count(); }
  bool start_object(size_t) override { return enter(); }
  bool end_object() override { return leave(); }
  bool start_array(size_t) override { return enter(); }
  bool end_array() override { return leave(); }
  bool key(string_t& key) override {
    if (!keys_.back().insert(key).second) {
      throw inputError(fmt::format("{}: key {} appears twice in one object", name_, describeJson(key)));
    }
    return count();
  }
  // The parser that follows says it better.
  bool parse_error(size_t, const std::string&, const nlohmann::json::exception&) override { return false; }

 private:
  bool count() {
    if (++parts_ > maxParts) {
      throw inputError(fmt::format("{}: JSON has over {} keys and values", name_, maxParts));
    }
    return true;
  }
  bool enter() {
    keys_.emplace_back();
    if (keys_.size() > maxDepth) {
      throw inputError(fmt::format("{}: JSON is nested over {} levels", name_, maxDepth));
    }
    return count();
  }
  bool leave() {
    keys_.pop_back();
    return true;
  }

  const std::string& name_;
  std::vector<std::set<std::string>> keys_;  // of each level
  size_t parts_ = 0;
};

// JSON lets a whole number be written 1.0, 1e0 or -0, which the library takes for something else.
void makeWholeNumbersIntegers(nlohmann::json& json) {
  if (json.is_structured()) {
    for (nlohmann::json& part : json) makeWholeNumbersIntegers(part);
  } else if (json.is_number() && !json.is_number_unsigned()) {
    const double number = json.get<double>();
    // Beyond 2^53 doubles skip integers.
    if (number != std::trunc(number) || std::fabs(number) > 9007199254740992.0) return;
    if (number < 0) {
      json = static_cast<int64_t>(number);
    } else {
      json = static_cast<uint64_t>(number);
    }
  }
}

}  // namespace

nlohmann::json parseJson(std::string_view text, const std::string& name, bool comments) {
  Checker checker(name);
  nlohmann::json::sax_parse(text.begin(), text.end(), &checker, nlohmann::json::input_format_t::json, true,
                            comments);
  try {
    nlohmann::json json = nlohmann::json::parse(text.begin(), text.end(), nullptr, true, comments);
    makeWholeNumbersIntegers(json);
    return json;
  } catch (const nlohmann::json::exception& exception) {
    std::string what = exception.what();
    // The library prefixes an identifier such as "[json.exception.parse_error.101] ".
    if (const size_t end = what.find("] "); what.front() == '[' && end != std::string::npos) {
      what.erase(0, end + 2);
    }
    // It also quotes what it read last, however long.
    if (what.size() > maxFaultBytes) what = what.substr(0, maxFaultBytes) + "...";
    // A number beyond a double's range is valid JSON all the same.
    const bool valid = dynamic_cast<const nlohmann::json::out_of_range*>(&exception) != nullptr;
    throw inputError(fmt::format("{}: {}{}", name, valid ? "" : "is not valid JSON: ", what));
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
