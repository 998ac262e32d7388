#pragma once

#include "skitter/enum_names.h"

namespace skitter {

// The state of a leg (docs/damage.md).
enum class LegState {
  whole,
  lame,   // its steps take longer, and the body goes slower
  stuck,  // holds its pose, and does not carry
  lost,   // ends at one of its joints, and does not carry
};
inline constexpr std::array allLegStates = {LegState::whole, LegState::lame, LegState::stuck, LegState::lost};
constexpr const char* nameOf(LegState state) {
  constexpr std::array names = {"whole", "lame", "stuck", "lost"};
  static_assert(names.size() == allLegStates.size());
  return names[static_cast<size_t>(state)];
}
constexpr std::optional<LegState> legStateNamed(std::string_view name) {
  return enumNamed(allLegStates, name);
}

}  // namespace skitter
