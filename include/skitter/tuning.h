// The tuning of a herd: how its creatures move. SKITTER_TUNING declares each parameter once. The struct, its
// ranges, the shaders' constants, the keys of scene files and the table in docs/tuning.md follow from it.
#ifndef SKITTER_TUNING_H
#define SKITTER_TUNING_H

// ROW(X, place, number, stage, name, unit, usual, least, most, does, breaks)
//   X       is passed on to every ROW.
//   place   says where shaders find the parameter. KNOWN: specialisation constant `number`, since a uniform
//           costs a software device instructions. UNIFORM: the uniform block. HOST: nowhere; the host makes
//           another parameter of it.
//   stage   the stage that uses it.
//   unit    a TuningUnit.
//   usual, least, most   the default and the range. `skitter validate` passes at both ends.
//   breaks  the reason for the range: the fault that shows toward each end.
// clang-format off
#define SKITTER_TUNING(ROW, X) \
  ROW(X, UNIFORM, _, navigate, edgeMargin, legLengths, 2, 0.5, 100, \
      "distance from the terrain's edge at which agents turn back; a fifth of the terrain's shorter side at most", \
      "less: feet step where the ground ends") \
  ROW(X, KNOWN, 3, navigate, slowRadius, legLengths, 1, 0.2, 100, \
      "distance from a point goal at which an agent begins to slow down", \
      "less: it stops in one jerk") \
  ROW(X, KNOWN, 4, body, acceleration, legLengthsPerSecond2, 2.5, 0.1, 20, \
      "largest rise of the speed", \
      "more: the feet are left behind at the start") \
  ROW(X, KNOWN, 5, body, braking, legLengthsPerSecond2, 6, 1, 40, \
      "largest fall of the speed", \
      "less: stretched legs are pulled off the ground") \
  ROW(X, KNOWN, 6, body, turnRate, radiansPerSecond, 1.5, 0.1, 4, \
      "fastest turn", \
      "more: the outer feet cross before their group may step") \
  ROW(X, KNOWN, 7, body, turnAcceleration, radiansPerSecond2, 8, 0.5, 50, \
      "largest change of the turn rate", \
      "less: an agent swings past its heading and back") \
  ROW(X, KNOWN, 8, body, turnGain, perSecond, 4, 0.5, 15, \
      "turn rate for each radian of heading error", \
      "more: the heading trembles about its goal") \
  ROW(X, KNOWN, 9, body, stretchSlow, reaches, 0.93, 0.5, 1, \
      "stretch at which a planted leg begins to slow the body", \
      "less: the body creeps; more: it stops in one jerk") \
  ROW(X, KNOWN, 10, body, stretchStop, reaches, 1, 0.6, 1.05, \
      "stretch at which a planted leg stops the body", \
      "less: the body hardly moves; more: a planted foot is torn off the ground") \
  ROW(X, KNOWN, 11, body, errorStop, reaches, 0.02, 0.002, 1, \
      "miss of a planted foot that stops the body", \
      "more: feet slide") \
  ROW(X, KNOWN, 12, body, followLeast, number, 0.1, 0.01, 1, \
      "share of its speed that a body keeps while it waits for its feet", \
      "less: a body whose feet find no hold stands before a wall for ever; more: it does not wait, and feet slide") \
  ROW(X, HOST, _, body, heightTime, seconds, 0.1, 0.02, 2, \
      "time in which the body's height follows the ground", \
      "less: it bounces over every foothold; more: it lags in dips") \
  ROW(X, HOST, _, body, tiltTime, seconds, 0.15, 0.02, 2, \
      "time in which the body's tilt follows the ground", \
      "less: it shakes; more: legs stretch where the slope changes") \
  ROW(X, KNOWN, 13, body, maxSlope, number, 2.75, 0.1, 2.75, \
      "tangent of the steepest tilt; on ground over a quarter steeper a body goes along the slope only", \
      "less: legs on the low side stretch on steep ground; more: the up axis is lost") \
  ROW(X, KNOWN, 14, body, bellyClearance, bodyHeights, 0.6, 0, 1.5, \
      "least height of the body's middle line above the ground", \
      "less: the belly sinks into rocks; more: the legs lift the body off its feet") \
  ROW(X, KNOWN, 16, body, leanGain, seconds2PerLegLength, 0.06, 0, 0.2, \
      "tangent of the lean into a turn for each unit of acceleration toward its middle; a pendulum leans by 0.1", \
      "more: the body tips in every turn") \
  ROW(X, KNOWN, 17, body, leanMost, number, 0.12, 0, 0.4, \
      "largest tangent of the lean", \
      "more: legs outside the turn stretch") \
  ROW(X, KNOWN, 18, body, leanLevel, number, 0.08, 0, 1, \
      "share of the ground's slope by which the body stays more level", \
      "more: legs on the low side stretch on steep ground") \
  ROW(X, KNOWN, 19, body, breathHeight, legLengths, 0.012, 0, 0.1, \
      "rise and fall of a resting body", \
      "more: the legs pump") \
  ROW(X, KNOWN, 20, gait, halfStrideStill, legLengths, 0.08, 0.02, 0.5, \
      "half of the stride at rest", \
      "less: feet fidget") \
  ROW(X, KNOWN, 21, gait, halfStrideMax, legLengths, 0.3, 0.04, 0.5, \
      "half of the longest stride", \
      "more: the legs at the sides leave their reach") \
  ROW(X, KNOWN, 22, gait, dutyStill, number, 0.75, 0.5, 0.85, \
      "share of a cycle in which a foot stands, at rest", \
      "less: neighbours have no time to take turns; more: the body is faster than its feet, and legs cross") \
  ROW(X, KNOWN, 23, gait, dutyGain, secondsPerLegLength, 0.05, 0, 1, \
      "fall of that share with speed", \
      "more: a walk looks like a run") \
  ROW(X, KNOWN, 24, gait, dutyLeast, number, 0.55, 0.5, 0.85, \
      "least share of a cycle in which a foot stands", \
      "less: neighbours have no time to take turns; more: the body is faster than its feet, and legs cross") \
  ROW(X, KNOWN, 25, gait, lagShare, number, 1.2, 0, 1.5, \
      "how far the lifts of a group spread; at 1, the last leg lands as the next group lifts", \
      "more: neighbours wait for each other") \
  ROW(X, KNOWN, 26, gait, swingStill, seconds, 0.35, 0.05, 1, \
      "time of a step at rest", \
      "less: feet flick; more: the body outruns its feet, whose targets leave their reach") \
  ROW(X, KNOWN, 27, gait, swingSpeed, legLengthsPerSecond, 1.7, 0.2, 100, \
      "speed at which a step takes half of that time", \
      "less: feet flick; more: the body outruns its feet") \
  ROW(X, KNOWN, 28, gait, cycleMax, seconds, 1.2, 0.1, 5, \
      "longest cycle", \
      "more: a standing leg reacts too late to a start") \
  ROW(X, KNOWN, 29, gait, windowSlack, number, 1.1, 1, 2, \
      "least time between the lifts of two groups, in steps", \
      "less: the landing of a leg delays its neighbours; more: the body outruns its feet") \
  ROW(X, KNOWN, 30, gait, windowOpen, number, 0.5, 0.1, 1, \
      "share of a group's turn in which its legs may lift", \
      "less: legs miss their turn; more: late lifts disturb the rhythm") \
  ROW(X, KNOWN, 31, gait, liftShare, halfStrides, 0.35, 0.05, 0.8, \
      "distance of a foot from home at which it wants to lift", \
      "less: feet fidget at low speed; more: legs lift too late, and feet slide") \
  ROW(X, KNOWN, 32, gait, stretchLift, reaches, 0.95, 0.6, 1, \
      "stretch beyond which a foot must lift", \
      "less: legs on steep ground never rest") \
  ROW(X, KNOWN, 33, gait, strayShare, halfStrides, 1.8, 1, 5, \
      "distance of a foot from home beyond which it must lift", \
      "less: a steady walk trips over it") \
  ROW(X, KNOWN, 34, gait, errorLift, reaches, 0.001, 0.0005, 1, \
      "miss of a planted foot beyond which it must lift", \
      "less: legs lift for rounding; more: feet slide") \
  ROW(X, KNOWN, 35, gait, rootShare, reaches, 0.25, 0, 0.5, \
      "distance of a foot from its leg's root below which it must lift", \
      "more: short steps are lifted at once") \
  ROW(X, KNOWN, 36, gait, settleTime, seconds, 1, 0.1, 60, \
      "standing time after which no leg steps", \
      "less: feet stay where they stopped") \
  ROW(X, UNIFORM, _, navigate, sleepTime, seconds, 2, 0.1, 600, \
      "standing time after which an agent may sleep", \
      "less: joints freeze before they are at rest") \
  ROW(X, KNOWN, 37, gait, reaimDistance, legLengths, 0.15, 0.02, 2, \
      "distance of a landing point from where it should be at which it is chosen anew", \
      "less: steps are aimed anew for nothing; more: feet land behind in a turn") \
  ROW(X, KNOWN, 38, gait, reaimLatest, number, 0.7, 0, 0.95, \
      "progress of a step after which its landing point stays", \
      "more: feet jump at the end of a step") \
  ROW(X, KNOWN, 39, gait, groundTolerance, legLengths, 0.02, 0.005, 0.5, \
      "movement of the ground under a foot that makes it step", \
      "less: rounding of heights far from 0 lifts feet; more: feet hang in the air after an edit") \
  ROW(X, KNOWN, 40, foothold, reachMost, reaches, 0.95, 0.6, 0.98, \
      "longest distance of a foothold from the leg's root", \
      "less: steps are short, and legs cross; more: the solver converges slowly, and feet miss") \
  ROW(X, KNOWN, 41, foothold, reachLeast, reaches, 0.3, 0.1, 0.6, \
      "shortest distance of a foothold from the leg's root", \
      "less: legs fold beyond their limits; more: no foothold fits, and feet miss the ground") \
  ROW(X, KNOWN, 42, foothold, reachComfort, reaches, 0.85, 0.5, 1, \
      "distance from which a foothold costs", \
      "less: steps are short, and legs cross") \
  ROW(X, KNOWN, 43, foothold, slopeLeast, number, 0.35, 0, 0.9, \
      "least cosine between a foothold's normal and the body's up axis", \
      "less: feet stand on walls; more: no foothold fits on rough ground") \
  ROW(X, KNOWN, 44, foothold, slopeWeight, number, 0.05, 0, 2, \
      "cost of a slope under a foot", \
      "more: feet leave their places for flat ground") \
  ROW(X, KNOWN, 45, foothold, reachWeight, number, 4, 0, 50, \
      "cost of a foothold beyond reachComfort", \
      "less: legs stretch") \
  ROW(X, KNOWN, 46, swing, stepHeight, legLengths, 0.12, 0.01, 1, \
      "how high a step lifts the foot on flat ground", \
      "more: knees leave their limits, and feet miss their arcs") \
  ROW(X, KNOWN, 47, swing, stepClearance, legLengths, 0.03, 0, 0.3, \
      "clearance of a step over what lies between", \
      "less: feet graze rocks; more: they rise over pebbles") \
  ROW(X, KNOWN, 48, swing, stepHeightMax, legLengths, 0.5, 0.05, 1, \
      "greatest lift of a step", \
      "less: feet go through rocks; more: knees leave their limits") \
  ROW(X, KNOWN, 49, swing, routeWidth, legLengths, 0.08, 0, 0.2, \
      "distance between the five lanes that a step may take round an obstacle", \
      "more: a leg swings through its neighbours") \
  ROW(X, KNOWN, 51, ik, restPull, number, 0.05, 0, 0.3, \
      "share of their way back to rest that joints go in a tick", \
      "more: it fights the target near the limits") \
  ROW(X, HOST, _, clip, fadeTime, seconds, 0.25, 0.02, 5, \
      "time in which one clip fades into the next", \
      "less: poses jump; more: feet slide") \
  ROW(X, UNIFORM, _, clip, clipIdle, legLengthsPerSecond, 0.05, 0.001, 1, \
      "speed below which a standing clip plays", \
      "more: a walk slides") \
  ROW(X, UNIFORM, _, clip, clipHysteresis, octaves, 0.25, 0, 4, \
      "advantage that another clip's speed must have", \
      "less: clips alternate; more: a run plays a walk") \
  ROW(X, UNIFORM, _, clip, clipRateMost, number, 2.5, 0.25, 10, \
      "fastest playback", \
      "less: feet slide at high speed; more: legs blur") \
  ROW(X, UNIFORM, _, planted, plantStray, legLengths, 0.35, 0.02, 1, \
      "distance that a planted foot may be from where the clip wants it", \
      "less: feet slide; more: legs are dragged") \
  ROW(X, HOST, _, planted, plantTime, seconds, 0.08, 0.01, 1, \
      "time in which a lifted foot returns to its clip", \
      "less: it snaps; more: it lands off the clip's place") \
  ROW(X, UNIFORM, _, key-poses, poseWalk, legLengthsPerSecond, 0.1, 0.01, 5, \
      "speed from which the key poses are reached in full", \
      "more: the first steps are too short") \
  ROW(X, UNIFORM, _, key-poses, springFrequency, radiansPerSecond, 45, 5, 200, \
      "speed of the springs of the joints", \
      "less: poses soften; more: the keys show") \
  ROW(X, UNIFORM, _, key-poses, springDamping, number, 0.70710678, 0.1, 0.95, \
      "damping of the springs; 1 is critical", \
      "less: joints swing past their poses") \
  ROW(X, UNIFORM, _, react, fallTime, seconds, 0.1, 0.02, 1, \
      "time for which no leg reaches the capture point before a fall begins", \
      "less: a leg that lands a moment later does not count; more: the body glides before it falls") \
  ROW(X, UNIFORM, _, react, slideFriction, number, 0.6, 0.1, 2, \
      "friction of a fallen body on the ground, a share of its weight", \
      "less: it slides down every slope, and does not come to rest; more: it stops in one jerk") \
  ROW(X, UNIFORM, _, react, lieTime, seconds, 0.5, 0, 60, \
      "time for which a fallen body lies at rest before it rises", \
      "less: it bounces up; more: it lies as if dead") \
  ROW(X, UNIFORM, _, react, riseTime, seconds, 0.5, 0.1, 5, \
      "time in which the body rises once its feet stand", \
      "less: it jumps up; more: it walks on its belly")

