#include "gpu/record_access.h"

#include "gpu/access_cost.h"

#include <fmt/format.h>

#include <cstdlib>
#include <string_view>

namespace skitter::gpu {

std::optional<LoadPath> wantedLoads(std::optional<LoadPath> requested) {
  const char* named = std::getenv("SKITTER_LOADS");
  if (requested || named == nullptr) return requested;
  const std::string_view name = named;
  if (name == "texel") return LoadPath::texel;
  if (name == "storage") return LoadPath::storage;
  throw inputError(fmt::format("SKITTER_LOADS is \"{}\", expected texel or storage", name));
}

LoadChoice chooseLoads(const DeviceLimits& limits, const DeviceFeatures& features,
                       std::optional<LoadPath> wanted,
                       const std::function<std::optional<LoadCost>()>& measure) {
  if (wanted) return {.path = *wanted, .why = "asked for"};
  if (!limits.texelRgba32f) return {.why = "there are no RGBA32F texel buffers"};
  if (limits.maxTexelBufferElements < kEnoughTexels) {
    return {.why = fmt::format("texel buffers reach no further than {} vec4", limits.maxTexelBufferElements)};
  }
  if (!features.shaderInt64)
    return {.why = "shaderInt64, which texel buffers go with, is missing or not known to be enabled"};
  const std::optional<LoadCost> cost = measure();
  if (!cost) return {.why = "there are no timestamps to measure by"};
  const double ratio = cost->storage / cost->texel;
  return {.path = ratio >= kLoadMargin ? LoadPath::texel : LoadPath::storage,
          .cost = cost,
          .why = fmt::format("texel loads are {:.2f} times as quick as storage loads, {} is asked for", ratio,
                             kLoadMargin)};
}

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

void chooseAccess(Context& context, const DeviceRequest& request) {
  context.setLoads(chooseLoads(context.limits(), context.features(), wantedLoads(request.loads),
                               [&] { return measureLoads(context); }));
  context.setStores(chooseStores(context.report().loads.path, wantedStores(request.stores),
                                 [&] { return measureStores(context); }));
}

}  // namespace skitter::gpu
