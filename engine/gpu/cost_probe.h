#pragma once

#include "gpu/kernel.h"
#include "gpu/submit.h"
#include "gpu/timer.h"

#include <initializer_list>

namespace skitter::gpu {

// Times one kernel, to choose between two by: CPU time of all threads on a software device, timestamps
// elsewhere.
class CostProbe {
 public:
  // Whether the device's time can be told.
  static bool canTell(const Context& context) { return context.isCpu() || context.timestamps(); }

  // The buffers must outlive it.
  CostProbe(const Context&, const KernelInfo&, std::initializer_list<Binding>);
  double seconds(uint32_t groups);

 private:
  const Context& context_;
  CommandRing ring_;
  StageTimer timer_;
  Kernel kernel_;
  Bindings bindings_;
};

}  // namespace skitter::gpu
