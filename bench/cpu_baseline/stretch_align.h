#pragma once

#include "bench/cpu_baseline/refill.h"

namespace skitter::baseline {

// The shortest rotation of unit a onto unit b. By its axis and not by 1 / (1 + a.b), of which near opposite
// directions single precision leaves too little for a rotation that keeps lengths.
template <class F>
Mat3<F> shortest(const Vec3<F>& a, const Vec3<F>& b) {
  const F c = dot(a, b), k = F(1) - c;
  const Vec3<F> w = cross(a, b), m = normalized(w);
  Mat3<F> turn{{c + k * m.x * m.x, k * m.x * m.y + w.z, k * m.x * m.z - w.y},
               {k * m.x * m.y - w.z, c + k * m.y * m.y, k * m.y * m.z + w.x},
               {k * m.x * m.z + w.y, k * m.y * m.z - w.x, c + k * m.z * m.z}};
  const auto opposite = c < F(-0.999999f);
  if (!any(opposite)) return turn;
  const auto alongY = F(0.9f) < absolute(a.y);
  const Vec3<F> h = normalized(select(alongY, Vec3<F>{F(0), -a.z, a.y}, Vec3<F>{a.z, F(0), -a.x}));
  const F two(2);
  turn.x = select(opposite, {two * h.x * h.x - F(1), two * h.x * h.y, two * h.x * h.z}, turn.x);
  turn.y = select(opposite, {two * h.x * h.y, two * h.y * h.y - F(1), two * h.y * h.z}, turn.y);
  turn.z = select(opposite, {two * h.x * h.z, two * h.y * h.z, two * h.z * h.z - F(1)}, turn.z);
  return turn;
}

// docs/ik.md, "Stretch-align": how far a chain must be stretched or folded along its own line for its tip to
// be as far away as the target, then all of it turned. The parts of its bones' directions along that line
// and across it lie in memory; a Newton pass streams over them.
template <class F, int N>
class StretchAlign {
 public:
  StretchAlign(const Model& model, float tolerance)
      : model_(model), bones_(boneCount<N>(model)), tolerance_(tolerance) {}

  // Moves the joints p_1 .. p_n of all lanes.
  [[gnu::flatten]] void operator()(Vec3<F>* joints, const Vec3<F>& target) {
    split(joints);
    const F distance = length(target);
    stretch(smaller(distance, F(0.99999f)));
    const Vec3<F> tip = line_ * along_ + across_;
    const Vec3<F> from = select(dot(tip, tip) < F(1e-12f), line_, normalized(tip));
    const Vec3<F> to = select(distance < F(1e-6f), from, normalized(target));
    const Mat3<F> turn = shortest(from, to);
    Vec3<F> place{F(0), F(0), F(0)};
    for (int i = 0; i < bones(); ++i) {
      const Vec3<F> direction = b_[i] + line_ * (a_[i] + lambda_);
      joints[i] = place = place + turn * ofLength(direction, model_.bone[i].length);
    }
  }

 private:
  static constexpr int kPasses = 8;

  int bones() const { return N > 0 ? N : bones_; }

  void split(const Vec3<F>* joints) {
    Vec3<F> direction[kCapacity<N>], last = joints[0];
    direction[0] = normalized(last);
    for (int i = 1; i < bones(); ++i) {
      direction[i] = normalized(joints[i] - last);
      last = joints[i];
    }
    line_ = select(dot(last, last) < F(1e-12f), direction[0], normalized(last));
    F bend(0);
    for (int i = 0; i < bones(); ++i) {
      a_[i] = dot(direction[i], line_);
      b_[i] = direction[i] - line_ * a_[i];
      bb_[i] = dot(b_[i], b_[i]);
      bend = bend + bb_[i];
    }
    const auto straight = bend < F(float(bones()) * 0.02f * 0.02f);
    if (bones() > 1 && any(straight)) giveBend(straight);
  }

  void giveBend(const Mask<F>& straight) {
    const Vec3<F> side = anyPerpendicular(line_);
    for (int i = 0; i < bones(); ++i) {
      const F amount(0.1f * (1 - 2 * float(i) / float(bones() - 1)));
      b_[i] = select(straight, b_[i] + side * amount, b_[i]);
      bb_[i] = dot(b_[i], b_[i]);
      const F along = squareRoot(larger(F(1) - bb_[i], F(0)));
      a_[i] = select(straight, select(a_[i] < F(0), -along, along), a_[i]);
    }
  }

  // Newton on 1 / sqrt(1 - s), which is nearly linear in lambda near full stretch.
  void stretch(const F& distance) {
    const F wanted = rsqrt(F(1) - distance), unknown(1e30f);
    F low = -unknown, high = unknown;
    lambda_ = F(0);
    for (int pass = 0;; ++pass) {
      const Slope s = measure();
      const auto open = F(0.2f * tolerance_) <= absolute(s.length - distance);
      if (pass + 1 == kPasses || !any(open)) return;  // what is left is FABRIK's
      const auto isShort = s.length < distance;
      low = select(isShort, lambda_, low);
      high = select(isShort, high, lambda_);
      const F f = rsqrt(larger(F(1) - s.length, F(1e-9f)));
      const F next = lambda_ - (f - wanted) / (f * f * f * s.slope * F(0.5f));
      const F beyond = select(-unknown < low, low + F(1), high - F(1));
      const F middle = select((-unknown < low) & (high < unknown), (low + high) * F(0.5f), beyond);
      const F safe = select((low < next) & (next < high), next, middle);
      lambda_ = select(open, larger(safe, F(-3)), lambda_);
    }
  }

  // s(lambda) and s'(lambda); leaves the tip's parts along the line and across it.
  struct Slope {
    F length, slope;
  };
  Slope measure() {
    F g(0), gSlope(0);
    Vec3<F> h{F(0), F(0), F(0)}, hSlope = h;
    for (int i = 0; i < bones(); ++i) {
      const F v = a_[i] + lambda_;
      const F rho = rsqrt(larger(v * v + bb_[i], F(1e-12f)));
      const F share = rho * F(model_.bone[i].length), cubed = share * rho * rho;
      g = g + share * v;
      gSlope = gSlope + cubed * bb_[i];
      h = h + b_[i] * share;
      hSlope = hSlope - b_[i] * (cubed * v);
    }
    along_ = g;
    across_ = h;
    const F s = squareRoot(g * g + dot(h, h));
    return {s, (g * gSlope + dot(h, hSlope)) / larger(s, F(1e-6f))};
  }

  const Model& model_;
  const int bones_;
  const float tolerance_;
  Vec3<F> line_, across_, b_[kCapacity<N>];
  F along_, lambda_, a_[kCapacity<N>], bb_[kCapacity<N>];
};

}  // namespace skitter::baseline
