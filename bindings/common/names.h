#pragma once

#include <fmt/format.h>

#include <array>
#include <optional>
#include <string_view>

#include "skitter/enum_names.h"
#include "skitter/error.h"

namespace skitter::bindings {

// The enumerator of that name. Else throws Error(input), in which `what` is the argument's name.
template <typename Enum, size_t Count>
Enum namedOf(const std::array<Enum, Count>& all, std::string_view what, std::string_view name) {
  const std::optional<Enum> found = enumNamed(all, name);
  if (!found) throw inputError(fmt::format("{} is \"{}\", expected one of {}", what, name, namesOf(all)));
  return *found;
}

}  // namespace skitter::bindings
