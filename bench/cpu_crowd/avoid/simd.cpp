#include "bench/cpu_crowd/avoid/soft.h"

namespace skitter::cpu_avoid {

std::unique_ptr<Avoider> simdSoftAvoider(const Walkers& walkers, int threads) {
  return std::make_unique<SoftAvoider<Lanes>>(walkers, threads);
}

}  // namespace skitter::cpu_avoid
