#pragma once

#include "gpu/context.h"

#include <functional>
#include <optional>

// How shaders read and write records (shaders/lib/load4.glsl): by which load path, and by stores of which
// width. Both are as a request or an environment variable says, else as is quicker on the device.
namespace skitter::gpu {

// Under this, a page of records may not fit one texel view.
constexpr uint64_t kEnoughTexels = 1ull << 24;

// How much quicker texel loads must be. The variants may round differently, so noise must not choose: in
// about 120 measurements each, idle and loaded, equal paths (SwiftShader) came to at most 1.23, lavapipe to
// at least 2.
constexpr double kLoadMargin = 1.6;

// The path that a request names, or else the environment variable SKITTER_LOADS ("texel" or "storage").
// Throws Error(input) when that says something else.
std::optional<LoadPath> wantedLoads(std::optional<LoadPath> requested);

// `measure` is called only where both paths are possible and none is wanted; it gives nothing where the
// device's time cannot be told.
LoadChoice chooseLoads(const DeviceLimits&, const DeviceFeatures&, std::optional<LoadPath> wanted,
                       const std::function<std::optional<LoadCost>()>& measure);

// The width that a request names, or else the environment variable SKITTER_STORES ("32" or "64"). Throws
// Error(input) when that says something else.
std::optional<StoreWidth> wantedStores(std::optional<StoreWidth> requested);

// `measure` is called only where both widths are possible, with texel loads, and none is wanted; it gives
// nothing where the device's time cannot be told.
StoreChoice chooseStores(LoadPath, std::optional<StoreWidth> wanted,
                         const std::function<std::optional<StoreCost>()>& measure);

// Chooses both for a device that has just been opened.
void chooseAccess(Context&, const DeviceRequest&);

}  // namespace skitter::gpu
