#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "base/spelling.h"
#include "skitter/enum_names.h"
#include "skitter/error.h"

namespace skitter::app {

// The value of an option as typed. Each throws Error(input) naming the option, what was typed and what was
// expected; NaN, infinities and trailing characters are refused.
double parseNumber(const std::string& option, const std::string& text, double least, double most);
uint64_t parseWhole(const std::string& option, const std::string& text, uint64_t least, uint64_t most);
// "A,B"; or "A" alone, which stands for both, where `bothFromOne`.
std::pair<double, double> parsePair(const std::string& option, const std::string& text, double least,
                                    double most, bool bothFromOne);

// "A,B,..", one or more.
std::vector<double> parseNumbers(const std::string& option, const std::string& text, double least,
                                 double most);

// The one of `all` that has this name.
template <typename Enum, size_t Count>
Enum parseNamed(const std::string& option, const std::string& text, const std::array<Enum, Count>& all) {
  if (const auto named = enumNamed(all, text)) return *named;
  std::vector<std::string> names;
  for (const Enum each : all) names.emplace_back(nameOf(each));
  throw inputError(option + " is " + (text.empty() ? "empty" : text) + base::expectedOneOf(text, names));
}

// "A,B,..", one or more.
template <typename Enum, size_t Count>
std::vector<Enum> parseNames(const std::string& option, const std::string& text,
                             const std::array<Enum, Count>& all) {
  std::vector<Enum> named;
  for (size_t from = 0, comma = 0; comma != text.npos; from = comma + 1) {
    comma = text.find(',', from);
    named.push_back(parseNamed(option, text.substr(from, comma - from), all));
  }
  return named;
}

struct Size {
  uint32_t width, height;
};
// "WIDTHxHEIGHT" of pictures and of grids, each side from `least` to 16384.
Size parseSize(const std::string& option, const std::string& text, uint32_t least = 1);

}  // namespace skitter::app
