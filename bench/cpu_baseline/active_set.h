#pragma once

#include <limits>
#include <type_traits>

#include "bench/cpu_baseline/normal.h"
#include "bench/cpu_baseline/posture.h"

namespace skitter::baseline {

inline constexpr float kUnlimited = 1e30f;

// The ways in which a chain's tip can move: of every degree of freedom the movement a radian, and how far it
// may turn. `bounded` is the same for all lanes.
template <class F, int N>
struct Columns {
  static constexpr int kMost = 3 * kCapacity<N>;
  int count = 0;
  bool bounded[kMost];
  Vec3<F> movement[kMost];
  F low[kMost], high[kMost];
  F pull[kMost];        // toward rest, where there is a rest pull
  F turn[kMost];        // what is found: by how much it turns
  Mask<F> free[kMost];  // not held at an end of its room

  void add(const Vec3<F>& c) {
    bounded[count] = false;
    append(c);
  }
  void add(const Vec3<F>& c, const F& lowest, const F& highest) {
    bounded[count] = true;
    low[count] = lowest;
    high[count] = highest;
    append(c);
  }

 private:
  void append(const Vec3<F>& c) {
    movement[count] = c;
    pull[count] = turn[count] = F(0);
    free[count++] = F(0) < F(1);
  }
};

// Damped least squares in which a joint that meets its limit is held there and what it could not do is handed
// to the others, with restarts (docs/ik.md, "Active set").
template <class F, int N>
class ActiveSet : private LimitedChain<F, N> {
 public:
  using Lane = F;
  struct State {
    using Lane = F;
    Posture<F, N> posture;
    Vec3<F> target;
    F error, damping, iterations;
    F attempt;     // this attempt's iterations
    F begun;       // the seed that the first attempt began at, or -1
    Vec3<F> goal;  // what this attempt strives for
    F shape;       // 1: it is a place as far away as the target, to which the pose is then turned
  };

  using LimitedChain<F, N>::LimitedChain;

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
    move(state, trial);
    const F before = state.error, after = length(state.goal - trial.joint[this->bones() - 1]);
    const auto undone = (F(1.0001f) * before < after) & (tolerance < after);
    keep(!undone, trial, state.posture);
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
  static constexpr int kMostBones = kCapacity<N>;

  // What becomes of a chain whose first attempt failed.
  struct Attempts {
    int made = 0;  // restarts
    float error;   // of the best pose so far
    Vec3<float> d[kMostBones], joint[kMostBones];
    float twist[kMostBones];
    alignas(64) float distance[Model::kSeeds];  // of the seeds not yet tried
  };

  // ---- one step

  void move(const State& state, Posture<F, N>& trial) const {
    Columns<F, N> columns;
    F ellipseR[kMostBones], ellipseT[kMostBones];
    Mat3<F> frame = broadcast<F>(this->model_.bone[0].carry);
    for (int b = 0; b < this->bones(); ++b) {
      const BoneModel& bone = this->model_.bone[b];
      const Mat3<F> turned = turnedFrame(bone, frame, state.posture.d[b], state.posture.twist[b]);
      if (bone.turns) addColumns(state.posture, b, frame, turned, columns, ellipseR[b], ellipseT[b]);
      if (b + 1 < this->bones()) frame = product(turned, this->model_.bone[b + 1].carry);
    }
    const F square = state.error * state.error;
    const F damping = (smaller(square * (square + F(0.25f)), F(1)) + F(1e-5f)) * state.damping;
    const Vec3<F> e = state.goal - state.posture.joint[this->bones() - 1];
    const Vec3<F> part = e * smaller(F(1), F(0.5f) * rsqrt(larger(square, F(1e-20f))));
    if (this->options_.restPull > 0) {
      pullToRest(state, ellipseR, ellipseT, columns);
      solve<true>(columns, part, damping);
    } else {
      solve<false>(columns, part, damping);
    }
    const F* turn = columns.turn;
    for (int b = 0; b < this->bones(); ++b) {
      turn += turnBone(state.posture, b, turn, ellipseR[b], ellipseT[b], trial);
    }
    forward(this->model_, trial);
  }

  static Turned<F> turned(const Vec3<F>& d) { return turnedOf(d, d.x * d.x + d.y * d.y < F(1e-12f)); }

