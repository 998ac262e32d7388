#pragma once

// What tolerances count in.
namespace skitter::reference::tolerance {

// Half an ulp of 1 in float32.
inline constexpr double roundoff = 0x1p-24;

}  // namespace skitter::reference::tolerance
