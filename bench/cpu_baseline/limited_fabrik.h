#pragma once

#include <algorithm>

#include "bench/cpu_baseline/posture.h"

namespace skitter::baseline {

// FABRIK whose pass from base to tip keeps every bone within its limit (docs/ik.md, "FABRIK").
template <class F, int N>
class LimitedFabrik : private LimitedChain<F, N> {
 public:
  using Lane = F;
  struct State {
    using Lane = F;
    Vec3<F> target;
    Vec3<F> joint[kCapacity<N>], d[kCapacity<N>], bestJoint[kCapacity<N>], bestD[kCapacity<N>];
    F twist[kCapacity<N>];  // stays
    F error, bestError, iterations;
  };

  using LimitedChain<F, N>::LimitedChain;

  [[gnu::flatten]] uint64_t start(State& state, size_t chain, size_t count) {
    Posture<F, N> posture;
    const auto open = this->startTogether(posture, state.target, state.error, chain);
    for (int b = 0; b < this->bones(); ++b) {
      state.joint[b] = state.bestJoint[b] = posture.joint[b];
      state.d[b] = state.bestD[b] = posture.d[b];
      state.twist[b] = posture.twist[b];
    }
    state.bestError = state.error;
    state.iterations = F(0);
    return bits(open & firstLanes<F>(count));
  }

  [[gnu::flatten]] uint64_t step(State& state) const {
    const int n = this->bones();
    iterate(state);
    const F before = state.error;
    state.error = length(state.target - state.joint[n - 1]);
    state.iterations = state.iterations + F(1);
    const auto better = state.error < state.bestError;
    for (int b = 0; b < n; ++b) {
      state.bestJoint[b] = select(better, state.joint[b], state.bestJoint[b]);
      state.bestD[b] = select(better, state.d[b], state.bestD[b]);
    }
    state.bestError = smaller(state.error, state.bestError);
    const F stalled(std::max(1e-3f * this->options_.tolerance, 3e-7f));
    return bits((state.error <= F(this->options_.tolerance)) | (absolute(before - state.error) < stalled) |
                (F(float(this->options_.iterations)) <= state.iterations));
  }

  bool settle(const State& state, int i, size_t chain) {
    for (int b = 0; b < this->bones(); ++b) {
      this->writeBone(chain, b, laneOf(state.bestD[b], i), lane(state.twist[b], i),
                      laneOf(state.bestJoint[b], i));
    }
    const float error = lane(state.bestError, i), iterations = lane(state.iterations, i);
    this->write(chain, error, iterations, this->stopOf(error, iterations, laneOf(state.target, i)));
    return true;
  }

 private:
  void iterate(State& state) const {
    const int n = this->bones();
    const Model& model = this->model_;
    Vec3<F> back[kCapacity<N>];  // q_1 .. q_n
    back[n - 1] = state.target;
    for (int i = n - 1; i >= 1; --i)
      back[i - 1] = placeToward(back[i], state.joint[i - 1], model.bone[i].length);
    Mat3<F> frame = broadcast<F>(model.bone[0].carry);
    Vec3<F> place{F(0), F(0), F(0)};
    for (int i = 0; i < n; ++i) {
      const BoneModel& bone = model.bone[i];
      if (bone.turns) state.d[i] = clampSwing(bone, aimed(bone, frame, back[i] - place, state.d[i]));
      const Mat3<F> turned = turnedFrame(bone, frame, state.d[i], state.twist[i]);
      state.joint[i] = place = place + along(bone, turned);
      if (i + 1 < n) frame = product(turned, model.bone[i + 1].carry);
    }
  }

  // The swing that points a bone along `gap`; the old one where that has no direction.
  static Vec3<F> aimed(const BoneModel& bone, const Mat3<F>& frame, const Vec3<F>& gap, const Vec3<F>& old) {
    // Made unit here and not before: what rounding leaves of the frame would double from bone to bone.
    Vec3<F> v = normalized(transposedTimes(frame, gap));
    auto none = dot(gap, gap) < F(1e-12f);
    if (bone.kind == LimitKind::hinge) {
      const F square = v.y * v.y + v.z * v.z, inverse = rsqrt(larger(square, F(1e-20f)));
      none = none | (square < F(1e-12f));
      v = {F(0), v.y * inverse, v.z * inverse};
    }
    return select(none, old, v);
  }
};

}  // namespace skitter::baseline
