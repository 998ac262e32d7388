// Binding numbers of set 0 (every stage declares those it uses), push constants and specialization constants.
#ifndef SKITTER_BINDINGS_H
#define SKITTER_BINDINGS_H

#include "skitter/records.h"

#ifdef __cplusplus
namespace skitter::shared {
#define BINDING inline constexpr int
#else
#define BINDING const int
#endif

BINDING BINDING_PARAMETERS = 0;  // uniform block Parameters
BINDING BINDING_HEIGHTS = 1;     // R32F image, sampled by textureGather
// Constant for a kind of herds.
BINDING BINDING_RIG = 2;
BINDING BINDING_KEY = 3;
BINDING BINDING_CLIP = 4;
BINDING BINDING_CLIP_FRAME = 5;
BINDING BINDING_CLIP_ROW = 6;
BINDING BINDING_CLIP_LEG = 7;
BINDING BINDING_CLIP_JOINT = 8;
// Records: BINDING_BODY, BINDING_BODY_OUT and so on.
#define BIND(NAME, name, binding, per, stride, kept, spawned, hashed) \
  BINDING BINDING_##NAME = binding;                                   \
  BINDING BINDING_##NAME##_OUT = binding + 1;
SKITTER_RECORDS(BIND)
#undef BIND
// A page's own, for its stages only.
//
// Legs that begin a step: uint, leg record * 2 + (1 if aimed anew); where there are levels of rate, +
// LIST_LEVEL * the level of this tick. Later in the tick, legs that ik's first dispatch leaves: uint, leg
// record. For controllers that play clips, agents that fade: uint.
BINDING BINDING_LIST = 60;
BINDING BINDING_COUNTERS = 61;
BINDING BINDING_HISTOGRAM = 62;
// Blocks with somebody awake, where agents may sleep.
BINDING BINDING_AWAKE = 63;
BINDING BINDING_AWAKE_OUT = 64;
BINDING BINDING_FOOTFALL_OUT = 65;

// The grid of the whole crowd, where a herd avoids (skitter/records.h).
BINDING BINDING_CELL = 66;
BINDING BINDING_PLACE = 67;
BINDING BINDING_WALKER = 68;
BINDING BINDING_CROWDING = 69;  // CROWDING_

// The fields of herds that find their way (shared/ways.h).
BINDING BINDING_WAY = 70;
// Obstacles, for herds that avoid (shared/walls.h).
BINDING BINDING_WALL = 73;

// The ground and the trail of those that forage (shared/forage.h).
BINDING BINDING_FORAGE_GROUND = 71;
BINDING BINDING_TRAIL = 72;

// Levels of rate (shared/levels.h).
BINDING BINDING_LEVELS = 74;

// Gaits that agents try (shared/adapt.h). 75 and 76 are a record's.
BINDING BINDING_GAIT_MAP = 77;

// Specialization constants.
BINDING CONSTANT_LEGS = 0;
BINDING CONSTANT_BONES = 1;
BINDING CONSTANT_GROUPS = 2;
BINDING CONSTANT_APPROACH_ITERATIONS = 3;
BINDING CONSTANT_POLISH_ITERATIONS = 4;
BINDING CONSTANT_LIMITS_LOW = 5;
BINDING CONSTANT_LIMITS_HIGH = 6;
BINDING CONSTANT_SOLVER = 7;
// 8 to 19: ik_batch.h
BINDING CONSTANT_CLIPS = 20;
BINDING CONSTANT_JOINTS = 21;        // of the clips' palette
BINDING CONSTANT_SEARCH_STEPS = 22;  // 2 to their power is more than a clip has frames
BINDING CONSTANT_REACH = 23;         // gait steps when out of reach, without a rhythm
BINDING CONSTANT_WATCH = 24;    // gait looks at the ground under every foot: the heights were edited lately
BINDING CONSTANT_SLEEP = 25;    // SLEEP_
BINDING CONSTANT_FEET = 26;     // tips are written, and feet where no other stage needs them
BINDING CONSTANT_RESERVE = 29;  // whether places may be empty
BINDING CONSTANT_LEVELS = 30;   // whether blocks tick at rates of their own (docs/levels.md)
BINDING CONSTANT_CANDIDATES = 32;  // gaits of the map that agents try
BINDING CONSTANT_AVOIDS = 31;      // whether the herd avoids, so that steer is avoid's record
BINDING CONSTANT_HERD_STEPS = 28;  // 2 to their power is at least the number of herds in a page
// From here on the numbers with which the rig's records of legs begin, 4 * RIG_LEG_STRIDE a leg.
BINDING CONSTANT_RIG_LEGS = 100;
// And those of the bones of rigs with CHOSEN_LEGS legs and CHOSEN_BONES bones at most: a number of one bone,
// of all legs.
BINDING CONSTANT_RIG_CHOSEN = 27;  // whether it is one
BINDING CONSTANT_RIG_BONES = 400;
BINDING CHOSEN_LEGS = 8;
BINDING CHOSEN_BONES = 8;
// KNOWN_PARAMETERS.
BINDING CONSTANT_PARAMETERS = 700;
#undef BINDING

// Push constants of every stage.
struct TickConstants {
#ifdef __cplusplus
  uint32_t count;  // agents of the page; of measure those that are watched
  float tick;      // n, the tick being computed
  // measure: invocation i looks at agent first + i * every of the page, which has been watched for `watched`
  // ticks. footfall: `first` is the page's first agent in its kind, `room` the most events that fit.
  uint32_t first;
  uint32_t every;
  uint32_t watched;
  uint32_t room;
  // navigate: seconds of standing after which an agent may sleep in this tick; in herds that forage `watched`
  // is 2^32 times the chance to leave the nest.
  // wake with levels of rate: `every`, `watched`, `room` are the camera's x, y, z (quarter metres, signed);
  // `sleepTime` is a sum of LEVELS_ flags (shared/levels.h).
  // Stages that see the crowd: `first` is the number in the crowd of the page's first agent, `every` are the
  // grid's buckets, `watched` the bits of a power that keys leave out, `room` is how far agents look
  // (quanta), `sleepTime` metres per quantum. avoid: `tick` counts turns.
  float sleepTime;
#else
  uint count;
  float tick;
  uint first;
  uint every;
  uint watched;
  uint room;
  float sleepTime;
#endif
};

#ifdef __cplusplus
}  // namespace skitter::shared
#endif
#endif
