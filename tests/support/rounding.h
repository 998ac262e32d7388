#pragma once

#include "gpu/context.h"
#include "skitter/device.h"

namespace skitter::test {

// Whether two kernels round one expression alike. A GPU's compiler may make one operation of a product and a
// sum in one of them and not in the other (docs/devices.md#differences).
inline bool kernelsRoundAlike(const Device& device) { return device.context().isCpu(); }

}  // namespace skitter::test