  // `a`: A_b, `end`: F_b.
  void addColumns(const Posture<F, N>& posture, int b, const Mat3<F>& a, const Mat3<F>& end,
                  Columns<F, N>& columns, F& ellipseR, F& ellipseT) const {
    const BoneModel& bone = this->model_.bone[b];
    const Vec3<F>& d = posture.d[b];
    const Vec3<F> tip = posture.joint[this->bones() - 1], r = b == 0 ? tip : tip - posture.joint[b - 1];
    if (bone.kind == LimitKind::hinge) {
      columns.add(cross(a.x, r), hingeRoom(d, bone.lowSine, bone.lowCosine, -kUnlimited),
                  hingeRoom(d, bone.highSine, bone.highCosine, kUnlimited));
      return;
    }
    const Turned<F> h = turned(d);
    const Vec3<F> radial = cross(a.y * h.x - a.x * h.y, r);
    const Vec3<F> tangential = cross(a.z * (h.s / larger(F(1) + d.z, F(1e-6f))) - (a.x * h.x + a.y * h.y), r);
    if (bone.kind == LimitKind::ellipse) {
      const F room = ellipseRoom(bone, d, h, ellipseR, ellipseT);
      columns.add(radial * ellipseR + tangential * ellipseT, F(-kUnlimited), room);
      columns.add(tangential * ellipseR - radial * ellipseT);
    } else {
      const F scale = F(bone.coneCosine) * d.z + F(bone.coneSine) * h.s;
      const F room = (F(bone.coneSine) * d.z - F(bone.coneCosine) * h.s) / scale;
      columns.add(radial, F(-kUnlimited), select(scale < F(0.1f), F(kUnlimited), room));
      columns.add(tangential);
    }
    if (bone.twists) {
      columns.add(cross(end.z, r), twistRoom(posture.twist[b], bone.twistLowTanHalf, -kUnlimited),
                  twistRoom(posture.twist[b], bone.twistHighTanHalf, kUnlimited));
    }
  }

  // tan(end - q), with d = (0, -sin q, cos q).
  static F hingeRoom(const Vec3<F>& d, float endSine, float endCosine, float unlimited) {
    const F cosine = F(endCosine) * d.z - F(endSine) * d.y;
    return select(cosine < F(0.1f), F(unlimited), (F(endSine) * d.z + F(endCosine) * d.y) / cosine);
  }
  static F twistRoom(const F& tanHalf, float end, float unlimited) {
    const F scale = F(1) + F(end) * tanHalf;
    return select(scale < F(0.1f), F(unlimited), F(2) * (F(end) - tanHalf) / scale);
  }
  // (n_r, n_t) is the way out of the ellipse; the room is along it.
  static F ellipseRoom(const BoneModel& bone, const Vec3<F>& d, const Turned<F>& h, F& outR, F& outT) {
    const F theta = angleOf(h.s, d.z), vx = theta * h.x, vy = theta * h.y;
    const InverseAxes<F> axes = inverseAxes(bone, h);
    const F nx = vx * axes.x * axes.x, ny = vy * axes.y * axes.y;
    const F size = squareRoot(vx * nx + vy * ny);
    const F r = nx * h.x + ny * h.y, t = (ny * h.x - nx * h.y) * theta / larger(h.s, F(1e-6f));
    const F inverse = rsqrt(larger(r * r + t * t, F(1e-20f)));
    const auto atRest = theta < F(1e-3f);
    outR = select(atRest, F(1), r * inverse);
    outT = select(atRest, F(0), t * inverse);
    return select(atRest, F(kUnlimited), (F(1) - size) * size * inverse);
  }

  // What each column does toward rest, near the target and after a step that was kept.
  void pullToRest(const State& state, const F* ellipseR, const F* ellipseT, Columns<F, N>& columns) const {
    const auto near = (state.error < F(0.05f)) & (state.damping <= F(1));
    const F share = select(near, F(this->options_.restPull), F(0));
    F* pull = columns.pull;
    for (int b = 0; b < this->bones(); ++b) {
      const BoneModel& bone = this->model_.bone[b];
      const Vec3<F>& d = state.posture.d[b];
      if (!bone.turns) continue;
      if (bone.kind == LimitKind::hinge) {
        *pull++ = share * d.y;
        continue;
      }
      const F radial = -share * turned(d).s;
      const bool across = bone.kind == LimitKind::ellipse;
      pull[0] = across ? radial * ellipseR[b] : radial;
      if (across) pull[1] = -radial * ellipseT[b];
      pull += bone.twists ? 3 : 2;
    }
  }

