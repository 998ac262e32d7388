#include "gpu/cost_probe.h"

#include <ctime>

namespace skitter::gpu {
namespace {

double cpuSeconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

}  // namespace

CostProbe::CostProbe(const Context& context, const KernelInfo& info, std::initializer_list<Binding> bindings)
    : context_(context),
      ring_(context, 1),
      timer_(context, 1, !context.isCpu()),
      kernel_(context, info),
      bindings_(kernel_.bind(context, bindings)) {}

double CostProbe::seconds(uint32_t groups) {
  const double began = cpuSeconds();
  const vk::CommandBuffer cmd = ring_.begin();
  timer_.reset(cmd);
  timer_.begin(cmd, "cost");
  kernel_.dispatch(cmd, bindings_, {}, groups);
  timer_.end(cmd, "cost");
  ring_.wait(ring_.submit());
  return context_.isCpu() ? cpuSeconds() - began : 1e-3 * timer_.milliseconds().front().milliseconds;
}

}  // namespace skitter::gpu
