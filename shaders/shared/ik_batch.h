// The batch of chains (docs/ik.md), as GLSL and C++ both see it: solvers, bindings of set 0, specialization and
// push constants. Every buffer is an array of vec4.
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

BATCH int BATCH_RIG = 0;
BATCH int BATCH_TARGET = 1;
BATCH int BATCH_BASE = 2;
BATCH int BATCH_STATE = 3;
BATCH int BATCH_STATE_OUT = 4;
BATCH int BATCH_JOINT_OUT = 5;
BATCH int BATCH_ROTATION_OUT = 6;
BATCH int BATCH_REPORT_OUT = 7;
BATCH int BATCH_SEED = 8;

// Beside CONSTANT_BONES, CONSTANT_LIMITS_LOW, CONSTANT_LIMITS_HIGH and CONSTANT_SOLVER.
BATCH int CONSTANT_PREVIOUS = 8;   // solves continue
BATCH int CONSTANT_BASES = 9;      // each chain has a base
BATCH int CONSTANT_ROTATIONS = 10; // rotations are written
BATCH int CONSTANT_TWISTS = 11;    // a bone has a twist range

// state of a limited chain, in vec4: directions of two bones each (stereographic), twists of four bones each
// (tan(tau/2), where there are any), then the ticks without restarts that are left and their next number.
// Of a free one: p_1 .. p_n about a base at 0.
BATCH_FUNCTION int stateTwists(int bones) { return (bones + 1) / 2; }
BATCH_FUNCTION int stateMemory(int bones, bool twists) {
  return (bones + 1) / 2 + (twists ? (bones + 3) / 4 : 0);
}
BATCH_FUNCTION int stateStride(int bones, bool twists) { return stateMemory(bones, twists) + 1; }
// seed: directions and twists as in the state, then p_1 .. p_n, lengths in units of the reach.
BATCH_FUNCTION int seedStride(int bones, bool twists) { return stateMemory(bones, twists) + bones; }
BATCH int BASE_STRIDE = 2;
BATCH int SEEDS_MOST = 64;

struct BatchConstants {
#ifdef __cplusplus
  uint32_t count, iterations, seeds;
#else
  uint count, iterations, seeds;
#endif
  float tolerance, reach, restPull;
  float poleX, poleY, poleZ;  // 0: none
};

#ifdef __cplusplus
}  // namespace skitter::shared
#endif
#endif
