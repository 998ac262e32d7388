#pragma once

#include <string>

#include "bench/cpu_baseline/chain.h"

namespace skitter::baseline {

enum class Solver { fabrik, stretchAlign, activeSet };
enum class Start { rest, previous };
enum class Stop { skipped, tolerance, unreachable, cap, stall };

struct Options {
  Solver solver = Solver::fabrik;
  Start start = Start::rest;
  float tolerance = 9e-4f;  // share of the chain's length
  int iterations = 64;      // at most
  // Active set: share of the angle from rest taken back a step near the target; solves make at least one
  // then.
  float restPull = 0;
};

// Chains of one model, each toward a target of its own. Lengths are shares of the chain's length, axes the
// chain's own, its base is at 0. With Start::previous joints (free chains) or pose (limited ones) are where
// the solve begins; either way they are where it ends.
struct Batch {
  size_t chains = 0;
  Rows target;    // x, y, z
  Rows joints;    // p_1 .. p_n, three a joint
  Rows pose;      // limited chains: X, Y, tan(twist / 2), three a bone
  Rows outcome;   // error, iterations, stop
  Rows patience;  // limited chains: ticks for which no restart is made, and how many the last time

  Batch(const Model& model, size_t count);

  float error(size_t chain) const { return outcome.at(0, chain); }
  int iterations(size_t chain) const { return int(outcome.at(1, chain)); }
  Stop stop(size_t chain) const { return Stop(int(outcome.at(2, chain))); }
};

// One chain after the other.
void solveScalar(const Model& model, const Options& options, Batch& batch);

// Many chains at once, a lane that is done taking the next chain; the batch is shared out evenly among
// `threads`. Solvers and counts are those of solveScalar, results differ by rounding.
void solveSimd(const Model& model, const Options& options, Batch& batch, int threads = 1);

// What the library was compiled with and for, for reports: flags, compiler, floats a register.
std::string buildDescription();

}  // namespace skitter::baseline
