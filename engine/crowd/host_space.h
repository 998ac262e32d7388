#pragma once

#include <fmt/format.h>

#include <cmath>

#include "skitter/error.h"
#include "skitter/host_space.h"

namespace skitter::crowd {

// Throws Error(input) for a unit that cannot be.
inline void checkSpace(const HostSpace& space) {
  if (!(space.metresPerUnit > 0) || !std::isfinite(space.metresPerUnit))
    throw inputError(fmt::format("metresPerUnit {}, expected a finite length above 0", space.metresPerUnit));
}

}  // namespace skitter::crowd
