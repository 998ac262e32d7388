#pragma once

#include <algorithm>
#include <cmath>

#include "cpu_reference/ik/solve.h"

namespace skitter::reference {

template <typename State>
struct IkLoop {
  State best;
  double error = 0;  // of the best
  int iterations = 0;
  IkStop stop = IkStop::cap;
};

// The loop of every solver but the active set: iterates from `state`, which is `start` but for its deadlock,
// until its error is within the tolerance, changes no more, or `most` iterations are done. The best state is
// kept, the first of equals. errorOf: State -> double; iterate: (int k, State&), k from 0. The first `freely`
// iterations may leave the error where it is.
template <typename State, typename ErrorOf, typename Iterate>
IkLoop<State> iterateUntilDone(const IkSettings& settings, int most, const State& start, State state,
                               ErrorOf errorOf, Iterate iterate, int freely = 0) {
  IkLoop<State> loop{start, errorOf(start)};
  double before = errorOf(state), change = before;
  const double tolerance = settings.tolerance, leastChange = std::max(1e-3 * tolerance, 3e-7);
  while (isOpen(settings, loop.iterations, loop.error) && loop.iterations < most) {
    if (loop.iterations > freely && change < leastChange) {
      loop.stop = IkStop::stall;
      return loop;
    }
    iterate(loop.iterations++, state);
    const double after = errorOf(state);
    change = std::abs(before - after);
    before = after;
    if (after < loop.error) {
      loop.best = state;
      loop.error = after;
    }
  }
  if (loop.error <= tolerance) loop.stop = IkStop::tolerance;
  return loop;
}

}  // namespace skitter::reference
