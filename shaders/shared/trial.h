// Trials of gaits (docs/evolve.md), as GLSL and C++ both see them: bindings of set 0 beside those of records
// (shared/bindings.h), push constants and the record.
#ifndef SKITTER_TRIAL_H
#define SKITTER_TRIAL_H

#ifdef __cplusplus
#include <cstdint>

namespace skitter::shared {
#define TRIAL_INT inline constexpr int
#define TRIAL_FUNCTION inline constexpr
#else
#define TRIAL_INT const int
#define TRIAL_FUNCTION
#endif

TRIAL_INT BINDING_TRIAL = 0;
TRIAL_INT BINDING_TRIAL_OUT = 1;

// trial, per agent:
//   [0] samples K; distance (m); cycles; samples without a safe support
//   [1] slip (m); largest reach error (m); least margin (m); unused
//   [2] at the last sample: body, tile-local x, y, z; phase
//   [3 + leg] tip at the last sample, tile-local x, y, z; 2 times the samples in which the leg was planted,
//   plus 1 where it was in the last one
TRIAL_INT TRIAL_LEGS = 3;  // where its vec4 of legs begin
TRIAL_FUNCTION int trialStride(int legs) { return TRIAL_LEGS + legs; }

struct TrialConstants {
#ifdef __cplusplus
  using uint = uint32_t;
#endif
  uint count;                   // agents
  uint begins;                  // 1: nothing is counted yet
  float legLength, bodyHeight;  // metres
  float safe;                   // margin below which a sample counts as unstable, metres
};

#ifdef __cplusplus
}  // namespace skitter::shared
#endif
#endif
