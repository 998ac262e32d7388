// The batch of chains (docs/ik.md), as GLSL and C++ both see it: solvers, bindings of set 0, specialization
// and push constants. Every buffer is an array of vec4.
#ifndef SKITTER_IK_BATCH_H
#define SKITTER_IK_BATCH_H

#ifdef __cplusplus
namespace skitter::shared {
#define BATCH inline constexpr
#define BATCH_FUNCTION inline constexpr
#else
#define BATCH const
#define BATCH_FUNCTION
#endif

// In the order of ik::Solver.
BATCH int SOLVER_AUTOMATIC = 0;
BATCH int SOLVER_FABRIK = 1;
BATCH int SOLVER_DISSERTATION_KEEP = 2;
BATCH int SOLVER_DISSERTATION_EDGE = 3;
BATCH int SOLVER_CCD = 4;
BATCH int SOLVER_TRANSPOSE = 5;
BATCH int SOLVER_PSEUDOINVERSE = 6;
BATCH int SOLVER_DLS = 7;
BATCH int SOLVER_TARGET_ATTACHED = 8;
BATCH int SOLVER_TWO_BONE = 9;
BATCH int SOLVER_STRETCH_ALIGN = 10;
BATCH int SOLVER_ACTIVE_SET = 11;

BATCH float STOP_TOLERANCE = 0.0;
BATCH float STOP_CAP = 1.0;
BATCH float STOP_STALL = 2.0;
BATCH float STOP_UNREACHABLE = 3.0;
BATCH float STOP_SKIPPED = 4.0;
BATCH float STOP_HELD = 5.0;
BATCH float STOP_JUMPED = 6.0;

BATCH int BATCH_RIG = 0;
BATCH int BATCH_TARGET = 1;
BATCH int BATCH_BASE = 2;
BATCH int BATCH_STATE = 3;
BATCH int BATCH_STATE_OUT = 4;
BATCH int BATCH_JOINT_OUT = 5;
BATCH int BATCH_ROTATION_OUT = 6;
BATCH int BATCH_REPORT_OUT = 7;
BATCH int BATCH_SEED = 8;
BATCH int BATCH_REPORT = 9;
BATCH int BATCH_LIST = 10;  // uint: an indirect dispatch, then how many chains, then which
BATCH int BATCH_PACE = 11;
BATCH int BATCH_PACE_OUT = 12;

// Beside CONSTANT_BONES, CONSTANT_LIMITS_LOW, CONSTANT_LIMITS_HIGH and CONSTANT_SOLVER.
BATCH int CONSTANT_PREVIOUS = 8;     // solves continue
BATCH int CONSTANT_BASES = 9;        // each chain has a base
BATCH int CONSTANT_ROTATIONS = 10;   // rotations are written
BATCH int CONSTANT_TWISTS = 11;      // a bone has a twist range
BATCH int CONSTANT_STRAIGHT = 12;    // a start pose may be straight
BATCH int CONSTANT_POLE = 13;        // there is a pole
BATCH int CONSTANT_REST_LEGAL = 14;  // no limit forbids the rest pose
BATCH int CONSTANT_PULL = 15;        // the rest pull acts
BATCH int CONSTANT_PASS = 16;
BATCH int CONSTANT_PADDED = 17;    // a bone may have no length
BATCH int CONSTANT_STEPS = 18;     // made in a row, before any in a loop
BATCH int CONSTANT_PARALLEL = 19;  // a bit a bone: a hinge about the x axis of the bone before
BATCH int CONSTANT_CHORDS = 20;    // chord steps after a step, at most
BATCH int CONSTANT_AIMED = 21;     // seeds are turned about the base to point at the target

// One dispatch solves all, or a quick one does what most chains need and lists those that need more, which a
// second one then solves from the start: on devices that mask lanes, rare code is paid for by all.
BATCH int PASS_WHOLE = 0;
BATCH int PASS_QUICK = 1;
BATCH int PASS_LISTED = 2;
BATCH int LIST_COUNT = 3;
BATCH int LIST_FIRST = 4;

// state of a limited chain, in vec4: directions of two bones each (stereographic), twists of four bones each
// (tan(tau/2), where there are any). Of a free one: p_1 .. p_n about a base at 0.
BATCH_FUNCTION int stateTwists(int bones) { return (bones + 1) / 2; }
BATCH_FUNCTION int stateStride(int bones, bool twists) {
  return (bones + 1) / 2 + (twists ? (bones + 3) / 4 : 0);
}
// seed: directions and twists as in the state, then p_1 .. p_n, lengths in units of the reach; beside the
// last one (|p_n|^2 + 0.1 mean |p_i|^2) / 2. Where seeds are aimed (|p_i|, 0, 0) stands for p_i.
BATCH_FUNCTION int seedStride(int bones, bool twists) { return stateStride(bones, twists) + bones; }
// After all seeds, a float a cell of the cube from -1 to 1, x first: the seed whose tip is nearest to its
// middle, or -1: rest. Where seeds are aimed, as many cells of |target|, from 0 to 1.
BATCH int SEED_CELLS = 16;  // each way
// report: error, iterations, stop + STOPS * (solves to come without restarts + PAUSES * the next pause),
// damping.
// pace, where solves continue: the last target about a base at 0, lengths in units of the reach; how far
// targets go in a solve, or 0: there was no solve yet.
BATCH float STOPS = 8.0;
BATCH float PAUSES = 64.0;
BATCH float LONGEST_PAUSE = 32.0;
BATCH int BASE_STRIDE = 2;
BATCH int SEEDS_MOST = 64;
BATCH int CHORDS_MOST = 3;

// What docs/ik.md calls the pace.
BATCH float GEAR = 8.0;          // of a joint's way to its target's
BATCH float FAST_TARGET = 0.01;  // its way in a solve, from which on joints are not held
BATCH float RECOVERY = 1.5;      // of the pace, a solve whose target stands still
BATCH float UNHELD = 1000.0;     // a pace at which nothing is held
BATCH float LEAST_GAIN = 0.05;   // of a joint's way, where the target stands still
BATCH float STILL = 1e-6;        // a way that may be rounding
BATCH float ROUNDING = 2e-6;     // an error that may be
BATCH int PACE_CORRECTIONS = 4;
// tan(theta / 2) of a free ball, which crosses the point opposite to its rest direction.
BATCH float WIDEST_FREE = 1e4;

struct BatchConstants {
#ifdef __cplusplus
  uint32_t count, iterations, seeds;
#else
  uint count, iterations, seeds;
#endif
  float tolerance, reach, restPull;
  float poleX, poleY, poleZ;  // 0: none
};

// A tree is a body with its legs.
struct TreeConstants {
#ifdef __cplusplus
  uint32_t count, iterations;
#else
  uint count, iterations;
#endif
  float tolerance, reach;  // of the longest leg
  float anchor;            // 0: the body floats, 1: it stays
};

#ifdef __cplusplus
}  // namespace skitter::shared
#endif
#endif
