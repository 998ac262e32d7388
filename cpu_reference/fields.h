#pragma once

// The fields of the records that stages exchange, once: FIELD(type, name, initial, place, roundings).
//   type       of the reference's member; it says how many floats of the record there are
//   initial    the member's value in a record that no stage has written
//   place      its first float in the record (include/skitter/records.h)
//   roundings  how far replay lets the engine be off, in units of `roundoff` of the value: as often as a
//              float rounds on the way from other records, 0 where it must be the same; `own` where the
//              check of its stage knows a tolerance
// The members of types.h, the conversion from and to records, the comparison, the rows of the opponent
// (bench/cpu_crowd) and a test that replay finds each of them wrong follow. What a record packs (a tile,
// ticks, a kind) is not listed. Metres, seconds, radians.
namespace skitter::reference {
inline constexpr int own = -1;
}
// clang-format off
#define SKITTER_GOAL_FIELDS(FIELD) \
  /* World x, z; of kind velocity the target is the desired velocity; of kind series the other end is the \
     number of the place and the draw. */ \
  FIELD(glm::dvec2, target,            glm::dvec2(0),          0,  0) \
  FIELD(glm::dvec2, otherEnd,          glm::dvec2(0),          2,  0) \
  FIELD(double,     speed,             0,                      4,  0) \
  FIELD(double,     arrivalRadius,     0,                      5,  0)

#define SKITTER_BODY_FIELDS(FIELD) \
  FIELD(double,     localX,            0,                      0,  own) \
  FIELD(double,     y,                 0,                      1,  own) \
  FIELD(double,     localZ,            0,                      2,  own) \
  FIELD(glm::dvec2, heading,           glm::dvec2(0, 1),       4,  own)  /* x, z */ \
  FIELD(double,     speed,             0,                      6,  own)  /* m/s along the heading, level */ \
  FIELD(glm::dquat, orientation,       glm::dquat(1, 0, 0, 0), 8,  own) \
  FIELD(double,     turnRate,          0,                      12, own)  /* omega */ \
  FIELD(double,     still,             0,                      13, own)  /* s */ \
  FIELD(double,     follow,            1,                      14, own)  /* follow factor */ \
  FIELD(double,     surfaceSpeed,      0,                      15, own)  /* m/s along the ground */

#define SKITTER_GAIT_FIELDS(FIELD) \
  FIELD(double,     phase,             0,                      0,  own) \
  FIELD(uint32_t,   lift,              0,                      1,  own)  /* bit l: leg l */ \
  FIELD(uint32_t,   reaim,             0,                      2,  own) \
  FIELD(double,     duration,          0,                      3,  0)    /* ticks that a new step lasts */ \
  FIELD(double,     halfStride,        0,                      4,  own) \
  FIELD(double,     cycle,             0,                      5,  own) \
  FIELD(uint32_t,   air,               0,                      6,  0)    /* in the air before any lifts */

#define SKITTER_REACTION_FIELDS(FIELD) \
  FIELD(double,     clock,             0,                      1,  own)  /* s in its phase */ \
  FIELD(double,     disturbed,         0,                      2,  own)  /* s for which a fall may begin */ \
  FIELD(double,     over,              0,                      3,  own)  /* s out of reach; fallen: 1 on the ground */ \
  FIELD(glm::dvec2, velocity,          glm::dvec2(0),          4,  own)  /* v */ \
  FIELD(double,     sink,              0,                      6,  own)  /* w, upward */ \
  FIELD(double,     drop,              0,                      7,  own) \
  FIELD(glm::dvec2, way,               glm::dvec2(0),          8,  own)  /* f */ \
  FIELD(double,     tilt,              0,                      10, own)  /* theta */ \
  FIELD(double,     tiltRate,          0,                      11, own) \
  FIELD(glm::dvec3, ground,            glm::dvec3(0),          12, own)  /* n */ \
  FIELD(double,     fold,              0,                      15, own) \
  FIELD(double,     falls,             0,                      16, 0) \
  FIELD(double,     stands,            0,                      17, 0) \
  FIELD(double,     down,              0,                      18, own)  /* s since this fall began */ \
  FIELD(double,     downBefore,        0,                      19, own)  /* s of those before */

