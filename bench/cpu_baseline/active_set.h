#pragma once

#include <limits>
#include <type_traits>

#include "bench/cpu_baseline/active_set_step.h"

namespace skitter::baseline {

// Steps of an active set, with restarts (docs/ik.md, "Active set").
template <class F, int N>
class ActiveSet : private ActiveSetStep<F, N> {
 public:
  using Lane = F;
  using State = typename ActiveSetStep<F, N>::State;

  using ActiveSetStep<F, N>::ActiveSetStep;

  [[gnu::flatten]] uint64_t start(State& state, size_t chain, size_t count) {
    const auto open = this->startTogether(state.posture, state.target, state.error, chain);
    state.damping = F(1);
    state.iterations = state.attempt = F(0);
    state.begun = F(-1);
    state.goal = state.target;
    state.shape = F(0);
    uint64_t waiting = bits(open & firstLanes<F>(count));
    if (continues()) return waiting;
    for (uint64_t left = waiting; left != 0; left &= left - 1) {
      const int i = std::countr_zero(left), seed = this->model_.seedNear(laneOf(state.target, i));
      if (seed < 0) continue;
      enter(seed, state, i);
      lane(state.begun, i) = float(seed);
    }
    if (this->model_.aimed && waiting != 0) waiting = stepTogether(state, chain, waiting);
    return waiting;
  }

  [[gnu::flatten]] uint64_t step(State& state) const {
    const F tolerance(this->options_.tolerance);
    Posture<F, N> trial;
    this->move(state, trial);
    const F before = state.error, after = length(state.goal - trial.joint[this->bones() - 1]);
    const auto undone = (F(1.0001f) * before < after) & (tolerance < after);
    this->keep(!undone, trial, state.posture);
    state.error = select(undone, before, after);
    state.damping =
        select(undone, smaller(F(16) * state.damping, F(4096)), larger(state.damping * F(0.1f), F(1)));
    state.iterations = state.iterations + F(1);
    state.attempt = state.attempt + F(1);
    return bits((state.error <= tolerance) | (F(float(this->options_.iterations)) <= state.iterations) |
                (F(0.8f) * before < state.error) | (F(8) <= state.attempt));
  }

  // An attempt is over: the chain is finished, or begins anew from the next seed.
  bool settle(State& state, int i, size_t chain) {
    Attempts& attempts = attempts_[i];
    aim(state, i);
    const bool over = lane(state.error, i) <= this->options_.tolerance ||
                      lane(state.iterations, i) >= float(this->options_.iterations);
    if (!over && begin(attempts, state, i, chain)) return false;
    finish(attempts, state, i, chain);
    attempts.made = 0;
    return true;
  }

 private:
  using ActiveSetStep<F, N>::kMostBones;

  // What becomes of a chain whose first attempt failed.
  struct Attempts {
    int made = 0;  // restarts
    float error;   // of the best pose so far
    Vec3<float> d[kMostBones], joint[kMostBones];
    float twist[kMostBones];
    alignas(64) float distance[Model::kSeeds];  // of the seeds not yet tried
  };

  bool continues() const { return this->options_.start == Start::previous; }

  // A pose of another attempt makes the chain jump; where it follows a target it must be worth that.
  bool replaces(const Attempts& attempts, float error) const {
    return attempts.made == 0 || error < (continues() ? 0.3f : 1.0f) * attempts.error;
  }

  // Starts the next attempt; false if there is none.
  bool begin(Attempts& attempts, State& state, int i, size_t chain) {
    if (continues() && this->batch_.patience.at(0, chain) > 0) return false;
    if (attempts.made == 0) {
      measureSeeds(attempts, state, i, chain);
      const int begun = int(lane(state.begun, i));
      if (begun >= 0) attempts.distance[begun] = std::numeric_limits<float>::infinity();
    }
    const int seed = nearest(attempts.distance, this->model_.seeds);
    if (seed < 0) return false;
    // An attempt's last pose is its best one, to the 1e-4 that a step may lose.
    if (replaces(attempts, lane(state.error, i))) remember(attempts, state, i);
    attempts.distance[seed] = std::numeric_limits<float>::infinity();
    ++attempts.made;
    enter(seed, state, i);
    return lane(state.error, i) > this->options_.tolerance || !aim(state, i);
  }

