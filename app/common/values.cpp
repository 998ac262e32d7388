#include "app/common/values.h"

#include <fmt/format.h>

#include <charconv>
#include <optional>

#include "skitter/error.h"

namespace skitter::app {
namespace {

constexpr uint64_t maxSide = 16384;  // the largest 2D image that Vulkan devices offer

template <class T>
std::optional<T> parse(std::string_view text) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return {};
  return value;
}

Error unexpected(const std::string& option, const std::string& text, const std::string& expected) {
  return inputError(fmt::format("{} is {}, expected {}", option, text.empty() ? "empty" : text, expected));
}

}  // namespace

double parseNumber(const std::string& option, const std::string& text, double least, double most) {
  const auto value = parse<double>(text);
  if (!value || !(*value >= least && *value <= most)) {
    throw unexpected(option, text, fmt::format("a number from {} to {}", least, most));
  }
  return *value;
}

uint64_t parseWhole(const std::string& option, const std::string& text, uint64_t least, uint64_t most) {
  const auto value = parse<uint64_t>(text);
  if (!value || *value < least || *value > most) {
    throw unexpected(option, text, fmt::format("a whole number from {} to {}", least, most));
  }
  return *value;
}

std::pair<double, double> parsePair(const std::string& option, const std::string& text, double least,
                                    double most, bool bothFromOne) {
  const size_t comma = text.find(',');
  if (comma == std::string::npos) {
    if (!bothFromOne) throw unexpected(option, text, "two numbers with a comma between them");
    const double both = parseNumber(option, text, least, most);
    return {both, both};
  }
  return {parseNumber(option, text.substr(0, comma), least, most),
          parseNumber(option, text.substr(comma + 1), least, most)};
}

std::vector<double> parseNumbers(const std::string& option, const std::string& text, double least,
                                 double most) {
  std::vector<double> numbers;
  for (size_t from = 0;;) {
    const size_t comma = text.find(',', from);
    numbers.push_back(parseNumber(option, text.substr(from, comma - from), least, most));
    if (comma == std::string::npos) return numbers;
    from = comma + 1;
  }
}

Size parseSize(const std::string& option, const std::string& text, uint32_t least) {
  const size_t cross = text.find('x');
  const auto width = parse<uint64_t>(std::string_view(text).substr(0, cross));
  const auto height =
      cross == std::string::npos ? std::nullopt : parse<uint64_t>(std::string_view(text).substr(cross + 1));
  if (!width || !height || *width < least || *height < least || *width > maxSide || *height > maxSide) {
    throw unexpected(option, text, fmt::format("WIDTHxHEIGHT, each from {} to {}", least, maxSide));
  }
  return {static_cast<uint32_t>(*width), static_cast<uint32_t>(*height)};
}

}  // namespace skitter::app
