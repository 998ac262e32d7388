#include "gpu/stores.h"

#include "embedded/store_cost_comp_storage.h"
#include "embedded/store_cost_comp_texel.h"
#include "gpu/cost_probe.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <string_view>

namespace skitter::gpu {
namespace {

constexpr uint32_t kGroup = 64, kGroups = 256;  // half a megabyte of records, some tenths of a millisecond
constexpr int kTurns = 7;

}  // namespace

std::optional<StoreWidth> wantedStores(std::optional<StoreWidth> requested) {
  const char* named = std::getenv("SKITTER_STORES");
  if (requested || named == nullptr) return requested;
  const std::string_view name = named;
  if (name == "32") return StoreWidth::bits32;
  if (name == "64") return StoreWidth::bits64;
  throw inputError(fmt::format("SKITTER_STORES is \"{}\", expected 32 or 64", name));
}

StoreChoice chooseStores(LoadPath loads, std::optional<StoreWidth> wanted,
                         const std::function<std::optional<StoreCost>()>& measure) {
  if (loads == LoadPath::storage) return {.why = "64 bits go with texel loads alone"};
  if (wanted) return {.width = *wanted, .why = "asked for"};
  const std::optional<StoreCost> cost = measure();
  if (!cost) return {.why = "there are no timestamps to measure by"};
  return {.width = cost->bits64 < cost->bits32 ? StoreWidth::bits64 : StoreWidth::bits32,
          .cost = cost,
          .why = fmt::format("64 bits are {:.2f} times as quick", cost->bits32 / cost->bits64)};
}

std::optional<StoreCost> measureStores(Context& context) {
  if (!CostProbe::canTell(context)) return {};
  const Buffer records(context, uint64_t{kGroups} * kGroup * 32, "records to write");
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
  for (int i = 0; i < kTurns; ++i) {
    wideBest = std::min(wideBest, wide.seconds(kGroups));
    narrowBest = std::min(narrowBest, narrow.seconds(kGroups));
  }
  constexpr double each = 1e9 / (2.0 * kGroups * kGroup);
  return StoreCost{.bits32 = narrowBest * each, .bits64 = wideBest * each};
}

}  // namespace skitter::gpu
