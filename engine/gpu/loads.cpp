#include "gpu/loads.h"

#include "embedded/load_cost_comp_storage.h"
#include "embedded/load_cost_comp_texel.h"
#include "gpu/cost_probe.h"
#include "gpu/transfer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <string_view>

namespace skitter::gpu {
namespace {

// How much quicker texel loads must be. The variants may round differently, so noise must not choose: in
// about 120 measurements each, idle and loaded, equal paths (SwiftShader) came to at most 1.23, lavapipe to
// at least 2.
constexpr double kMargin = 1.6;
constexpr uint32_t kRecords = 16384, kStride = 4;  // 1 MiB: as much as the smallest texel buffer view reaches
constexpr uint32_t kGroup = 64;
constexpr uint32_t kFewestGroups = 4 * kRecords / kGroup, kMostGroups = 1u << 20;
constexpr int kTurns = 5, kMostTurns = 50;
constexpr double kClear = 1.25;         // a ratio this far from the margin needs no further turns
constexpr double kLeastSeconds = 2e-4;  // what is over sooner tells of the dispatch, not of the loads

CostProbe reader(const Context& context, const Buffer& records, const Buffer& sums) {
  return {context,
          {.name = "load cost",
           .code = {embedded::load_cost_comp_texel(), embedded::load_cost_comp_storage()},
           .bindings = {{0, BindingKind::load4}, {1, BindingKind::store}},
           .constants = {{0, kRecords}, {1, kStride}}},
          {{0, &records}, {1, &sums}}};
}

}  // namespace

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
  return {.path = ratio >= kMargin ? LoadPath::texel : LoadPath::storage,
          .cost = cost,
          .why = fmt::format("texel loads are {:.2f} times as quick as storage loads, {} is asked for", ratio,
                             kMargin)};
}

std::optional<LoadCost> measureLoads(Context& context) {
  if (!CostProbe::canTell(context)) return {};
  context.setLoads({.path = LoadPath::texel});  // a buffer made so can be read either way
  const Buffer records(context, uint64_t{kRecords} * kStride * 16, "records to read");
  const Buffer sums(context, 16, "sums");
  clear(context, records);
  CostProbe texel = reader(context, records, sums);
  context.setLoads({.path = LoadPath::storage});
  CostProbe storage = reader(context, records, sums);
  texel.seconds(1), storage.seconds(1);  // some drivers compile only now

  const uint32_t most = std::min(context.limits().maxComputeWorkGroupCountX, kMostGroups);
  for (uint32_t groups = kFewestGroups;; groups = std::min(most, groups * 4)) {
    double texelBest = std::numeric_limits<double>::max(), storageBest = texelBest;
    const auto clear = [&] {
      return storageBest < texelBest * kMargin / kClear || storageBest > texelBest * kMargin * kClear;
    };
    for (int i = 0; i < kTurns || (i < kMostTurns && !clear()); ++i) {
      texelBest = std::min(texelBest, texel.seconds(groups));
      storageBest = std::min(storageBest, storage.seconds(groups));
    }
    if (std::min(texelBest, storageBest) >= kLeastSeconds || groups == most) {
      const double each = 1e9 / (double(groups) * kGroup * kStride);
      return LoadCost{.texel = texelBest * each, .storage = storageBest * each};
    }
  }
}

}  // namespace skitter::gpu
