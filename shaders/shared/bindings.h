// Binding numbers of set 0 (every stage declares those it uses), push constants and specialization constants.
#ifndef SKITTER_BINDINGS_H
#define SKITTER_BINDINGS_H

#ifdef __cplusplus
namespace skitter::shared {
#define BINDING inline constexpr int
#else
#define BINDING const int
#endif

BINDING BINDING_PARAMETERS = 0;  // uniform block Parameters
BINDING BINDING_HEIGHTS = 1;     // R32F image, sampled by textureGather
BINDING BINDING_RIG = 2;
// Legs that begin a step: uint, leg record * 2 + (1 if aimed anew); later in the tick, legs that ik's first
// dispatch leaves: uint, leg record. Of clip: agents that fade, uint.
BINDING BINDING_LIST = 3;
BINDING BINDING_COUNTERS = 4;
BINDING BINDING_HISTOGRAM = 5;
// Records: read at the even number, written at the odd one.
BINDING BINDING_GOAL = 6;
BINDING BINDING_GOAL_OUT = 7;
BINDING BINDING_STEER = 8;
BINDING BINDING_STEER_OUT = 9;
BINDING BINDING_BODY = 10;
BINDING BINDING_BODY_OUT = 11;
BINDING BINDING_GAIT = 12;
BINDING BINDING_GAIT_OUT = 13;
BINDING BINDING_STEP = 14;
BINDING BINDING_STEP_OUT = 15;
BINDING BINDING_FOOT = 16;
BINDING BINDING_FOOT_OUT = 17;
BINDING BINDING_CHAIN = 18;
BINDING BINDING_CHAIN_OUT = 19;
BINDING BINDING_POSE = 20;
BINDING BINDING_POSE_OUT = 21;
BINDING BINDING_METRIC = 22;
BINDING BINDING_METRIC_OUT = 23;
BINDING BINDING_PLAY = 24;
BINDING BINDING_PLAY_OUT = 25;
BINDING BINDING_START = 26;
BINDING BINDING_START_OUT = 27;
BINDING BINDING_FIX = 28;
BINDING BINDING_FIX_OUT = 29;
// Of a herd's clips, constant.
BINDING BINDING_CLIP = 30;
BINDING BINDING_CLIP_FRAME = 31;
BINDING BINDING_CLIP_ROW = 32;
BINDING BINDING_CLIP_LEG = 33;
BINDING BINDING_CLIP_JOINT = 34;
BINDING BINDING_WATCH = 35;
BINDING BINDING_WATCH_OUT = 36;
BINDING BINDING_FLIGHT = 37;
BINDING BINDING_FLIGHT_OUT = 38;
BINDING BINDING_FOOTFALL_OUT = 39;
BINDING BINDING_SPRING = 40;
BINDING BINDING_SPRING_OUT = 41;
BINDING BINDING_KEY = 42;  // constant
BINDING BINDING_MISS = 43;
BINDING BINDING_MISS_OUT = 44;
BINDING BINDING_ARC = 45;
BINDING BINDING_ARC_OUT = 46;
// Blocks with somebody awake, where agents may sleep.
BINDING BINDING_AWAKE = 47;
BINDING BINDING_AWAKE_OUT = 48;
BINDING BINDING_TIP = 49;
BINDING BINDING_TIP_OUT = 50;

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
BINDING CONSTANT_WATCH = 24;  // gait looks at the ground under every foot: the heights were edited lately
BINDING CONSTANT_SLEEP = 25;  // SLEEP_
BINDING CONSTANT_FEET = 26;   // tips are written, and feet where only ik reads them
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
  // Of measure: invocation i looks at agent first + i * every of the page, watched for so many ticks. Of
  // footfall: the page's first agent in its herd, and the events that there is room for.
  uint32_t first;
  uint32_t every;
  uint32_t watched;
  uint32_t room;
  // Of navigate: seconds of standing after which an agent may sleep in this tick.
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
