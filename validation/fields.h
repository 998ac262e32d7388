#pragma once

// clang-format off
// The fields of records (skitter/records.h) that are plain numbers, once: FIELD(name, first float of the
// record), under the names of the reference, whose types say how many floats follow. The conversion from and
// to the reference follows (convert.cpp), and so do the tests that replay finds each of them wrong. What a
// record packs (a tile, ticks, a kind) is not listed.
#define SKITTER_GOAL_FIELDS(FIELD) \
  FIELD(target, 0) FIELD(otherEnd, 2) FIELD(speed, 4) FIELD(arrivalRadius, 5)
#define SKITTER_BODY_FIELDS(FIELD) \
  FIELD(localX, 0) FIELD(y, 1) FIELD(localZ, 2) FIELD(heading, 4) FIELD(speed, 6) FIELD(orientation, 8) \
  FIELD(turnRate, 12) FIELD(still, 13) FIELD(follow, 14) FIELD(surfaceSpeed, 15)
#define SKITTER_GAIT_FIELDS(FIELD) \
  FIELD(phase, 0) FIELD(lift, 1) FIELD(reaim, 2) FIELD(duration, 3) FIELD(halfStride, 4) FIELD(cycle, 5) \
  FIELD(air, 6)
#define SKITTER_STEP_FIELDS(FIELD) FIELD(landing, 0) FIELD(firstTick, 3) FIELD(liftOff, 4)
#define SKITTER_ARC_FIELDS(FIELD) FIELD(lift, 0) FIELD(startTangent, 4)
#define SKITTER_FOOT_FIELDS(FIELD) FIELD(target, 0) FIELD(progress, 3)
#define SKITTER_TIP_FIELDS(FIELD) FIELD(tip, 0) FIELD(reachError, 3)
#define SKITTER_POSE_FIELDS(FIELD) /* of an entry */ FIELD(rotation, 0) FIELD(position, 4)
#define SKITTER_METRIC_FIELDS(FIELD) \
  FIELD(ticks, 0) FIELD(planted, 1) FIELD(stays, 2) FIELD(skates, 3) FIELD(slip, 4) FIELD(stances, 5) \
  FIELD(largestError, 6) FIELD(penetration, 8) FIELD(penetrationBeyond, 9) FIELD(floating, 10) \
  FIELD(floatingBeyond, 11) FIELD(depth, 12) FIELD(deepest, 13) FIELD(violations, 14) FIELD(pairs, 16) \
  FIELD(crossings, 17) FIELD(supported, 18) FIELD(unstable, 19) FIELD(margin, 20) FIELD(leastMargin, 21) \
  FIELD(footJerk, 24) FIELD(footPath, 25) FIELD(bodyJerk, 26) FIELD(bodyPath, 27)
#define SKITTER_TRAIL_FIELDS(FIELD) /* of watch, each of WATCH_TRAIL_STRIDE */ \
  FIELD(at, 0) FIELD(first, 4) FIELD(path, 7) FIELD(second, 8) FIELD(jerk, 11)
// clang-format on
