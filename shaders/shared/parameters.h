// Parameters of a kind of herds: a uniform block to GLSL (std140: scalars only, so both layouts are the same)
// and a struct to C++. Lengths are metres, scaled by the rig's leg length; docs/stages.md states each use.
#ifndef SKITTER_PARAMETERS_H
#define SKITTER_PARAMETERS_H

#include "skitter/tuning.h"

#ifdef __cplusplus
namespace skitter::shared {
#endif

// Every parameter is a row of one of four tables. `place` and `number` are those of skitter/tuning.h, where
// SKITTER_TUNING is the first table: what users set.

// Fixed: FIXED(X, place, number, name, unit, value, why)
// clang-format off
#define SKITTER_FIXED(FIXED, X) \
  FIXED(X, KNOWN, 15, ridge, legLengths2, 1e-4, "regularises the plane fit") \
  FIXED(X, KNOWN, 50, approachError, reaches, 0.25, \
        "at most a half; beyond it the approach iterates; less: FABRIK bends a tracked leg more than it need be") \
  FIXED(X, KNOWN, 52, pullError, reaches, 0.1, \
        "about a fast tick; below it the rest pull acts; out of reach no pull may act") \
  FIXED(X, KNOWN, 53, ikTolerance, reaches, 2e-5, \
        "counts as arrived; a planted foot's slide is the sum of such errors") \
  FIXED(X, KNOWN, 54, missLeast, reaches, 2e-4, \
        "body and gait do not hear of a planted foot that misses by less; one planted leg of a thousand misses by more") \
  FIXED(X, UNIFORM, _, sinkMost, legLengths, 0.1, "a body is wanted at most so far below the ground at its origin") \
  FIXED(X, UNIFORM, _, riseMost, legLengths, 1, "a body is at most so far above the highest ground below it") \
  FIXED(X, UNIFORM, _, climbMost, legLengths, 0.6, "ground ahead that is so much too high for the support plane is a wall") \
  FIXED(X, UNIFORM, _, gapMost, legLengths, 1.8, "ground ahead that is so far below it is a cliff") \
  FIXED(X, UNIFORM, _, deadZone, legLengths, 0.005, "depth or height of a foot that counts as touching") \
  FIXED(X, UNIFORM, _, skateSpeed, legLengthsPerSecond, 0.1, "horizontal speed above which a planted foot skates") \
  FIXED(X, UNIFORM, _, limitDeadZone, radians, 1e-4, \
        "beyond a limit that does not count; a clamped direction is within 1e-6") \
  FIXED(X, UNIFORM, _, gravity, number, 9.81, "m/s^2") \
  FIXED(X, UNIFORM, _, disturbTime, seconds, 1, "after a disturbance a fall may begin for so long") \
  FIXED(X, UNIFORM, _, slipMiss, reaches, 0.05, "a planted foot that misses by more slips") \
  FIXED(X, UNIFORM, _, steadySpeed, legLengthsPerSecond, 1e-3, "a slower rest of a push is none") \
  FIXED(X, UNIFORM, _, tumbleRate, radiansPerSecond, 9, "of the spring that tips a fallen body over: in 0.3 s") \
  FIXED(X, UNIFORM, _, tumbleDamping, number, 0.6, "of that spring; 1 is critical") \
  FIXED(X, UNIFORM, _, lieAngle, radians, 1.2, "tilt at which it comes to rest; sin and cos are of a Cayley turn") \
  FIXED(X, UNIFORM, _, tiltMost, radians, 1.5, "largest tilt") \
  FIXED(X, UNIFORM, _, uprightTilt, radians, 0.05, "below it a body that rights itself is upright") \
  FIXED(X, UNIFORM, _, restSpeed, legLengthsPerSecond, 0.1, "a fallen body that is slower is at rest") \
  FIXED(X, UNIFORM, _, restRate, radiansPerSecond, 1, "a fallen body that tips slower is at rest") \
  FIXED(X, UNIFORM, _, wallSlope, number, 4, "ground that rises more steeply stops a fallen body") \
  FIXED(X, UNIFORM, _, wallLeast, legLengths, 1e-3, "and rises by more than that in a tick") \
  FIXED(X, UNIFORM, _, foldTime, seconds, 0.3, "in which legs fold in a fall") \
  FIXED(X, UNIFORM, _, foldAside, number, 0.6, "where a folded foot is, level: a share of the way from root to home") \
  FIXED(X, UNIFORM, _, foldBelow, number, 0.25, "and below the root, likewise") \
  FIXED(X, UNIFORM, _, jerkPath, legLengths, 0.05, "a window with a shorter path does not count")

// Given by the rig, the terrain, the herd and the tick: GIVEN(X, place, number, name, what)
#define SKITTER_GIVEN(GIVEN, X) \
  GIVEN(X, UNIFORM, _, dt, "seconds a tick") \
  GIVEN(X, KNOWN, 0, legLength, "L") \
  GIVEN(X, UNIFORM, _, homeRadius, "largest horizontal distance of a home from the body's origin") \
  GIVEN(X, KNOWN, 1, bodyHeight, "centre of the body above the ground at rest") \
  GIVEN(X, KNOWN, 2, bodyRadius, "half the body's length") \
  GIVEN(X, UNIFORM, _, halfExtentX, "of the terrain") \
  GIVEN(X, UNIFORM, _, halfExtentZ, "of the terrain") \
  GIVEN(X, UNIFORM, _, reachTriggered, "1: legs step when they are out of comfort, without a rhythm") \
  GIVEN(X, UNIFORM, _, nearestOnly, "1: the dissertation's rule, the foothold nearest to the target wins") \
  GIVEN(X, UNIFORM, _, heightBlend, "1 - exp(-dt / heightTime)") \
  GIVEN(X, UNIFORM, _, tiltBlend, "1 - exp(-dt / tiltTime)") \
  GIVEN(X, UNIFORM, _, clipFade, "a tick's share of a cross-fade") \
  GIVEN(X, UNIFORM, _, plantKeep, "share of an unlocked foot's offset that is left after a tick") \
  GIVEN(X, UNIFORM, _, jerkTicks, "ticks a window of normalised jerk")

// Derived for the shaders; the reference works these out in its own way: DERIVED(X, place, number, name, what)
#define SKITTER_DERIVED(DERIVED, X) \
  DERIVED(X, UNIFORM, _, originX, "world x of column 0") \
  DERIVED(X, UNIFORM, _, originZ, "world z of row 0") \
  DERIVED(X, UNIFORM, _, inverseSpacingX, "samples a metre") \
  DERIVED(X, UNIFORM, _, inverseSpacingZ, "samples a metre") \
  DERIVED(X, UNIFORM, _, poseKeys, "K of controller key-poses") \
  DERIVED(X, UNIFORM, _, poseStride, "metres a cycle") \
  DERIVED(X, UNIFORM, _, springKeep, "E of one tick: x of x") \
  DERIVED(X, UNIFORM, _, springDrift, "x of V, s") \
  DERIVED(X, UNIFORM, _, springPull, "V of x, 1/s") \
  DERIVED(X, UNIFORM, _, springCarry, "V of V")
// clang-format on

// KNOWN_PARAMETERS(X): X(number, name) for each specialisation constant.
#define SKITTER_IF_KNOWN_KNOWN(X, number, name) X(number, name)
#define SKITTER_IF_KNOWN_UNIFORM(X, number, name)
#define SKITTER_IF_KNOWN_HOST(X, number, name)
#define SKITTER_IF_KNOWN_TUNED(X, place, number, stage, name, unit, usual, least, most, does, breaks) \
  SKITTER_IF_KNOWN_##place(X, number, name)
#define SKITTER_IF_KNOWN_FIXED(X, place, number, name, unit, value, why) \
  SKITTER_IF_KNOWN_##place(X, number, name)
#define SKITTER_IF_KNOWN_OTHER(X, place, number, name, what) SKITTER_IF_KNOWN_##place(X, number, name)
#define KNOWN_PARAMETERS(X)                 \
  SKITTER_GIVEN(SKITTER_IF_KNOWN_OTHER, X)  \
  SKITTER_TUNING(SKITTER_IF_KNOWN_TUNED, X) \
  SKITTER_FIXED(SKITTER_IF_KNOWN_FIXED, X)  \
  SKITTER_DERIVED(SKITTER_IF_KNOWN_OTHER, X)

// REFERENCE_PARAMETERS(X): X(name) for each parameter that the CPU reference has, too.
// PARAMETERS(X): X(name) for each one.
#define SKITTER_NAME_KNOWN(X, name) X(name)
#define SKITTER_NAME_UNIFORM(X, name) X(name)
#define SKITTER_NAME_HOST(X, name)
#define SKITTER_NAME_TUNED(X, place, number, stage, name, unit, usual, least, most, does, breaks) \
  SKITTER_NAME_##place(X, name)
#define SKITTER_NAME_FIXED(X, place, number, name, unit, value, why) SKITTER_NAME_##place(X, name)
#define SKITTER_NAME_OTHER(X, place, number, name, what) SKITTER_NAME_##place(X, name)
#define REFERENCE_PARAMETERS(X)         \
  SKITTER_GIVEN(SKITTER_NAME_OTHER, X)  \
  SKITTER_TUNING(SKITTER_NAME_TUNED, X) \
  SKITTER_FIXED(SKITTER_NAME_FIXED, X)
#define PARAMETERS(X)     \
  REFERENCE_PARAMETERS(X) \
  SKITTER_DERIVED(SKITTER_NAME_OTHER, X)

// TUNED_PARAMETERS(X), FIXED_PARAMETERS(X): X(name, unit, value) for each parameter that users set, with its
// default, and for each fixed one.
#define SKITTER_VALUE_KNOWN(X, name, unit, value) X(name, unit, value)
#define SKITTER_VALUE_UNIFORM(X, name, unit, value) X(name, unit, value)
#define SKITTER_VALUE_HOST(X, name, unit, value)
#define SKITTER_VALUE_TUNED(X, place, number, stage, name, unit, usual, least, most, does, breaks) \
  SKITTER_VALUE_##place(X, name, unit, usual)
#define SKITTER_VALUE_FIXED(X, place, number, name, unit, value, why) \
  SKITTER_VALUE_##place(X, name, unit, value)
#define TUNED_PARAMETERS(X) SKITTER_TUNING(SKITTER_VALUE_TUNED, X)
#define FIXED_PARAMETERS(X) SKITTER_FIXED(SKITTER_VALUE_FIXED, X)

struct Parameters {
#define DECLARE_PARAMETER(name) float name;
  PARAMETERS(DECLARE_PARAMETER)
#undef DECLARE_PARAMETER
};

#ifdef __cplusplus
}  // namespace skitter::shared
#endif
#endif
