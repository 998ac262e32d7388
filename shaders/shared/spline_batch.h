// The batch of splines (docs/spline.md), as GLSL and C++ both see it: rules, bindings of set 0,
// specialization and push constants. Every buffer is an array of vec4.
#ifndef SKITTER_SPLINE_BATCH_H
#define SKITTER_SPLINE_BATCH_H

#ifdef __cplusplus
namespace skitter::shared {
#define SPLINE inline constexpr
#else
#define SPLINE const
#endif

// In the order of SplineRule.
SPLINE int RULE_GIVEN = 0;
SPLINE int RULE_CATMULL_ROM = 1;
SPLINE int RULE_FINITE_DIFFERENCE = 2;
SPLINE int RULE_CARDINAL = 3;
SPLINE int RULE_KOCHANEK_BARTELS = 4;
SPLINE int RULE_MONOTONE = 5;
SPLINE int RULE_ZERO = 6;

// In the order of SplineState.
SPLINE float STATE_IDLE = 0.0;
SPLINE float STATE_MOVING = 1.0;
SPLINE float STATE_FINISHED = 2.0;
SPLINE float STATE_REFUSED = 3.0;

SPLINE int SPLINE_KEY = 0;      // a key: point, knot
SPLINE int SPLINE_GIVEN = 1;    // two a key: tangent arriving, leaving
SPLINE int SPLINE_TANGENT = 2;  // as given; w of the arriving one: 1 if the key may not be
SPLINE int SPLINE_TANGENT_OUT = 3;
SPLINE int SPLINE_LENGTH = 4;  // a key: arc length from the first
SPLINE int SPLINE_LENGTH_OUT = 5;
SPLINE int SPLINE_CLOCK = 6;       // start, the rest of start, duration, active
SPLINE int SPLINE_MOTION_OUT = 7;  // position, length travelled; velocity, state
SPLINE int SPLINE_SUMMARY = 8;     // length, first knot, last knot - first, 1 if the spline is refused
SPLINE int SPLINE_SUMMARY_OUT = 9;

SPLINE int CONSTANT_KEYS = 0;
SPLINE int CONSTANT_CLOSED = 1;
SPLINE int CONSTANT_RULE = 2;
SPLINE int CONSTANT_ARC_LENGTH = 3;
SPLINE int CONSTANT_CONSTANT_SPEED = 4;

SPLINE int TANGENT_STRIDE = 2;  // a key
SPLINE int MOTION_STRIDE = 2;   // a spline

// What a spline may hold.
SPLINE float LARGEST_COORDINATE = 1e6;
SPLINE float LARGEST_TANGENT = 1e12;
SPLINE float LEAST_STEP = 1e-6;
SPLINE float LARGEST_LENGTH = 1e18;  // of all of it: what float32 can square and sum

// Push constants of every entry point.
struct SplineConstants {
#ifdef __cplusplus
  uint32_t count;  // splines of the page
#else
  uint count;
#endif
  float now, nowRest;
  float tension, continuity, bias;
};

#ifdef __cplusplus
}  // namespace skitter::shared
#endif
#endif