  static int nearest(const float* distance, int seeds) {
    int best = -1;
    float least = std::numeric_limits<float>::infinity();
    for (int s = 0; s < seeds; ++s) {
      if (distance[s] < least) least = distance[best = s];
    }
    return best;
  }

  // |tip_s - t|^2 + 0.3 mean |p_s,i - p_i|^2 of all seeds, p the start pose; of shapes with lengths in place
  // of places.
  void measureSeeds(Attempts& attempts, const State& state, int i, size_t chain) const {
    using V = std::conditional_t<std::is_same_v<F, float>, float, Lanes>;
    const int n = this->bones();
    const bool shapes = this->model_.aimed;
    const auto compared = [&](const Vec3<float>& p) { return shapes ? Vec3<float>{length(p), 0, 0} : p; };
    const Vec3<V> target = broadcast<V>(compared(laneOf(state.target, i)));
    const Posture<float, N> begun = startOf(chain);
    for (int s = 0; s < Model::kSeeds; s += kWidth<V>) {
      V apart(0);
      Vec3<V> joint{V(0), V(0), V(0)};
      for (int b = 0; b < n; ++b) {
        this->model_.seedRows.load(joint.x, shapes ? 6 * n + b : 3 * b, s);
        if (!shapes) {
          this->model_.seedRows.load(joint.y, 3 * b + 1, s);
          this->model_.seedRows.load(joint.z, 3 * b + 2, s);
        }
        const Vec3<V> gap = joint - broadcast<V>(compared(begun.joint[b]));
        apart = apart + dot(gap, gap);
      }
      const Vec3<V> gap = joint - target;
      const V distance = dot(gap, gap) + V(0.3f / float(n)) * apart;
      for (int k = 0; k < kWidth<V>; ++k) attempts.distance[s + k] = lane(distance, k);
    }
  }

  Posture<float, N> startOf(size_t chain) const {
    Posture<float, N> posture;
    LimitedChain<float, N>(this->model_, this->options_, this->batch_).loadPose(posture, chain);
    return posture;
  }

  void remember(Attempts& attempts, const State& state, int i) const {
    attempts.error = lane(state.error, i);
    for (int b = 0; b < this->bones(); ++b) {
      attempts.d[b] = laneOf(state.posture.d[b], i);
      attempts.joint[b] = laneOf(state.posture.joint[b], i);
      attempts.twist[b] = lane(state.posture.twist[b], i);
    }
  }

  void enter(int seed, State& state, int i) const {
    Posture<float, N> posture;
    const int n = this->bones();
    const Rows& rows = this->model_.seedRows;
    for (int b = 0; b < n; ++b) {
      posture.d[b] = directionOf(rows.at(3 * (n + b), seed), rows.at(3 * (n + b) + 1, seed));
      posture.twist[b] = rows.at(3 * (n + b) + 2, seed);
      posture.joint[b] = {rows.at(3 * b, seed), rows.at(3 * b + 1, seed), rows.at(3 * b + 2, seed)};
    }
    copyRows(posture, state.posture, i);
    const Vec3<float> target = laneOf(state.target, i), tip = posture.joint[n - 1];
    const bool shape = this->model_.aimed;
    const Vec3<float> goal = shape ? tip * (length(target) * inverseLength(tip)) : target;
    setLane(state.goal, i, goal);
    lane(state.shape, i) = shape;
    lane(state.error, i) = length(goal - tip);
    lane(state.damping, i) = 1;
    lane(state.attempt, i) = 0;
  }

  // Turns what an attempt made of a shape about the free base to point at the target. Whether the chain is
  // there.
  bool aim(State& state, int i) const {
    if (lane(state.shape, i) != 0) {
      Posture<float, N> posture;
      for (int b = 0; b < this->bones(); ++b) {
        posture.d[b] = laneOf(state.posture.d[b], i);
        posture.twist[b] = lane(state.posture.twist[b], i);
        posture.joint[b] = laneOf(state.posture.joint[b], i);
      }
      const Vec3<float> target = laneOf(state.target, i);
      turnToward(target, posture);
      copyRows(posture, state.posture, i);
      setLane(state.goal, i, target);
      lane(state.shape, i) = 0;
      lane(state.error, i) = length(target - posture.joint[this->bones() - 1]);
    }
    return lane(state.error, i) <= this->options_.tolerance;
  }

