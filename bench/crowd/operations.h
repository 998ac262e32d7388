#pragma once

#include "gpu/kernel.h"

namespace skitter::bench {

// Single-precision operations that one invocation of a kernel is written to make, counted in its SPIR-V after
// specialisation, with loops of known length unrolled: additions, subtractions, multiplications, divisions,
// minima, maxima, roots and other functions of GLSL.std.450 count one a component, a dot product of n
// components 2n - 1, a clamp two, a mix three. Both sides of a branch count, as they cost where lanes are
// masked; a loop of unknown length counts as one turn; comparisons, selections, integers, loads and stores do
// not count. Throws Error(check) when the SPIR-V cannot be read.
double operationsAnInvocation(std::span<const uint8_t> spirv,
                              const std::vector<gpu::SpecConstant>& constants);

}  // namespace skitter::bench
