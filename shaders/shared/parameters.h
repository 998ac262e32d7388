// Tuning values of one herd, a uniform block to GLSL (std140: scalars only, so both layouts are the same) and
// a struct to C++. Lengths are metres, already scaled by the rig's leg length; docs/stages.md states each
// use.
#ifndef SKITTER_PARAMETERS_H
#define SKITTER_PARAMETERS_H

#ifdef __cplusplus
namespace skitter::shared {
#endif

struct Parameters {
  float dt;          // seconds a tick
  float legLength;   // L
  float homeRadius;  // largest horizontal distance of a home from the body's origin
  float bodyHeight;  // centre of the body above the ground at rest
  float bodyRadius;  // half the body's length
  // terrain
  float originX;          // world x of column 0
  float originZ;          // world z of row 0
  float inverseSpacingX;  // samples a metre
  float inverseSpacingZ;
  float halfExtentX;
  float halfExtentZ;
  // navigate
  float edgeMargin;  // agents turn back this far inside the terrain's edge
  float slowRadius;  // a point goal is approached more slowly from here
  // body
  float acceleration;      // m/s^2
  float braking;           // m/s^2
  float turnRate;          // rad/s
  float turnAcceleration;  // rad/s^2
  float turnGain;          // 1/s, turn rate per radian of heading error
  float stretchSlow;       // share of the reach at which a planted leg begins to slow the body
  float stretchStop;       // share of the reach at which it stops the body
  float errorStop;         // share of the reach: a planted foot that misses by this much stops the body
  float followLeast;  // least follow factor: a body that waits for its feet still creeps, or it could wait
                      // for ever
  float heightBlend;  // 1 - exp(-dt / time constant)
  float tiltBlend;
  float maxSlope;        // tangent of the steepest tilt
  float bellyClearance;  // least height of the body's centre above the ground
  float ridge;           // regularisation of the plane fit, m^2
  float leanGain;        // s^2/m, tangent of the lean into a turn for each m/s^2 toward its middle
  float leanMost;        // its largest tangent
  float leanLevel;       // share of the ground's slope by which the body keeps itself more level
  float breathHeight;    // by which a resting body rises and sinks
  // gait
  float halfStrideStill;  // least half stride: what lifting is judged by at rest
  float halfStrideMax;
  float dutyStill;  // stance share of a cycle at rest
  float dutyGain;   // s/m, by how much it falls with speed
  float dutyLeast;
  float lagShare;  // the last leg of a group lifts this share of (1 / groups - swing / cycle) after the first
  float swingStill;       // T0, seconds
  float swingSpeed;       // v0, m/s: swing time halves at this speed
  float cycleMax;         // seconds
  float windowSlack;      // a cycle is at least groups * swing * windowSlack
  float windowOpen;       // share of a group's window in which its legs may lift
  float liftShare;        // of the half stride, distance from home that lifts a foot
  float stretchLift;      // share of the reach beyond which a foot must lift
  float strayShare;       // of the half stride, distance from home beyond which a foot must lift
  float errorLift;        // share of the reach: a planted foot that misses by more must lift
  float rootShare;        // share of the reach below which a foot is too close to its root
  float settleTime;       // seconds of standing after which nobody steps
  float sleepTime;        // seconds of standing after which an agent may sleep
  float reaimDistance;    // a landing point further than this from the prediction is chosen anew
  float reaimLatest;      // progress after which it is kept
  float groundTolerance;  // ground that moves by more under a foot makes it step anew
  float reachTriggered;   // 1: legs step when they are out of comfort, without a rhythm
  // foothold
  float reachMost;  // landing points stay within this share of the reach
  float reachLeast;
  float reachComfort;  // share of the reach from which a landing point costs
  float slopeLeast;    // least cosine between ground normal and body up
  float slopeWeight;
  float reachWeight;
  float nearestOnly;  // 1: the dissertation's rule, nearest to the target wins
  // swing
  float stepHeight;
  float stepClearance;
  float stepHeightMax;
  float routeWidth;  // between the lanes of a step's way, at its middle
  // clip
  float clipFade;        // a tick's share of a cross-fade
  float clipIdle;        // m/s below which a standing clip is played
  float clipHysteresis;  // octaves of speed by which another clip must be nearer
  float clipRateMost;
  float plantStray;  // m that a locked foot may be from where the clip wants it
  float plantKeep;   // share of an unlocked foot's offset that is left after a tick
  // controller pose
  float poseKeys;         // K
  float poseStride;       // metres a cycle
  float poseWalk;         // m/s from which the key poses are reached in full
  float springFrequency;  // omega_s, rad/s
  float springDamping;    // zeta; 1: critical
  float springKeep;       // E of one tick: x of x
  float springDrift;      // x of V, s
  float springPull;       // V of x, 1/s
  float springCarry;      // V of V
  // ik
  float approachError;  // share of the reach, at most a half, beyond which the approach iterates
  float restPull;       // share of the angle from rest taken back a step once on target
  float pullError;      // share of the reach below which the rest pull acts
  float ikTolerance;    // share of the reach that counts as arrived
  float missLeast;  // share of the reach; body and gait are not told of a planted foot that misses by less
  // measure
  float deadZone;       // depth or height of a foot that may count as touching
  float skateSpeed;     // m/s, horizontal, above which a planted foot skates
  float limitDeadZone;  // radians beyond a limit that do not count
  float jerkTicks;      // ticks a window of normalised jerk
  float jerkPath;       // a window with a shorter path does not count
};

// Those of a rig and its controller, which stay as they are while a crowd lives: X(number, name). Pipelines
// are specialised by them, for a uniform costs a software device some instructions. The others follow the
// tick's length, the terrain or an experiment.
// clang-format off
#define KNOWN_PARAMETERS(X) \
  X(0, legLength) X(1, bodyHeight) X(2, bodyRadius) X(3, slowRadius) X(4, acceleration) \
  X(5, braking) X(6, turnRate) X(7, turnAcceleration) X(8, turnGain) X(9, stretchSlow) \
  X(10, stretchStop) X(11, errorStop) X(12, followLeast) X(13, maxSlope) X(14, bellyClearance) \
  X(15, ridge) X(16, leanGain) X(17, leanMost) X(18, leanLevel) X(19, breathHeight) \
  X(20, halfStrideStill) X(21, halfStrideMax) X(22, dutyStill) X(23, dutyGain) X(24, dutyLeast) \
  X(25, lagShare) X(26, swingStill) X(27, swingSpeed) X(28, cycleMax) X(29, windowSlack) \
  X(30, windowOpen) X(31, liftShare) X(32, stretchLift) X(33, strayShare) X(34, errorLift) \
  X(35, rootShare) X(36, settleTime) X(37, reaimDistance) X(38, reaimLatest) X(39, groundTolerance) \
  X(40, reachMost) X(41, reachLeast) X(42, reachComfort) X(43, slopeLeast) X(44, slopeWeight) \
  X(45, reachWeight) X(46, stepHeight) X(47, stepClearance) X(48, stepHeightMax) X(49, routeWidth) \
  X(50, approachError) X(51, restPull) X(52, pullError) X(53, ikTolerance) X(54, missLeast)
// clang-format on

#ifdef __cplusplus
}  // namespace skitter::shared
#endif
#endif
