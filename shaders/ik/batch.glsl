// What both entry points of the batch begin with.
#include "lib/load4.glsl"
#include "shared/bindings.h"
#include "shared/ik_batch.h"
#include "skitter/records.h"
#include "lib/math.glsl"
#include "lib/rarely.glsl"

layout(local_size_x = WORK_GROUP) in;
layout(constant_id = CONSTANT_BONES) const int BONES = 4;
layout(constant_id = CONSTANT_SOLVER) const int SOLVER = SOLVER_STRETCH_ALIGN;
layout(constant_id = CONSTANT_PREVIOUS) const bool PREVIOUS = false;
layout(constant_id = CONSTANT_BASES) const bool BASES = false;
layout(constant_id = CONSTANT_ROTATIONS) const bool ROTATIONS = false;
layout(constant_id = CONSTANT_TWISTS) const bool TWISTS = false;
layout(constant_id = CONSTANT_STRAIGHT) const bool STRAIGHT = true;
layout(constant_id = CONSTANT_POLE) const bool POLE = false;
layout(constant_id = CONSTANT_REST_LEGAL) const bool REST_LEGAL = false;
layout(constant_id = CONSTANT_PULL) const bool PULL = false;
layout(constant_id = CONSTANT_PASS) const int PASS = PASS_WHOLE;
layout(constant_id = CONSTANT_STEPS) const int STEPS = 0;
layout(constant_id = CONSTANT_CHORDS) const int CHORDS = 0;
layout(constant_id = CONSTANT_AIMED) const bool AIMED = false;

LOAD4_BUFFER(BATCH_RIG, rig);
LOAD4_BUFFER(BATCH_TARGET, targets);
LOAD4_BUFFER(BATCH_BASE, bases);
LOAD4_BUFFER(BATCH_STATE, states);
STORE4_BUFFER(BATCH_STATE_OUT, statesOut);
STORE4_BUFFER(BATCH_JOINT_OUT, jointsOut);
STORE4_BUFFER(BATCH_ROTATION_OUT, rotationsOut);
STORE4_BUFFER(BATCH_REPORT_OUT, reportsOut);
LOAD4_BUFFER(BATCH_PACE, paces);
STORE4_BUFFER(BATCH_PACE_OUT, pacesOut);
layout(set = 0, binding = BATCH_LIST, std430) buffer ListBlock { uint list[]; };
layout(push_constant) uniform BatchBlock { BatchConstants constants; };

// The least change of the error that counts as progress.
float leastProgress() { return max(1e-3 * constants.tolerance, 3e-7); }

// The error at which a solve makes no iteration. One that continues another makes one even within the tolerance, so that
// a slow target does not leave the chain standing and then have it step.
float leastError() { return PREVIOUS ? min(ROUNDING, constants.tolerance) : constants.tolerance; }

// Where the target was, and how far targets go.
struct Pace {
  bool known, slow;
  float way, pace;
};

Pace paceOf(vec4 last, vec3 target) {
  Pace at;
  at.known = PREVIOUS && last.w > 0.0;
  at.way = distance(target, last.xyz);
  at.pace = !at.known ? UNHELD : at.way == 0.0 ? min(RECOVERY * last.w, UNHELD) : at.way;
  at.slow = at.known && at.way < FAST_TARGET;
  return at;
}

// Whether a chain whose target stands still is left where it was: its tip gains too little by what its joints move.
bool isIdle(Pace at, float moved, float gain, float error) {
  return at.known && at.way < 2.0 * STILL && error > constants.tolerance && gain < LEAST_GAIN * moved + STILL;
}

bool isHeld(Pace at, float moved) { return at.known && at.pace < FAST_TARGET && moved > GEAR * at.pace + STILL; }

// On the way from unit a to unit b, which are not opposite.
vec3 between(vec3 a, vec3 b, float share) {
  vec3 d = mix(a, b, share);
  return dot(d, d) < 1e-6 ? a : unit(d);
}

// Squares of longer targets would not be finite, and only their direction matters.
vec3 nearEnough(vec3 target) {
  float largest = max(abs(target.x), max(abs(target.y), abs(target.z)));
  return target * (1e6 / max(largest, 1e6));
}

// The chain of this invocation, or one past the last.
int chainHere() {
  uint here = gl_GlobalInvocationID.x;
  if (PASS != PASS_LISTED) return int(min(here, constants.count));
  return int(here < list[LIST_COUNT] ? list[LIST_FIRST + here] : constants.count);
}

void enlist(bool needsMore, int chain) {
  RARELY(needsMore) {
    uint place = atomicAdd(list[LIST_COUNT], 1u);
    list[LIST_FIRST + place] = uint(chain);
    atomicMax(list[0], place / uint(WORK_GROUP) + 1u);
  }
}
