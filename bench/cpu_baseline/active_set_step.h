#pragma once

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

// One step of damped least squares in which a joint that meets its limit is held there and what it could not
// do is handed to the others (docs/ik.md, "Active set").
template <class F, int N>
class ActiveSetStep : protected LimitedChain<F, N> {
 public:
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

 protected:
  static constexpr int kMostBones = kCapacity<N>;

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
};

}  // namespace skitter::baseline
