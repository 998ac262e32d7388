#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

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

struct Size {
  uint32_t width, height;
};
// "WIDTHxHEIGHT" of pictures and of grids, each side from `least` to 16384.
Size parseSize(const std::string& option, const std::string& text, uint32_t least = 1);

}  // namespace skitter::app
