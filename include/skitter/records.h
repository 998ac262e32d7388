// The records that the stages exchange, as GLSL, C++ and C (C99, without a prefix) see them. Every buffer is
// an array of vec4; a record is `stride` consecutive vec4. Small integers travel as exact floats.
// docs/stages.md has the meaning of each symbol. One stage writes each record; `written by` names it. The
// table at the end says all else.
#ifndef SKITTER_RECORDS_H
#define SKITTER_RECORDS_H

#ifdef __cplusplus
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace skitter::shared {
using std::abs, std::floor;
#define SKITTER_CONST inline constexpr
#define SKITTER_FUNCTION inline constexpr
#define SKITTER_INLINE inline
#define SKITTER_INT(x) int(x)
#define SKITTER_UINT(x) unsigned(x)
#define SKITTER_ABS(x) abs(x)
#elif defined(__STDC__)
#include <math.h>
#define SKITTER_CONST static const
#define SKITTER_FUNCTION static inline
#define SKITTER_INLINE static inline
#define SKITTER_INT(x) ((int)(x))
#define SKITTER_UINT(x) ((unsigned)(x))
#define SKITTER_ABS(x) fabs(x)
#else
#define SKITTER_CONST const
#define SKITTER_FUNCTION
#define SKITTER_INLINE
#define SKITTER_INT(x) int(x)
#define SKITTER_UINT(x) uint(x)
#define SKITTER_ABS(x) abs(x)
#endif

// Legs that a creature may have.
SKITTER_CONST int MOST_LEGS = 24;

// Invocations per work group in every stage: a software device takes a while to begin one, and makes all of
// them, with work to do or none.
SKITTER_CONST int WORK_GROUP = 128;

// Leg records are laid out in blocks of BLOCK agents: within a block those of the first legs, one per agent,
// then those of the second legs, and so on. So a stage over agents walks through memory from end to end,
// where agents leg by leg would be many cache lines apart. The last block of a page is whole, whatever its
// agents; what is beyond them is never read. Numbers are not negative, and divided as such: it takes fewer
// instructions.
SKITTER_CONST int BLOCK = 8;
SKITTER_FUNCTION int legRecord(int agent, int leg, int legs) {
  return SKITTER_INT((SKITTER_UINT(agent) / SKITTER_UINT(BLOCK) * SKITTER_UINT(legs) + SKITTER_UINT(leg)) *
                         SKITTER_UINT(BLOCK) +
                     SKITTER_UINT(agent) % SKITTER_UINT(BLOCK));
}
SKITTER_FUNCTION int agentOfRecord(int record, int legs) {
  return SKITTER_INT(SKITTER_UINT(record) / SKITTER_UINT(BLOCK * legs) * SKITTER_UINT(BLOCK) +
                     SKITTER_UINT(record) % SKITTER_UINT(BLOCK));
}
SKITTER_FUNCTION int legOfRecord(int record, int legs) {
  return SKITTER_INT(SKITTER_UINT(record) / SKITTER_UINT(BLOCK) % SKITTER_UINT(legs));
}
// Metres; body positions are tile * TILE_SIZE + local, 0 <= local < TILE_SIZE.
SKITTER_CONST float TILE_SIZE = 16.0;
// A tile (x, z) as one number, TILES x + z: an exact float while both are at least -TILES / 2 and less than
// TILES / 2, which is 32 km, eight times as far as terrains go.
SKITTER_CONST float TILES = 4096.0;
SKITTER_FUNCTION float packedTile(float x, float z) { return TILES * x + z; }
SKITTER_INLINE float tileX(float tile) { return floor(tile / TILES + 0.5f); }
SKITTER_INLINE float tileZ(float tile) { return tile - TILES * tileX(tile); }

// goal, per agent, written by navigate and from outside: the host (Crowd::steer) or shaders of the
// caller's (Crowd::goalBuffers). Other kinds than these are undefined, as is what is not finite.
//   [0] target x, target z, other end x, other end z    world metres
//       of kind velocity: desired velocity x, z (m/s), unused x 2
//       of kind series: target, number of the place in the series' table (docs/ways.md), draw
//   [1] speed (m/s; of kind velocity what it is cut to), arrival radius (m), kind (GOAL_), unused
SKITTER_CONST int GOAL_STRIDE = 2;
SKITTER_CONST float GOAL_NONE = 0.0;
SKITTER_CONST float GOAL_POINT = 1.0;
SKITTER_CONST float GOAL_CROSS = 2.0;
SKITTER_CONST float GOAL_VELOCITY = 3.0;
SKITTER_CONST float GOAL_SERIES = 4.0;  // only the host begins one

// steer, per agent, written by navigate.
//   [0] desired velocity x, z (m/s), 1 if the agent sleeps, unused
SKITTER_CONST int STEER_STRIDE = 1;

// avoid, per agent of a herd that avoids, written by avoid: the later stages take it in place of steer.
//   [0] velocity x, z (m/s); 1 plus the agents in reach if the agent sleeps, else minus these; the most speed
//       of the body along its heading (m/s)
SKITTER_CONST int AVOID_STRIDE = 1;
// Neighbours that an agent keeps clear of.
SKITTER_CONST int NEIGHBOURS = 8;

// Where everybody is in a crowd with a herd that avoids, built anew in each tick (shaders/grid). Agents are
// numbered through the crowd, kind after kind. Lengths are in quanta (docs/stages/avoid.md).
//   cell, each    [0] first walker in the five cells of its row, walkers in these, its own first walker,
//                     all walkers
//   place, each agent
//                 [0] its walker, its cell, all walkers, unused
//   walker, each, cell after cell
//                 [0] X, Z, radius, agent
//                 and, after those of all walkers,
//                 [1] velocity x, z (m/s), 1 if its herd avoids, unused
SKITTER_CONST int WALKER_PARTS = 2;

// Figures of the grid since the start, unsigned integers of which the first three have two words, low and
// high: neighbours that the cap dropped; overlaps of pairs, a share each, in CROWDING_SHARES; pairs that
// overlapped; the greatest overlap.
SKITTER_CONST int CROWDING_DROPPED = 0;
SKITTER_CONST int CROWDING_OVERLAP = 2;
SKITTER_CONST int CROWDING_PAIRS = 4;
SKITTER_CONST int CROWDING_MOST = 6;
SKITTER_CONST int CROWDING_WORDS = 8;
SKITTER_CONST float CROWDING_SHARES = 65536.0;

// forager, per agent of a herd that forages, written by navigate (docs/foraging.md).
//   [0] cell that it goes to + 1 (0: none), heading x, heading z,
//       state + FORAGE_STATES * place of the cell that it entered last
//   [1] cell that it entered in this tick + 1 (0: none), grains laid there, what it did there (DEED_), cells
//       since it left nest or food
SKITTER_CONST int FORAGER_STRIDE = 2;

// The agents that may sleep: nobody, anybody, or who has breathed out.
SKITTER_CONST int SLEEP_NEVER = 0;
SKITTER_CONST int SLEEP_STILL = 1;
SKITTER_CONST int SLEEP_BREATHED_OUT = 2;

// awake, per block of agents of whom somebody is awake, in any order, zeros after the last; written by wake.
//   [0] block, mask of its agents that are awake, ticks since its last one (where there are levels of rate),
//       unused
SKITTER_CONST int AWAKE_STRIDE = 1;

// body, per agent, written by body.
//   [0] local x, y (world), local z, tile
//   [1] heading x, heading z, speed s (m/s, horizontal, along the heading), 1 where the place is empty
//   [2] R_0, quaternion xyzw, worldFromModel
//   [3] turn rate omega (rad/s), still time (s), follow factor kappa, surface speed v3 (m/s)
SKITTER_CONST int BODY_STRIDE = 4;
// World y of an empty place's body, metres: out of every picture.
SKITTER_CONST float ABSENT_HEIGHT = -1e6;

// gait, per agent, written by gait.
//   [0] phase phi in [0,1), lift mask, re-aim mask, step duration (ticks; where there are levels of rate, own
//       ticks: docs/levels.md)
//   [1] half stride a (m), cycle C (s), masks of legs in the air before lifting, of legs that do not carry
SKITTER_CONST int GAIT_STRIDE = 2;

// step, per leg, written by foothold when a step begins or is aimed anew.
//   [0] landing x, y, z, first tick            positions are local to the step's tile in x and z, world in y
//   [1] lift-off x, y, z, duration and tile    (packedTicks)
SKITTER_CONST int STEP_STRIDE = 2;
// A step's tile is the body's when it begins, so it is known modulo STEP_TILES in x and z: no body goes half
// as many tiles, 256 m, while a foot stands. With the duration in ticks (negative: the landing is a last
// resort) it is one number, an exact float below MOST_STEP_TICKS.
SKITTER_CONST float STEP_TILES = 32.0;
SKITTER_CONST float STEP_TICK = 1024.0;  // STEP_TILES^2
SKITTER_CONST float MOST_STEP_TICKS = 16384.0;
SKITTER_INLINE float stepTile(float x, float z) {
  float tile = STEP_TILES * x + z;
  return tile - STEP_TICK * floor(tile / STEP_TICK);
}
SKITTER_INLINE float packedTicks(float ticks, float tile) {
  float packed = STEP_TICK * SKITTER_ABS(ticks) + tile;
  return ticks < 0.0f ? -packed : packed;
}
SKITTER_INLINE float ticksOf(float packed) {  // without their sign
  return floor(SKITTER_ABS(packed) / STEP_TICK);
}
SKITTER_INLINE float tileOfTicks(float packed) { return SKITTER_ABS(packed) - STEP_TICK * ticksOf(packed); }
// From a body's tile to a step's, as one number and in x and z.
SKITTER_INLINE float tilesApart(float step, float body) {
  return step - body - STEP_TICK * floor((step - body) / STEP_TICK + 0.5f);
}
SKITTER_INLINE float apartX(float apart) { return floor(apart / STEP_TILES + 0.5f); }
SKITTER_INLINE float apartZ(float apart) { return apart - STEP_TILES * apartX(apart); }

// arc, per leg, written by foothold with the step: the way of its foot through the air.
//   [0] lift vector b x, y, z, unused
//   [1] start tangent m0 x, y, z, unused
SKITTER_CONST int ARC_STRIDE = 2;

// foot, per leg, written by swing.
//   [0] foot target relative to the body's position, world axes, x, y, z; progress u in [0,1], 1 = stance
SKITTER_CONST int FOOT_STRIDE = 1;

// chain, per leg, written by ik.
//   [0 .. ceil(bones/2)-1] stereographic directions X, Y of two bones each
SKITTER_FUNCTION int chainStride(int bones) { return (bones + 1) / 2; }

// miss, per agent, written by ik of the few legs that its second dispatch solves: of each leg a pair, two a
// vec4, for body and gait read all of an agent's.
//   reach error of a planted foot (share of the reach; 0 up to missLeast), the tick in which it was written:
//   a pair that is older than the last tick counts as 0
SKITTER_FUNCTION int missStride(int legs) { return (legs + 1) / 2; }
SKITTER_FUNCTION int missPair(int agent, int leg, int legs) { return agent * 2 * missStride(legs) + leg; }

// tip, per leg, written by ik where somebody looks at it (CrowdOptions::feet): it follows from the chain.
//   [0] tip relative to the body's position, world axes, x, y, z; reach error (m)
SKITTER_CONST int TIP_STRIDE = 1;

// pose, per agent, written by pose: 1 + legs * bones entries of
//   [0] R, quaternion xyzw, world from rest
//   [1] joint position relative to the body's position, world axes, x, y, z; 1 where the bone is lost
// A vertex v of that bone is at  body + [1] + R (v - rest start), of a lost bone at  body + [1].
SKITTER_CONST int POSE_STRIDE = 2;

// play, per agent, written by clip.
//   [0] clip, its time (s), clip faded from, its time
//   [1] weight of the first, its rate, the other's, unused
//   [2] of both: frame, fraction to the next one          frames count through all clips of the herd
SKITTER_CONST int PLAY_STRIDE = 3;

// start, per leg, written by swing of planted: a chain record, and
//   [n] the clip's root x, y, z (model), unused
SKITTER_FUNCTION int startStride(int bones) { return chainStride(bones) + 1; }
// fix, per leg, written by ik of planted: a bone
//   [0] q, quaternion xyzw, model
//   [1] move x, y, z (model), unused
SKITTER_CONST int FIX_STRIDE = 2;
// spring, per leg, of controller key-poses, written by swing, which writes its chain too.
//   as a chain record, rates of the directions X, Y (1/s)
// step, of planted, written by swing.
//   [0] lock x, y, z, tile   [1] offset o x, y, z, 1 if locked
// pose, per agent, of clip and planted, written by pose: an entry per joint of
//   [0..2] rows of the matrix from the clips' skin to world axes about the body's position
SKITTER_CONST int MATRIX_STRIDE = 3;
SKITTER_FUNCTION int poseStride(int legs, int bones, int joints) {
  return joints > 0 ? joints * MATRIX_STRIDE : (1 + legs * bones) * POSE_STRIDE;
}

// The clips of a herd, constant.
//   clip, each  [0] first frame, frames, seconds, speed (m/s; 0: standing)
//   frame, each [0] time (s), 1 / time to the next (0 at the last), mask of legs that stand, unused
//   row, a frame and joint: three rows of its matrix, model space, less the clip's ground; a frame more
//   leg, a leg and joint 0 .. bones: position before skinning x, y, z, palette entry
//   joint, each [0] number of its bone among an agent's (leg * bones + bone), or -1, unused

// key, per leg, of controller key-poses, constant.
//   [0] phase at which the foot begins to stand, share of the cycle for which it does, unused x 2
//   then directions as in a chain record: of the standing pose, and of each key pose followed by its tangents
SKITTER_FUNCTION int keyStride(int bones, int keys) { return 1 + (1 + 2 * keys) * chainStride(bones); }

// Ticks in a row for which an agent is watched.
SKITTER_CONST int WATCH_TICKS = 128;

// watch, per watched agent, written by measure: the trail of its body and then of each tip,
// WATCH_TRAIL_STRIDE vec4 each. It is of the agent that is watched at the time.
//   [0] position, tile-local x, y, z; of a tip: slip of the stance so far (m), WATCH_AIR or WATCH_UNSEEN
//   [1] difference from the position a tick before x, y, z; path in the open window P (m)
//   [2] difference of that from the one a tick before x, y, z; sum Q of squared third differences (m^2)
SKITTER_CONST int WATCH_TRAIL_STRIDE = 3;
SKITTER_CONST float WATCH_AIR = -1.0;     // not planted
SKITTER_CONST float WATCH_UNSEEN = -2.0;  // planted since before the watch began
SKITTER_FUNCTION int watchStride(int legs) { return WATCH_TRAIL_STRIDE * (1 + legs); }

// metric, per agent, written by measure: sums over the ticks in which it was watched.
//   [0] ticks; leg-ticks planted; of these planted a tick before too; of those skating
//   [1] slip over finished stances (m), finished stances, largest reach error (m),
//       tan(largest limit violation / 2)
//   [2] penetration, the same beyond the dead zone, float, the same beyond the dead zone (m)
//   [3] segment penetration (m), its largest (m), leg-ticks beyond a limit, leg-ticks of lost legs
//   [4] pair-ticks of neighbours, of these crossing, ticks with a support, unstable ticks
//   [5] stability margin (m), its least (m), unused, unused
//   [6] W^5 Q over windows of the tips, their P^2, the same of the body (m^2)
SKITTER_CONST int METRIC_STRIDE = 7;

// hurt, per agent of a herd that can be hurt, written by the host (Crowd::hurt): which of its legs are hurt,
// and the gait that it has for it (docs/damage.md); of a herd that adapts, adapt writes the gait. A leg that
// is lost or stuck does not carry.
//   [0] mask of lost legs, of stuck legs, of lame legs; groups of the gait
//   [1] of lost legs the first bone that is lost: legs 0 to 5, 6 to 11, 12 to 17 and 18 to 23 (packedBone)
//   [2] shift of the homes x, y, z (model, m); share of the desired velocity
//   [3 + leg] group, lag in it, mask of the legs that must stand while it is in the air; how many times as
//   long as others its step lasts
// Below so many legs that carry a creature lies on its belly.
SKITTER_CONST int FEWEST_THAT_WALK = 3;
// How many times as long as others the step of a lame leg lasts.
SKITTER_CONST float LAME_SLOWNESS = 1.5;
SKITTER_CONST int HURT_LEGS = 3;  // where its vec4 of legs begin
SKITTER_FUNCTION int hurtStride(int legs) { return HURT_LEGS + legs; }
// Six bones, each below HURT_BONES, are one exact float.
SKITTER_CONST int HURT_BONES = 16;
SKITTER_CONST int HURT_BONES_LEGS = 6;
// The bone of leg `leg` in the number of its six legs.
SKITTER_INLINE int packedBone(float packed, int leg) {
  return SKITTER_INT(SKITTER_UINT(packed) >> SKITTER_UINT(4 * (leg % HURT_BONES_LEGS))) % HURT_BONES;
}

// carried, per agent of a herd that can be hurt, written by the host alone (Crowd::carry, docs/loads.md).
// What its gait depends on is in its `hurt` record; react and measure have the centre of mass from this one.
//   [0] offset of the load's centre from the body's x, y, z (model, leg lengths), mass (of the body's mass)
SKITTER_CONST int CARRIED_STRIDE = 1;

// push, per agent of a herd with reactions, written by the host alone (Crowd::push).
//   [0] change of the velocity x, z (m/s) of who carries nothing, unused, the tick in which it counts
SKITTER_CONST int PUSH_STRIDE = 1;

// reaction, per agent of a herd with reactions, written by react (docs/stages/react.md), and by wake where
// there are levels of rate.
//   [0] phase (REACTION_), seconds in it, seconds for which a fall may still begin, seconds for which the
//       capture point has been out of reach; in a fall instead of these 1 where the hull touches the ground
//   [1] velocity beside that of the walk x, z, and in a fall all of it; upward velocity in a fall (m/s);
//       how much lower than it walks the body is while it rises (m)
//   [2] direction of the fall x, z (unit), tilt (rad), its rate (rad/s)
//   [3] up axis of the ground below a fall x, y, z; share to which its legs are folded
//   [4] falls, how often it has stood again, seconds since this fall began, seconds of those before
SKITTER_CONST int REACTION_STRIDE = 5;
SKITTER_CONST float REACTION_STEADY = 0.0;
SKITTER_CONST float REACTION_STUMBLING = 1.0;
SKITTER_CONST float REACTION_FALLING = 2.0;
SKITTER_CONST float REACTION_LYING = 3.0;
SKITTER_CONST float REACTION_RIGHTING = 4.0;
SKITTER_CONST float REACTION_RISING = 5.0;

// search, per agent of a herd that adapts, written by adapt (docs/stages/adapt.md).
//   [0] masks of idle and of lame legs that it has noticed, what it does (SEARCH_), trials that it has made
//   [1] candidate whose gait it has, seconds of its trial; candidate and fitness of its best trial
//   [2] sums of its trial: wanted way, progress (m), time without a safe support (s), unused
//   [3 + i] trials 2i and 2i + 1, each: candidate, fitness
SKITTER_CONST float SEARCH_AT_EASE = 0.0;
SKITTER_CONST float SEARCH_SEARCHES = 1.0;
SKITTER_CONST float SEARCH_SETTLED = 2.0;
SKITTER_CONST int SEARCH_TRIALS = 3;        // where its trials begin
SKITTER_CONST int SEARCH_MOST_TRIALS = 20;  // then it is settled
SKITTER_CONST int SEARCH_STRIDE = SEARCH_TRIALS + SEARCH_MOST_TRIALS / 2;

// rate, per agent where there are levels of rate, written by wake (docs/levels.md). All agents of a block
// have the same, but for the last number.
//   [0] level at which it goes on from its last tick, level of that tick, that tick, and the tick in which
//       the host put the agent somewhere, else 0
SKITTER_CONST int RATE_STRIDE = 1;
// An agent of level k ticks in every 2^k-th tick.
SKITTER_CONST int RATE_LEVELS = 4;

// rig, per leg, constant: RIG_LEG_STRIDE vec4, then RIG_BONE_STRIDE per bone (zero-length bones pad short
// legs).
//   leg  [0] root x, y, z (model), reach (m)
//        [1] home x, y, z (model), group
//        [2] lag in its group (0 first, 1 last), mask of the legs that must stand while it is in the air,
//        1 / reach, unused
//   bone [0] x axis of the bone frame B_i (model), length / reach
//        [1] z axis of B_i, the rest direction r_i (model), tan(half-angle / 2)
//        [2] rest start p_i x, y, z (model), stiffness
//        [3] ellipse: half-angles toward +x, +y, -x, -y; hinge: tan(lo/2), tan(hi/2), c_i, sqrt(1 - c_i^2)
//        [4] kind of limit (LIMIT_), twist: tan(lo/2), tan(hi/2), unused
//        [5] x axis of B_(i-1)^T B_i (of the first bone: B_0), length / reach
//        [6] z axis of the same, tan(half-angle / 2)
//        [7] of a crowd, whose frames are carried along the leg at rest: stereographic X, Y of r_i in B_(i-1)
//        (of the first bone: in the model), length / reach, cos(half-angle)
SKITTER_CONST int RIG_LEG_STRIDE = 3;
// Stiffness of a leg's first bone, which turns all of it and so yields to the target more readily; others
// have 1.
SKITTER_CONST float FIRST_STIFFNESS = 0.2;
SKITTER_CONST int RIG_BONE_STRIDE = 8;
// Kinds of limit. A kernel is specialised by those that may occur at each bone: four bits per bone, eight
// bones a word, LIMIT_TWIST beside the others.
SKITTER_CONST int LIMIT_CONE = 1;
SKITTER_CONST int LIMIT_ELLIPSE = 2;
SKITTER_CONST int LIMIT_HINGE = 4;
SKITTER_CONST int LIMIT_TWIST = 8;
SKITTER_CONST int LIMIT_WORDS = 2;
SKITTER_CONST int LIMIT_BONES_A_WORD = 8;
SKITTER_FUNCTION int rigStride(int bones) { return RIG_LEG_STRIDE + RIG_BONE_STRIDE * bones; }

// flight, per leg, written by footfall.
//   [0] tip, tile-local x, y, z; 1 in the air, 0 planted
SKITTER_CONST int FLIGHT_STRIDE = 1;

// footfall, one per touchdown of the last tick, in any order, written by footfall:
// counters[COUNTER_FOOTFALLS] of them, or as many as there is room for.
//   [0] position x, y, z (world metres), speed of the foot over the tick that ended there (m/s)
//   [1] agent of the kind, leg, tick, unused
SKITTER_CONST int FOOTFALL_STRIDE = 2;

// counters, per page, unsigned integers: [0..2] indirect dispatch of foothold, [3] legs listed for it (where
// clips are played: of pose, and the agents that fade), [4] footfalls of the tick, [5..7] indirect dispatch
// of ik, [8] legs listed for it; where agents may sleep: [9..17] indirect dispatches over the agents, the
// legs and the joints of blocks with somebody awake, [18] those blocks, [19] agents that are awake. Then a
// row per herd of the page, counts since the start: last resorts, targets that were not finite, footfalls
// without room. Rows are as many as in any page of the kind, and a power of two. Then the first agent of each
// herd, in the page; UINT_MAX where the page has no such herd.
SKITTER_CONST int COUNTER_DISPATCH_X = 0;
SKITTER_CONST int COUNTER_LISTED = 3;
SKITTER_CONST int COUNTER_FOOTFALLS = 4;
SKITTER_CONST int COUNTER_IK_DISPATCH_X = 5;
SKITTER_CONST int COUNTER_IK_LISTED = 8;
SKITTER_CONST int COUNTER_AWAKE_AGENTS_X = 9;
SKITTER_CONST int COUNTER_AWAKE_LEGS_X = 12;
SKITTER_CONST int COUNTER_AWAKE_JOINTS_X = 15;
SKITTER_CONST int COUNTER_AWAKE_BLOCKS = 18;
SKITTER_CONST int COUNTER_AWAKE = 19;
SKITTER_CONST int COUNTER_ROWS = 20;
SKITTER_CONST int ROW_LAST_RESORTS = 0;
SKITTER_CONST int ROW_NOT_FINITE = 1;
SKITTER_CONST int ROW_FOOTFALLS_DROPPED = 2;
SKITTER_CONST int ROW_COUNTERS = 3;
SKITTER_FUNCTION int counterRow(int row) { return COUNTER_ROWS + ROW_COUNTERS * row; }
SKITTER_FUNCTION int counterHerd(int row, int rows) { return counterRow(rows) + row; }  // its first agent
// reach errors, a row of buckets per herd of the page: counts per bucket of a leg length; bucket k holds
// errors of 2^(k/4 - 20) and more.
SKITTER_CONST int HISTOGRAM_BUCKETS = 80;

// Every kind of records, once: RECORD(NAME, name, binding, per, stride, kept, spawned, hashed). Binding
// numbers (shaders/shared/bindings.h), a page's buffers and their sizes, what the host downloads, samples and
// hashes, and the sizes that a replay expects follow.
//   binding  a stage reads it at that number and writes it at the next
//   per      agent; leg, in blocks; watched: agents that measure looks at
//   stride   vec4 of each, where the longest of `legs` legs has so many `bones`, and clips played have so
//            many `joints` (0: none are)
//   kept     always; bound: where a stage of the herd binds it; hurt: where the herd can be hurt, whoever
//            binds it, for it is all that a state has of it; exchanged: where one stage writes it and another
//            reads it, or the host asks for it (CrowdOptions::feet): else there is room for one, for shaders
//            bind it all the same
//   spawned  whether agents begin with it (Spawner); others begin as zeros
//   hashed   where the next tick depends on it (Crowd::stateHash), by the herd's `controller`
// clang-format off
#define SKITTER_RECORDS(RECORD) \
  RECORD(GOAL,   goal,   10, agent,   GOAL_STRIDE,                     always,     true,  true) \
  RECORD(STEER,  steer,  12, agent,   STEER_STRIDE,                    always,     false, false) \
  RECORD(AVOID,  avoid,  46, agent,   AVOID_STRIDE,                    bound,      true,  false) \
  RECORD(FORAGER, forager, 48, agent, FORAGER_STRIDE,                  bound,      false, true) \
  RECORD(BODY,   body,   14, agent,   BODY_STRIDE,                     always,     true,  true) \
  RECORD(GAIT,   gait,   16, agent,   GAIT_STRIDE,                     always,     true,  true) \
  RECORD(STEP,   step,   18, leg,     STEP_STRIDE,                     always,     true,  true) \
  RECORD(ARC,    arc,    20, leg,     ARC_STRIDE,                      bound,      false, true) \
  RECORD(FOOT,   foot,   22, leg,     FOOT_STRIDE,                     exchanged,  true,  false) \
  /* Nothing goes on from the directions of clip. */ \
  RECORD(CHAIN,  chain,  24, leg,     chainStride(bones),              always,     true,  controller != Controller::clip) \
  RECORD(MISS,   miss,   26, agent,   missStride(legs),                bound,      false, true) \
  RECORD(TIP,    tip,    28, leg,     TIP_STRIDE,                      exchanged,  true,  false) \
  RECORD(POSE,   pose,   30, agent,   poseStride(legs, bones, joints),bound,     false, false) \
  RECORD(PLAY,   play,   32, agent,   PLAY_STRIDE,                     bound,      true,  true) \
  RECORD(START,  start,  34, leg,     startStride(bones),              bound,      false, false) \
  RECORD(FIX,    fix,    36, leg,     bones * FIX_STRIDE,              bound,      false, false) \
  RECORD(SPRING, spring, 38, leg,     chainStride(bones),              bound,      false, true) \
  RECORD(METRIC, metric, 40, agent,   METRIC_STRIDE,                   bound,      false, false) \
  RECORD(WATCH,  watch,  42, watched, watchStride(legs),               bound,      false, false) \
  RECORD(FLIGHT, flight, 44, leg,     FLIGHT_STRIDE,                   bound,      false, false) \
  RECORD(HURT,   hurt,   50, agent,   hurtStride(legs),                bound,      true,  true) \
  RECORD(REACTION, reaction, 52, agent, REACTION_STRIDE,               bound,      false, true) \
  /* It counts in the tick that it names alone. */ \
  RECORD(PUSH,   push,   54, agent,   PUSH_STRIDE,                     bound,      false, false) \
  RECORD(RATE,   rate,   56, agent,   RATE_STRIDE,                     bound,      false, true) \
  RECORD(SEARCH, search, 75, agent,   SEARCH_STRIDE,                   bound,      false, true) \
  /* Looked at by measure, and in herds with reactions by react and where feet go. */ \
  RECORD(CARRIED, carried, 58, agent, CARRIED_STRIDE,                  hurt,       false, true)
// clang-format on

#ifdef __cplusplus
}  // namespace skitter::shared

namespace skitter {

enum class Record : uint8_t {
#define SKITTER_RECORD(NAME, name, binding, per, stride, kept, spawned, hashed) name,
  SKITTER_RECORDS(SKITTER_RECORD)
#undef SKITTER_RECORD
};
inline constexpr std::array allRecords = {
#define SKITTER_RECORD(NAME, name, binding, per, stride, kept, spawned, hashed) Record::name,
    SKITTER_RECORDS(SKITTER_RECORD)
#undef SKITTER_RECORD
};

// A T for each kind of records, by its name: goal, steer, body and so on.
template <typename T>
struct ForRecords {
#define SKITTER_RECORD(NAME, name, binding, per, stride, kept, spawned, hashed) T name;
  SKITTER_RECORDS(SKITTER_RECORD)
#undef SKITTER_RECORD

  T& of(Record record) {
#define SKITTER_RECORD(NAME, name, binding, per, stride, kept, spawned, hashed) &name,
    return *std::array{SKITTER_RECORDS(SKITTER_RECORD)}[static_cast<size_t>(record)];
#undef SKITTER_RECORD
  }
  const T& of(Record record) const { return const_cast<ForRecords&>(*this).of(record); }
};

}  // namespace skitter
#endif
#endif