// Pairs in order. ROW(X, less, more, apart, why): `more` must exceed `less` by at least `apart`.
#define SKITTER_TUNING_ORDER(ROW, X) \
  ROW(X, stretchSlow, stretchStop, 0.02, "the body slows down between them") \
  ROW(X, halfStrideStill, halfStrideMax, 0, "a stride lies between them") \
  ROW(X, dutyLeast, dutyStill, 0, "the share of a cycle in which a foot stands lies between them") \
  ROW(X, liftShare, strayShare, 0, "a foot wants to lift before it must") \
  ROW(X, rootShare, reachLeast, 0, "a foot must not lift from where it may land") \
  ROW(X, reachLeast, reachMost, 0.1, "footholds lie between them") \
  ROW(X, settleTime, sleepTime, 0, "a sleeper does not step") \
  ROW(X, stepHeight, stepHeightMax, 0, "the lift of a step lies between them")
// clang-format on

#ifdef __cplusplus
#include <array>
#include <string>

#include "skitter/export.h"

namespace skitter {

// A herd's tuning in units that do not depend on its size.
struct Tuning {
#define SKITTER_MEMBER(X, place, number, stage, name, unit, usual, least, most, does, breaks) \
  float name = static_cast<float>(usual);
  SKITTER_TUNING(SKITTER_MEMBER, _)
#undef SKITTER_MEMBER
  bool operator==(const Tuning&) const = default;
};

enum class TuningUnit {
  number,  // without a unit
  legLengths,
  legLengthsPerSecond,
  legLengthsPerSecond2,
  legLengths2,
  secondsPerLegLength,
  seconds2PerLegLength,
  bodyHeights,
  reaches,      // of the leg in question
  halfStrides,  // at the present speed
  octaves,
  seconds,
  perSecond,
  radians,
  radiansPerSecond,
  radiansPerSecond2,
};
constexpr const char* nameOf(TuningUnit unit) {
  constexpr std::array names = {"",
                                "leg lengths",
                                "leg lengths/s",
                                "leg lengths/s^2",
                                "leg lengths^2",
                                "s/leg length",
                                "s^2/leg length",
                                "body heights",
                                "reaches",
                                "half strides",
                                "octaves",
                                "s",
                                "1/s",
                                "rad",
                                "rad/s",
                                "rad/s^2"};
  static_assert(names.size() == static_cast<size_t>(TuningUnit::radiansPerSecond2) + 1);
  return names[static_cast<size_t>(unit)];
}

// The row of a parameter.
struct TuningInfo {
  const char* name;
  float Tuning::*member;
  const char* stage;
  TuningUnit unit;
  float usual, least, most;  // default and range
  const char* does;
  const char* breaks;
};
inline constexpr std::array allTunings = {
#define SKITTER_INFO(X, place, number, stage, name, unit, usual, least, most, does, breaks) \
  TuningInfo{#name,                                                                         \
             &Tuning::name,                                                                 \
             #stage,                                                                        \
             TuningUnit::unit,                                                              \
             static_cast<float>(usual),                                                     \
             static_cast<float>(least),                                                     \
             static_cast<float>(most),                                                      \
             does,                                                                          \
             breaks},
    SKITTER_TUNING(SKITTER_INFO, _)
#undef SKITTER_INFO
};

// Two parameters in order: `more` must exceed `less` by at least `apart`.
struct TuningOrder {
  const char* less;
  const char* more;
  float Tuning::*lessMember;
  float Tuning::*moreMember;
  float apart;
  const char* why;
};
inline constexpr std::array allTuningOrders = {
#define SKITTER_ORDER(X, less, more, apart, why) \
  TuningOrder{#less, #more, &Tuning::less, &Tuning::more, static_cast<float>(apart), why},
    SKITTER_TUNING_ORDER(SKITTER_ORDER, _)
#undef SKITTER_ORDER
};

// "0.01 to 1 leg lengths"
SKITTER_API std::string rangeOf(const TuningInfo&);
// Throws Error(input) for a value out of its range, NaN included, and for two values in the wrong order. `of`
// begins the message: "scene.json: herds[0].tuning".
SKITTER_API void checkTuning(const Tuning&, const std::string& of);

}  // namespace skitter
#endif
#endif