  template <bool Pulled>
  static void solve(Columns<F, N>& columns, Vec3<F> e, const F& damping) {
    if constexpr (Pulled) {
      for (int c = 0; c < columns.count; ++c) e = e - columns.movement[c] * columns.pull[c];
    }
    Normal<F> open{damping, F(0), F(0), damping, F(0), damping};
    for (int c = 0; c < columns.count; ++c) {
      if (!columns.bounded[c]) open.add(columns.movement[c]);
    }
    Vec3<F> lambda = e;
    for (int pass = 0; pass < 3; ++pass) {
      Normal<F> normal = open;
      const Vec3<F> none{F(0), F(0), F(0)};
      for (int c = 0; c < columns.count; ++c) {
        if (columns.bounded[c]) normal.add(select(columns.free[c], columns.movement[c], none));
      }
      lambda = normal.solve(e, damping);
      if (!hold<Pulled>(columns, lambda, e)) break;
    }
    for (int c = 0; c < columns.count; ++c) {
      const F turn = turnOf<Pulled>(columns, c, lambda);
      columns.turn[c] = columns.bounded[c] ? select(columns.free[c], turn, columns.turn[c]) : turn;
    }
  }

  template <bool Pulled>
  static F turnOf(const Columns<F, N>& columns, int c, const Vec3<F>& lambda) {
    const F turn = dot(columns.movement[c], lambda);
    return Pulled ? turn + columns.pull[c] : turn;
  }

  // Holds the columns that leave their room, takes what they do from e; true if there are any.
  template <bool Pulled>
  static bool hold(Columns<F, N>& columns, const Vec3<F>& lambda, Vec3<F>& e) {
    uint64_t held = 0;
    for (int c = 0; c < columns.count; ++c) {
      if (!columns.bounded[c]) continue;
      const F turn = turnOf<Pulled>(columns, c, lambda);
      const F end = larger(smaller(turn, columns.high[c]), columns.low[c]);
      const auto leaves = columns.free[c] & ((end < turn) | (turn < end));
      columns.turn[c] = select(columns.free[c], end, columns.turn[c]);
      e = e - columns.movement[c] * select(leaves, Pulled ? end - columns.pull[c] : end, F(0));
      columns.free[c] = columns.free[c] & !leaves;
      held |= bits(leaves);
    }
    return held != 0;
  }

  // Turns bone b by the columns from `turn`; how many they are.
  int turnBone(const Posture<F, N>& posture, int b, const F* turn, const F& ellipseR, const F& ellipseT,
               Posture<F, N>& trial) const {
    const BoneModel& bone = this->model_.bone[b];
    const Vec3<F>& d = posture.d[b];
    trial.d[b] = d;
    trial.twist[b] = posture.twist[b];
    if (!bone.turns) return 0;
    if (bone.kind == LimitKind::hinge) {
      trial.d[b] = clampHinge(bone, normalized(Vec3<F>{F(0), d.y - turn[0] * d.z, d.z + turn[0] * d.y}));
      return 1;
    }
    F radial = turn[0], tangential = turn[1];
    if (bone.kind == LimitKind::ellipse) {
      radial = ellipseR * turn[0] - ellipseT * turn[1];
      tangential = ellipseT * turn[0] + ellipseR * turn[1];
    }
    const Turned<F> h = turned(d);
    const Vec3<F> away{h.x * d.z, h.y * d.z, -h.s}, around{-h.y, h.x, F(0)};
    trial.d[b] = clampBall(bone, normalized(d + away * radial + around * tangential));
    if (!bone.twists) return 2;
    trial.twist[b] = twisted(bone, posture.twist[b], turn[2]);
    return 3;
  }

  static F twisted(const BoneModel& bone, const F& tanHalf, const F& turn) {
    const F half = F(0.5f) * larger(smaller(turn, F(1)), F(-1)), scale = F(1) - tanHalf * half;
    const F nearer = select(turn < F(0), F(bone.twistLowTanHalf), F(bone.twistHighTanHalf));
    return clampTwist(bone, select(scale < F(0.1f), nearer, (tanHalf + half) / scale));
  }

  void keep(const Mask<F>& mask, const Posture<F, N>& trial, Posture<F, N>& posture) const {
    for (int b = 0; b < this->bones(); ++b) {
      posture.d[b] = select(mask, trial.d[b], posture.d[b]);
      posture.twist[b] = select(mask, trial.twist[b], posture.twist[b]);
      posture.joint[b] = select(mask, trial.joint[b], posture.joint[b]);
    }
  }

  // ---- restarts

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
