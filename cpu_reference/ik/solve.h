#pragma once

#include <algorithm>
#include <limits>
#include <optional>

#include "cpu_reference/ik/chain.h"
#include "cpu_reference/ik/jacobian.h"

// A whole solve of docs/ik.md.
namespace skitter::reference {

enum class IkSolver {
  fabrik,
  dissertationKeep,
  dissertationEdge,
  ccd,
  transpose,
  pseudoinverse,
  dls,
  targetAttached,
  twoBone,
  stretchAlign,
  activeSet,
};

enum class IkStop { tolerance, cap, stall, unreachable, skipped, held, jumped };

struct IkSettings {
  IkSolver solver = IkSolver::activeSet;
  double tolerance = 9e-4;  // share of the length
  int iterations = 64;      // at most, of all attempts
  bool restarts = true;     // of the active set, from the chain's seeds
  bool continues = false;   // the start pose is the last solve's result
  double restPull = 0;      // of the active set, share of the angle from rest
};

// Whether a solve goes on at `error` after `iterations`. One that continues another makes an iteration even
// within the tolerance, so that a slow target does not leave the chain standing and then have it step.
inline bool isOpen(const IkSettings& settings, int iterations, double error) {
  constexpr double rounding = 2e-6;
  return error > (settings.continues && iterations == 0 ? std::min(rounding, settings.tolerance)
                                                        : settings.tolerance);
}

// What a solve that continues another one knows of it.
struct IkMemory {
  int pause = 0;                                          // solves to come without a restart
  int nextPause = 0;                                      // after restarts in vain; 0, 1, 2, 4 up to 32
  std::optional<glm::dvec3> target;                       // of the last solve
  double pace = std::numeric_limits<double>::infinity();  // how far targets go in a solve
};

struct IkResult {
  IkState state;
  double error = 0;  // share of the length; 0 where skipped
  int iterations = 0;
  IkStop stop = IkStop::skipped;
};

// Whether `solver` can solve `chain`: two bones in closed form and stretch-align are for free chains, the
// active set is for limited ones, the dissertation's are for cones and free bones without twist.
bool accepts(const IkChain& chain, IkSolver solver);

// Whether the state is joints: of free chains, and of the dissertation, which knows no frames.
bool movesJoints(const IkChain& chain, const IkSettings& settings);

// The Jacobian family's member of a solver's name.
Jacobian methodOf(IkSolver solver);

// One iteration, the k-th (from 0) of its solve, of any solver. `target` is finite and in the chain's
// lengths.
void iterate(const IkChain& chain, const IkSettings& settings, const glm::dvec3& target, int k,
             IkState& state);

// std::invalid_argument where the chain does not accept the solver. `start` is clamped first. `memory`
// matters where a solve continues another.
IkResult solveIk(const IkChain& chain, const IkSettings& settings, const glm::dvec3& target,
                 const IkState& start, IkMemory& memory);

}  // namespace skitter::reference
