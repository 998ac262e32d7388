#include "bench/crowd/peaks.h"

#include <algorithm>
#include <thread>

#include "base/clock.h"
#include "bench/ik/machine.h"
#include "embedded/arithmetic_comp.h"
#include "embedded/copy_comp_storage.h"
#include "embedded/copy_comp_texel.h"
#include "gpu/barrier.h"
#include "gpu/buffer.h"
#include "gpu/kernel.h"
#include "gpu/submit.h"
#include "gpu/transfer.h"

namespace skitter::bench {
namespace {

constexpr int kRepetitions = 5;
constexpr uint64_t kCopyBytes = 256ull << 20;  // far beyond any cache
constexpr uint32_t kGroup = 64;
// arithmetic.comp has turns, chains, components, a product and a sum.
constexpr double kOperationsARound = 64 * 3 * 4 * 2;
constexpr int kRounds = 64;
constexpr uint32_t kFewestGroups = 64, kMostGroups = 65535;
constexpr int kMostCopies = 1024;
constexpr double kLeastSeconds = 0.02;  // beside which a submission takes no time

// On a software device, CPU time shared out to all threads: the wall clock tells of who else is at work.
template <typename Record>
double bestSeconds(const gpu::Context& context, const Record& record) {
  double best = 1e30;
  for (int i = 0; i <= kRepetitions; ++i) {
    const base::Seconds spent = base::timed([&] { gpu::submitAndWait(context, record); });
    const double shared = spent.cpu / std::max(1u, std::thread::hardware_concurrency());
    if (i > 0)
      best = std::min(best, isCpu(context.report()) ? shared : spent.wall);  // the first one compiles
  }
  return best;
}

// Records as many, one after the other, as take long enough in one submission, and returns the seconds of
// one.
template <typename Record>
double secondsOfOne(const gpu::Context& context, const Record& record) {
  for (int count = 1;; count *= 4) {
    const double seconds = bestSeconds(context, [&](vk::CommandBuffer cmd) {
      for (int i = 0; i < count; ++i) {
        record(cmd);
        gpu::allToAll(cmd);
      }
    });
    if (seconds >= kLeastSeconds || count >= kMostCopies) return seconds / count;
  }
}

double copyPeak(const gpu::Context& context) {
  const uint64_t reach =
      std::min({kCopyBytes, context.limits().maxStorageBufferRange, context.limits().availableBytes / 4,
                context.texelLoads() ? context.limits().maxTexelBufferElements * 16 : kCopyBytes,
                uint64_t{context.limits().maxComputeWorkGroupCountX} * kGroup * 16});
  const uint64_t bytes = reach / 4096 * 4096;
  const gpu::Buffer from(context, bytes, "copied from"), to(context, bytes, "copied to");
  gpu::clear(context, from);
  gpu::clear(context, to);
  const gpu::Kernel kernel(context, {"copy",
                                     {embedded::copy_comp_texel(), embedded::copy_comp_storage()},
                                     {{0, gpu::BindingKind::load4}, {1, gpu::BindingKind::store}},
                                     sizeof(uint32_t)});
  const gpu::Bindings bindings = kernel.bind(context, {{0, &from}, {1, &to}});
  const auto count = static_cast<uint32_t>(bytes / 16);
  const double byKernel = secondsOfOne(context, [&](vk::CommandBuffer cmd) {
    kernel.dispatch(cmd, bindings, gpu::bytesOf(count), gpu::groupsFor(count, kGroup));
  });
  const double byTransfer = secondsOfOne(context, [&](vk::CommandBuffer cmd) {
    cmd.copyBuffer(from.handle(), to.handle(), vk::BufferCopy{0, 0, bytes});
  });
  return 2.0 * static_cast<double>(bytes) / std::min(byKernel, byTransfer);
}

double arithmeticPeak(const gpu::Context& context) {
  const uint32_t most = std::min(kMostGroups, context.limits().maxComputeWorkGroupCountX);
  const gpu::Buffer sums(context, uint64_t{most} * kGroup * 16, "sums");
  const gpu::Kernel kernel(
      context,
      {"arithmetic", embedded::arithmetic_comp(), {{0, gpu::BindingKind::store}}, 0, {{0, kRounds}}});
  const gpu::Bindings bindings = kernel.bind(context, {{0, &sums}});
  for (uint32_t groups = std::min(kFewestGroups, most);; groups = std::min(groups * 4, most)) {
    const double seconds =
        bestSeconds(context, [&](vk::CommandBuffer cmd) { kernel.dispatch(cmd, bindings, {}, groups); });
    if (seconds >= kLeastSeconds || groups == most)
      return kOperationsARound * kRounds * kGroup * groups / seconds;
  }
}

}  // namespace

Peaks measurePeaks(const gpu::Context& context) { return {copyPeak(context), arithmeticPeak(context)}; }

}  // namespace skitter::bench