#define SKITTER_SEARCH_FIELDS(FIELD) \
  FIELD(uint32_t,   idle,              0,                      0,  0)    /* legs that it has noticed */ \
  FIELD(uint32_t,   lame,              0,                      1,  0) \
  FIELD(uint32_t,   candidate,         0,                      4,  0)    /* c */ \
  FIELD(double,     clock,             0,                      5,  own)  /* tau */ \
  FIELD(uint32_t,   bestCandidate,     0,                      6,  0) \
  FIELD(double,     bestFitness,       0,                      7,  0) \
  FIELD(double,     wanted,            0,                      8,  own)  /* m */ \
  FIELD(double,     progress,          0,                      9,  own)  /* m */ \
  FIELD(double,     unstable,          0,                      10, own)  /* s */

/* Positions are local to the tile in x and z, world in y. */
#define SKITTER_STEP_FIELDS(FIELD) \
  FIELD(glm::dvec3, landing,           glm::dvec3(0),          0,  own) \
  FIELD(double,     firstTick,         0,                      3,  0) \
  FIELD(glm::dvec3, liftOff,           glm::dvec3(0),          4,  own)
#define SKITTER_ARC_FIELDS(FIELD) \
  FIELD(glm::dvec3, lift,              glm::dvec3(0),          0,  own) \
  FIELD(glm::dvec3, startTangent,      glm::dvec3(0),          4,  own)

#define SKITTER_FOOT_FIELDS(FIELD) \
  FIELD(glm::dvec3, target,            glm::dvec3(0),          0,  own)  /* relative */ \
  FIELD(double,     progress,          1,                      3,  own)

/* No two solves need end alike, so ik has no fields that must be the same. */
#define SKITTER_TIP_FIELDS(FIELD) \
  FIELD(glm::dvec3, tip,               glm::dvec3(0),          0,  own)  /* relative */ \
  FIELD(double,     reachError,        0,                      3,  own)

/* Of an entry. */
#define SKITTER_POSE_FIELDS(FIELD) \
  FIELD(glm::dquat, rotation,          glm::dquat(1, 0, 0, 0), 0,  own)  /* world from rest */ \
  FIELD(glm::dvec3, position,          glm::dvec3(0),          4,  own)  /* relative */

/* Sums over the ticks in which an agent was watched. */
#define SKITTER_METRIC_FIELDS(FIELD) \
  FIELD(double,     ticks,             0,                      0,  own) \
  FIELD(double,     planted,           0,                      1,  own)  /* leg-ticks */ \
  FIELD(double,     stays,             0,                      2,  own)  /* of these, a tick before too */ \
  FIELD(double,     skates,            0,                      3,  own)  /* of these skating */ \
  FIELD(double,     slip,              0,                      4,  own)  /* over finished stances */ \
  FIELD(double,     stances,           0,                      5,  own) \
  FIELD(double,     largestError,      0,                      6,  own) \
  FIELD(double,     penetration,       0,                      8,  own) \
  FIELD(double,     penetrationBeyond, 0,                      9,  own) \
  FIELD(double,     floating,          0,                      10, own) \
  FIELD(double,     floatingBeyond,    0,                      11, own) \
  FIELD(double,     depth,             0,                      12, own) \
  FIELD(double,     deepest,           0,                      13, own) \
  FIELD(double,     violations,        0,                      14, own) \
  FIELD(double,     lost,              0,                      15, own)  /* leg-ticks of lost legs */ \
  FIELD(double,     pairs,             0,                      16, own) \
  FIELD(double,     crossings,         0,                      17, own) \
  FIELD(double,     supported,         0,                      18, own) \
  FIELD(double,     unstable,          0,                      19, own) \
  FIELD(double,     margin,            0,                      20, own) \
  FIELD(double,     leastMargin,       0,                      21, own) \
  FIELD(double,     footJerk,          0,                      24, own)  /* sum of W^5 Q */ \
  FIELD(double,     footPath,          0,                      25, own)  /* of P^2 */ \
  FIELD(double,     bodyJerk,          0,                      26, own) \
  FIELD(double,     bodyPath,          0,                      27, own)

/* Of watch, each of WATCH_TRAIL_STRIDE: x_(n-1), e1 and e2 of a point, and P and Q of the open window. */
#define SKITTER_TRAIL_FIELDS(FIELD) \
  FIELD(glm::dvec3, at,                glm::dvec3(0),          0,  own) \
  FIELD(glm::dvec3, first,             glm::dvec3(0),          4,  own) \
  FIELD(double,     path,              0,                      7,  own) \
  FIELD(glm::dvec3, second,            glm::dvec3(0),          8,  own) \
  FIELD(double,     jerk,              0,                      11, own)
// clang-format on
