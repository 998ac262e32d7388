#include "gpu/access_cost.h"

#include "base/clock.h"
#include "embedded/load_cost_comp_storage.h"
#include "embedded/load_cost_comp_texel.h"
#include "embedded/store_cost_comp_storage.h"
#include "embedded/store_cost_comp_texel.h"
#include "gpu/kernel.h"
#include "gpu/record_access.h"
#include "gpu/submit.h"
#include "gpu/timer.h"
#include "gpu/transfer.h"

#include <algorithm>
#include <initializer_list>
#include <limits>

namespace skitter::gpu {
namespace {

constexpr uint32_t kGroup = 64;
constexpr uint32_t kReadRecords = 16384,
                   kReadStride = 4;  // 1 MiB: as much as the smallest texel buffer view reaches
constexpr uint32_t kFewestReadGroups = 4 * kReadRecords / kGroup, kMostReadGroups = 1u << 20;
constexpr int kReadTurns = 5, kMostReadTurns = 50;
constexpr double kClear = 1.25;         // a ratio this far from the margin needs no further turns
constexpr double kLeastSeconds = 2e-4;  // what is over sooner tells of the dispatch, not of the loads
constexpr uint32_t kWriteGroups = 256;  // half a megabyte of records, some tenths of a millisecond
constexpr int kWriteTurns = 7;

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

CostProbe::CostProbe(const Context& context, const KernelInfo& info, std::initializer_list<Binding> bindings)
    : context_(context),
      ring_(context, 1),
      timer_(context, 1, !context.isCpu()),
      kernel_(context, info),
      bindings_(kernel_.bind(context, bindings)) {}

double CostProbe::seconds(uint32_t groups) {
  const double began = base::processSeconds();
  const vk::CommandBuffer cmd = ring_.begin();
  timer_.reset(cmd);
  timer_.begin(cmd, "cost");
  kernel_.dispatch(cmd, bindings_, {}, groups);
  timer_.end(cmd, "cost");
  ring_.wait(ring_.submit());
  return context_.isCpu() ? base::processSeconds() - began
                          : 1e-3 * timer_.milliseconds().front().milliseconds;
}

CostProbe reader(const Context& context, const Buffer& records, const Buffer& sums) {
  return {context,
          {.name = "load cost",
           .code = {embedded::load_cost_comp_texel(), embedded::load_cost_comp_storage()},
           .bindings = {{0, BindingKind::load4}, {1, BindingKind::store}},
           .constants = {{0, kReadRecords}, {1, kReadStride}}},
          {{0, &records}, {1, &sums}}};
}

}  // namespace

std::optional<LoadCost> measureLoads(Context& context) {
  if (!CostProbe::canTell(context)) return {};
  context.setLoads({.path = LoadPath::texel});  // a buffer made so can be read either way
  const Buffer records(context, uint64_t{kReadRecords} * kReadStride * 16, "records to read");
  const Buffer sums(context, 16, "sums");
  clear(context, records);
  CostProbe texel = reader(context, records, sums);
  context.setLoads({.path = LoadPath::storage});
  CostProbe storage = reader(context, records, sums);
  texel.seconds(1), storage.seconds(1);  // some drivers compile only now

  const uint32_t most = std::min(context.limits().maxComputeWorkGroupCountX, kMostReadGroups);
  for (uint32_t groups = kFewestReadGroups;; groups = std::min(most, groups * 4)) {
    double texelBest = std::numeric_limits<double>::max(), storageBest = texelBest;
    const auto clear = [&] {
      return storageBest < texelBest * kLoadMargin / kClear || storageBest > texelBest * kLoadMargin * kClear;
    };
    for (int i = 0; i < kReadTurns || (i < kMostReadTurns && !clear()); ++i) {
      texelBest = std::min(texelBest, texel.seconds(groups));
      storageBest = std::min(storageBest, storage.seconds(groups));
    }
    if (std::min(texelBest, storageBest) >= kLeastSeconds || groups == most) {
      const double each = 1e9 / (double(groups) * kGroup * kReadStride);
      return LoadCost{.texel = texelBest * each, .storage = storageBest * each};
    }
  }
}

std::optional<StoreCost> measureStores(Context& context) {
  if (!CostProbe::canTell(context)) return {};
  const Buffer records(context, uint64_t{kWriteGroups} * kGroup * 32, "records to write");
  const auto writer = [&](StoreWidth width) {
    context.setStores({.width = width});
    return CostProbe(context,
                     {.name = "store cost",
                      .code = {embedded::store_cost_comp_texel(), embedded::store_cost_comp_storage()},
                      .bindings = {{0, BindingKind::store}}},
                     {{0, &records}});
  };
  CostProbe wide = writer(StoreWidth::bits64), narrow = writer(StoreWidth::bits32);
  wide.seconds(1), narrow.seconds(1);  // some drivers compile only now

  double wideBest = std::numeric_limits<double>::max(), narrowBest = wideBest;
  for (int i = 0; i < kWriteTurns; ++i) {
    wideBest = std::min(wideBest, wide.seconds(kWriteGroups));
    narrowBest = std::min(narrowBest, narrow.seconds(kWriteGroups));
  }
  constexpr double each = 1e9 / (2.0 * kWriteGroups * kGroup);
  return StoreCost{.bits32 = narrowBest * each, .bits64 = wideBest * each};
}

}  // namespace skitter::gpu
