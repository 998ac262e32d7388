#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace skitter {

// Enumerators have names in scene files, options and figures: an enumeration E has `nameOf(E)`, an array of
// all its enumerators, and a function that finds one by its name with these. An enumerator that was renamed
// is found by its earlier name, too, where `isEarlierName(E, name)` says so.

template <typename Enum>
constexpr bool isEarlierName(Enum, std::string_view) {
  return false;
}

template <typename Enum, size_t Count>
constexpr std::optional<Enum> enumNamed(const std::array<Enum, Count>& all, std::string_view name) {
  for (const Enum each : all)
    if (name == nameOf(each) || isEarlierName(each, name)) return each;
  return {};
}

// "adaptive, loop, clip": for messages and help.
template <typename Enum, size_t Count>
std::string namesOf(const std::array<Enum, Count>& all, std::string_view separator = ", ") {
  std::string names;
  for (const Enum each : all) {
    if (!names.empty()) names += separator;
    names += nameOf(each);
  }
  return names;
}

}  // namespace skitter
