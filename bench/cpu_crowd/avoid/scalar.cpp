#include "bench/cpu_crowd/avoid/soft.h"

namespace skitter::cpu_avoid {

std::unique_ptr<Avoider> scalarSoftAvoider(const Walkers& walkers, int threads) {
  return std::make_unique<SoftAvoider<float>>(walkers, threads);
}

std::unique_ptr<Avoider> softAvoider(const Walkers& walkers, cpu_crowd::Width width, int threads) {
  return width == cpu_crowd::Width::simd ? simdSoftAvoider(walkers, threads)
                                         : scalarSoftAvoider(walkers, threads);
}

}  // namespace skitter::cpu_avoid
