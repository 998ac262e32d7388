#pragma once

#include "skitter/enum_names.h"

namespace skitter {

// A way to solve inverse kinematics. docs/ik.md states the equations and their sources.
enum class Solver {
  automatic,  // stretchAlign for free chains, activeSet for limited ones: what measures best
  fabrik,
  dissertationKeep,  // FABRIK as the dissertation has it: a joint outside its cone keeps its position,
  dissertationEdge,  // or moves to the cone's closest edge
  ccd,
  transpose,
  pseudoinverse,
  dampedLeastSquares,
  targetAttached,
  twoBone,       // free chains of two bones
  stretchAlign,  // free chains
  activeSet,
};
inline constexpr std::array allSolvers = {Solver::automatic,
                                          Solver::fabrik,
                                          Solver::dissertationKeep,
                                          Solver::dissertationEdge,
                                          Solver::ccd,
                                          Solver::transpose,
                                          Solver::pseudoinverse,
                                          Solver::dampedLeastSquares,
                                          Solver::targetAttached,
                                          Solver::twoBone,
                                          Solver::stretchAlign,
                                          Solver::activeSet};
constexpr const char* nameOf(Solver solver) {
  constexpr std::array names = {
      "auto",          "fabrik", "dissertation-keep", "dissertation-edge", "ccd",           "transpose",
      "pseudoinverse", "dls",    "target-attached",   "two-bone",          "stretch-align", "active-set"};
  static_assert(names.size() == allSolvers.size());
  return names[static_cast<size_t>(solver)];
}
constexpr std::optional<Solver> solverNamed(std::string_view name) { return enumNamed(allSolvers, name); }

// Those that the legs of a herd can be solved by.
inline constexpr std::array herdSolvers = {
    Solver::activeSet,          Solver::fabrik,        Solver::ccd, Solver::transpose, Solver::pseudoinverse,
    Solver::dampedLeastSquares, Solver::targetAttached};

}  // namespace skitter
