#include "bench/cpu_crowd/herd.h"

namespace skitter::cpu_crowd {

std::unique_ptr<Kernel> scalarKernel(const World& world, const HerdState& start, const Options& options) {
  return kernelOf<float>(world, start, options);
}

}  // namespace skitter::cpu_crowd
