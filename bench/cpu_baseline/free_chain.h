#pragma once

#include <algorithm>

#include "bench/cpu_baseline/stretch_align.h"

namespace skitter::baseline {

// Free chains: their state is their joints (docs/ik.md, "A solve", "FABRIK" and
// "Stretch-align").
template <class F, int N>
class FreeChain {
 public:
  using Lane = F;
  struct State {
    using Lane = F;
    Vec3<F> target;
    Vec3<F> joint[kCapacity<N>];  // p_1 .. p_n
    F error, iterations;
  };

  FreeChain(const Model& model, const Options& options, Batch& batch)
      : model_(model), options_(options), batch_(batch) {}

  [[gnu::flatten]] uint64_t start(State& state, size_t chain, size_t count) {
    load(state, chain);
    const F distance = length(state.target);
    const Vec3<F> zero = state.target - state.target;  // of a target that is not finite neither is this
    const auto finite = zero.x + zero.y + zero.z <= F(0);
    const auto arrived = state.error <= F(options_.tolerance);
    const auto beyond = finite & !arrived & (F(1) <= distance);
    auto open = finite & !arrived & (distance < F(1));
    if (any(beyond)) layStraight(state, beyond);
    const auto bent = open & isStraight(state.joint, bones()) & (distance < F(0.999f) * length(tip(state)));
    if (any(bent)) bend(state, bent);
    if (options_.solver == Solver::stretchAlign && options_.iterations > 0) stretchAlign(state, open);
    open = open & (F(options_.tolerance) < state.error) & (state.iterations < F(float(options_.iterations)));
    if (any(!open)) finishStarted(state, chain, finite, beyond);
    return bits(open & firstLanes<F>(count));
  }

  // The error never rises: a joint's nearest place on its neighbour's sphere is no further away than that
  // neighbour has moved, pass by pass. So the last pose is the best one.
  [[gnu::flatten]] uint64_t step(State& state) const {
    fabrik(state);
    const F before = state.error;
    state.error = length(state.target - tip(state));
    state.iterations = state.iterations + F(1);
    const F stalled = F(larger(1e-3f * options_.tolerance, 3e-7f));
    return bits((state.error <= F(options_.tolerance)) | (absolute(before - state.error) < stalled) |
                (F(float(options_.iterations)) <= state.iterations));
  }

  bool settle(const State& state, int i, size_t chain) {
    for (int b = 0; b < bones(); ++b) {
      batch_.joints.at(3 * b, chain) = lane(state.joint[b].x, i);
      batch_.joints.at(3 * b + 1, chain) = lane(state.joint[b].y, i);
      batch_.joints.at(3 * b + 2, chain) = lane(state.joint[b].z, i);
    }
    const float error = lane(state.error, i), iterations = lane(state.iterations, i);
    const Stop stop = error <= options_.tolerance                ? Stop::tolerance
                      : iterations >= float(options_.iterations) ? Stop::cap
                                                                 : Stop::stall;
    batch_.outcome.at(0, chain) = error;
    batch_.outcome.at(1, chain) = iterations;
    batch_.outcome.at(2, chain) = float(stop);
    return true;
  }

 private:
  int bones() const { return boneCount<N>(model_); }
  Vec3<F>& tip(State& state) const { return state.joint[bones() - 1]; }

  void load(State& state, size_t chain) const {
    batch_.target.load(state.target.x, 0, chain);
    batch_.target.load(state.target.y, 1, chain);
    batch_.target.load(state.target.z, 2, chain);
    for (int b = 0; b < bones(); ++b) {
      if (options_.start == Start::rest) {
        state.joint[b] = broadcast<F>(model_.restJoints[b]);
        continue;
      }
      batch_.joints.load(state.joint[b].x, 3 * b, chain);
      batch_.joints.load(state.joint[b].y, 3 * b + 1, chain);
      batch_.joints.load(state.joint[b].z, 3 * b + 2, chain);
    }
    state.error = length(state.target - tip(state));
    state.iterations = F(0);
  }

  void layStraight(State& state, const Mask<F>& mask) const {
    const Vec3<F> direction = normalized(state.target);
    float reach = 0;
    for (int b = 0; b < bones(); ++b) {
      reach += model_.bone[b].length;
      state.joint[b] = select(mask, direction * F(reach), state.joint[b]);
    }
    state.error = select(mask, length(state.target - tip(state)), state.error);
    state.iterations = select(mask, F(1), state.iterations);
  }

  // The way out of a deadlock: an arc instead of the line.
  void bend(State& state, const Mask<F>& mask) const {
    if (bones() < 2) return;
    const Vec3<F> side = anyPerpendicular(normalized(tip(state)));
    Vec3<F> old{F(0), F(0), F(0)}, place = old;
    for (int b = 0; b < bones(); ++b) {
      const Vec3<F> direction = normalized(state.joint[b] - old);
      const F amount(0.1f * (1 - 2 * float(b) / float(bones() - 1)));
      old = state.joint[b];
      place = place + normalized(direction + side * amount) * F(model_.bone[b].length);
      state.joint[b] = select(mask, place, state.joint[b]);
    }
    state.error = select(mask, length(state.target - tip(state)), state.error);
  }

  // Writes the whole block: chains that go on are written anew when they are done.
  void finishStarted(const State& state, size_t chain, const Mask<F>& finite, const Mask<F>& beyond) {
    const auto near = state.error <= F(options_.tolerance);
    F stop = select(beyond, F(float(Stop::unreachable)), F(float(Stop::cap)));
    stop = select(near, F(float(Stop::tolerance)), stop);
    for (int b = 0; b < bones(); ++b) {
      batch_.joints.store(state.joint[b].x, 3 * b, chain);
      batch_.joints.store(state.joint[b].y, 3 * b + 1, chain);
      batch_.joints.store(state.joint[b].z, 3 * b + 2, chain);
    }
    batch_.outcome.store(state.error, 0, chain);
    batch_.outcome.store(state.iterations, 1, chain);
    batch_.outcome.store(select(finite, stop, F(float(Stop::skipped))), 2, chain);
  }

  void stretchAlign(State& state, const Mask<F>& mask) const {
    Vec3<F> joint[kCapacity<N>];
    std::copy_n(state.joint, bones(), joint);
    StretchAlign<F, N>(model_, options_.tolerance)(joint, state.target);
    for (int b = 0; b < bones(); ++b) state.joint[b] = select(mask, joint[b], state.joint[b]);
    state.error = select(mask, length(state.target - tip(state)), state.error);
    state.iterations = select(mask, F(1), state.iterations);
  }

  void fabrik(State& state) const {
    const int n = bones();
    Vec3<F> back[kCapacity<N>];  // q_1 .. q_n; q_0 would serve nothing
    back[n - 1] = state.target;
#pragma GCC unroll 4
    for (int i = n - 1; i >= 1; --i)
      back[i - 1] = placeToward(back[i], state.joint[i - 1], model_.bone[i].length);
    Vec3<F> place{F(0), F(0), F(0)};
#pragma GCC unroll 4
    for (int i = 0; i < n; ++i)
      state.joint[i] = place = place + ofLength(back[i] - place, model_.bone[i].length);
  }

  const Model& model_;
  const Options& options_;
  Batch& batch_;
};

}  // namespace skitter::baseline