  template <class G>
  void turnToward(const Vec3<G>& target, Posture<G, N>& posture) const {
    const BoneModel& base = this->model_.bone[0];
    const int n = this->bones();
    const Mat3<G> rest = broadcast<G>(base.carry), before = turnedFrame(base, rest, posture.d[0], G(0));
    const Vec3<G> to = within(rest, normalized(target));
    const Vec3<G> from = within(before, normalized(posture.joint[n - 1]));
    const G x = to.x - from.x, y = to.y - from.y, z = to.z + from.z, across = x * x + y * y;
    const G scale = G(1) / larger(z * z + across, G(1e-20f));
    posture.d[0] =
        clampBall(base, Vec3<G>{(x + x) * z * scale, (y + y) * z * scale, (z * z - across) * scale});
    const Mat3<G> after = turnedFrame(base, rest, posture.d[0], G(0));
    for (int b = 0; b < n; ++b) posture.joint[b] = after * within(before, posture.joint[b]);
  }
  template <class G>
  static Vec3<G> within(const Mat3<G>& frame, const Vec3<G>& v) {
    return {dot(frame.x, v), dot(frame.y, v), dot(frame.z, v)};
  }
  static void setLane(Vec3<F>& v, int i, const Vec3<float>& to) {
    lane(v.x, i) = to.x, lane(v.y, i) = to.y, lane(v.z, i) = to.z;
  }

  // The first step of shapes, of all chains that start together: most are there after it. Those that are not
  // are returned.
  uint64_t stepTogether(State& state, size_t chain, uint64_t waiting) {
    const F tolerance(this->options_.tolerance);
    const auto begun = state.error <= tolerance;
    if (any(!begun)) step(state);
    state.iterations = select(begun, F(0), state.iterations);
    auto there = state.error <= tolerance;
    if ((bits(there) & waiting) == 0) return waiting;
    Posture<F, N> turned = state.posture;
    turnToward(state.target, turned);
    const F error = length(state.target - turned.joint[this->bones() - 1]);
    there = there & (error <= tolerance);
    const uint64_t arrived = bits(there) & waiting;
    if (waiting == (~uint64_t(0) >> (64 - kWidth<F>))) {
      this->writeTogether(turned, error, state.iterations, F(float(Stop::tolerance)), chain);
      return waiting & ~arrived;
    }
    for (uint64_t left = arrived; left != 0; left &= left - 1) {
      const int i = std::countr_zero(left);
      writePose(turned, i, chain + i);
      this->write(chain + i, lane(error, i), lane(state.iterations, i), Stop::tolerance);
    }
    return waiting & ~arrived;
  }

  void writePose(const Posture<F, N>& posture, int i, size_t chain) {
    for (int b = 0; b < this->bones(); ++b)
      this->writeBone(chain, b, laneOf(posture.d[b], i), lane(posture.twist[b], i),
                      laneOf(posture.joint[b], i));
  }

  static void copyRows(const Posture<float, N>& from, Posture<F, N>& to, int i) {
    constexpr int kRows = sizeof(from) / sizeof(float);
    const float* source = reinterpret_cast<const float*>(&from);
    float* target = reinterpret_cast<float*>(&to) + i;
    for (int row = 0; row < kRows; ++row) target[row * kWidth<F>] = source[row];
  }

  void finish(const Attempts& attempts, const State& state, int i, size_t chain) {
    float error = lane(state.error, i);
    const bool last = replaces(attempts, error);
    if (last) {
      writePose(state.posture, i, chain);
    } else {
      for (int b = 0; b < this->bones(); ++b)
        this->writeBone(chain, b, attempts.d[b], attempts.twist[b], attempts.joint[b]);
    }
    if (!last) error = attempts.error;
    const float iterations = lane(state.iterations, i);
    const Stop stop = this->stopOf(error, iterations, laneOf(state.target, i));
    this->write(chain, error, iterations, stop);
    updatePatience(attempts.made > 0 && stop != Stop::tolerance, stop == Stop::tolerance, chain);
  }

  // After an attempt in vain none is made for 4, 8, 16, at most 32 ticks.
  void updatePatience(bool inVain, bool reached, size_t chain) {
    float& left = this->batch_.patience.at(0, chain);
    float& last = this->batch_.patience.at(1, chain);
    if (!continues() || reached) {
      left = last = 0;
    } else if (inVain) {
      left = last = larger(4.0f, smaller(2 * last, 32.0f));
    } else if (left > 0) {
      left -= 1;
    }
  }

  Attempts attempts_[kWidth<F>];
};

}  // namespace skitter::baseline
