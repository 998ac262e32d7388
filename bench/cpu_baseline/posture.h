#pragma once

#include "bench/cpu_baseline/limits.h"

namespace skitter::baseline {

// Where limited chains stand: of every bone the unit swing direction in its frame, tan(twist / 2), and the
// joint at its end. Frames are found anew where they are needed, which is cheaper than carrying them about.
template <class F, int N>
struct Posture {
  Vec3<F> d[kCapacity<N>];
  F twist[kCapacity<N>];
  Vec3<F> joint[kCapacity<N>];
};

template <class F>
Mat3<F> broadcast(const Mat3<float>& m) {
  return {broadcast<F>(m.x), broadcast<F>(m.y), broadcast<F>(m.z)};
}
template <class F>
Mat3<F> product(const Mat3<F>& a, const Mat3<float>& b) {
  return {a * broadcast<F>(b.x), a * broadcast<F>(b.y), a * broadcast<F>(b.z)};
}

// 1 / (1 + d.z), of bones that may turn beyond a right angle by 1 - d.z^2 = d.x^2 + d.y^2: near a half turn
// single precision leaves nothing of 1 + d.z.
template <class F>
F swingScale(const BoneModel& bone, const Vec3<F>& d) {
  if (!bone.wide) return F(1) / (F(1) + d.z);
  const auto over = d.z < F(0);
  return select(over, F(1) - d.z, F(1)) / larger(select(over, d.x * d.x + d.y * d.y, F(1) + d.z), F(1e-6f));
}

// F_i = A_i S(d) Z(twist).
template <class F>
Mat3<F> turnedFrame(const BoneModel& bone, const Mat3<F>& a, const Vec3<F>& d, const F& tanHalfTwist) {
  if (bone.kind == LimitKind::hinge) return {a.x, a.y * d.z - a.z * d.y, a.y * d.y + a.z * d.z};
  const Vec3<F> aside = a.x * d.x + a.y * d.y;
  const Vec3<F> w = aside * swingScale(bone, d) + a.z;
  Mat3<F> frame{a.x - w * d.x, a.y - w * d.y, aside + a.z * d.z};
  if (!bone.twists) return frame;
  const F square = tanHalfTwist * tanHalfTwist, scale = F(1) / (F(1) + square);
  const F cosine = (F(1) - square) * scale, sine = (tanHalfTwist + tanHalfTwist) * scale;
  return {frame.x * cosine + frame.y * sine, frame.y * cosine - frame.x * sine, frame.z};
}

// From the bone's base to its end: l F o.
template <class F>
Vec3<F> along(const BoneModel& bone, const Mat3<F>& frame) {
  if (bone.offsetX == 0) return frame.z * F(bone.length);
  return frame.x * F(bone.length * bone.offsetX) + frame.z * F(bone.length * bone.offsetZ);
}

// Joints from directions and twists.
template <class F, int N>
void forward(const Model& model, Posture<F, N>& posture) {
  Mat3<F> frame = broadcast<F>(model.bone[0].carry);
  Vec3<F> place{F(0), F(0), F(0)};
  const int n = boneCount<N>(model);
  for (int i = 0; i < n; ++i) {
    const BoneModel& bone = model.bone[i];
    const Mat3<F> turned = turnedFrame(bone, frame, posture.d[i], posture.twist[i]);
    posture.joint[i] = place = place + along(bone, turned);
    if (i + 1 < n) frame = product(turned, model.bone[i + 1].carry);
  }
}

// (X, Y) to d, and back.
template <class F>
Vec3<F> directionOf(const F& x, const F& y) {
  const F square = x * x + y * y, scale = F(1) / (F(1) + square);
  return {(x + x) * scale, (y + y) * scale, (F(1) - square) * scale};
}
template <class F>
Vec3<F> stereographic(const BoneModel& bone, const Vec3<F>& d) {
  const F scale = swingScale(bone, d);
  return {d.x * scale, d.y * scale, F(0)};
}

// Reading limited chains from a batch, starting them, writing them: what their solvers share.
template <class F, int N>
class LimitedChain {
 public:
  LimitedChain(const Model& model, const Options& options, Batch& batch)
      : model_(model), options_(options), batch_(batch) {}

  // The start postures of the chains from `chain`, clamped.
  void loadPose(Posture<F, N>& posture, size_t chain) const {
    for (int b = 0; b < bones(); ++b) {
      if (options_.start == Start::rest || !model_.bone[b].turns) {
        posture.d[b] = {F(0), F(0), F(1)};
        posture.twist[b] = F(0);
      } else {
        F x, y;
        batch_.pose.load(x, 3 * b, chain);
        batch_.pose.load(y, 3 * b + 1, chain);
        batch_.pose.load(posture.twist[b], 3 * b + 2, chain);
        posture.d[b] = directionOf(x, y);
      }
      posture.d[b] = clampSwing(model_.bone[b], posture.d[b]);
      posture.twist[b] = clampTwist(model_.bone[b], posture.twist[b]);
    }
    forward(model_, posture);
  }

 protected:
  int bones() const { return boneCount<N>(model_); }

  // Targets and start postures, clamped, and where straight in front of their target bent; the chains that
  // are to be iterated. The others are written.
  Mask<F> startTogether(Posture<F, N>& posture, Vec3<F>& target, F& error, size_t chain) {
    batch_.target.load(target.x, 0, chain);
    batch_.target.load(target.y, 1, chain);
    batch_.target.load(target.z, 2, chain);
    loadPose(posture, chain);
    const Vec3<F> tip = posture.joint[bones() - 1];
    error = length(target - tip);
    const Vec3<F> zero = target - target;  // of a target that is not finite neither is this
    const auto finite = zero.x + zero.y + zero.z <= F(0);
    const auto open = finite & !(error <= F(options_.tolerance));
    const auto bent = open & isStraight(posture.joint, bones()) & (length(target) < F(0.999f) * length(tip));
    if (any(bent)) bend(posture, bent, target, error);
    const auto near = error <= F(options_.tolerance);
    const auto going = options_.restPull > 0 ? finite : open & !near;
    if (any(!going)) {
      const F stop = select(finite, F(float(Stop::tolerance)), F(float(Stop::skipped)));
      writeTogether(posture, error, F(0), stop, chain);
    }
    return going;
  }

  Stop stopOf(float error, float iterations, const Vec3<float>& target) const {
    if (error <= options_.tolerance) return Stop::tolerance;
    if (dot(target, target) > 1) return Stop::unreachable;
    return iterations >= float(options_.iterations) ? Stop::cap : Stop::stall;
  }

  void write(size_t chain, float error, float iterations, Stop stop) {
    batch_.outcome.at(0, chain) = error;
    batch_.outcome.at(1, chain) = iterations;
    batch_.outcome.at(2, chain) = float(stop);
  }
  void writeBone(size_t chain, int b, const Vec3<float>& d, float twist, const Vec3<float>& joint) {
    const Vec3<float> xy = stereographic(model_.bone[b], d);
    const float pose[3] = {xy.x, xy.y, twist}, place[3] = {joint.x, joint.y, joint.z};
    for (int k = 0; k < 3; ++k) {
      batch_.pose.at(3 * b + k, chain) = pose[k];
      batch_.joints.at(3 * b + k, chain) = place[k];
    }
  }

  void writeTogether(const Posture<F, N>& posture, const F& error, const F& iterations, const F& stop,
                     size_t chain) {
    for (int b = 0; b < bones(); ++b) {
      const Vec3<F> xy = stereographic(model_.bone[b], posture.d[b]);
      batch_.pose.store(xy.x, 3 * b, chain);
      batch_.pose.store(xy.y, 3 * b + 1, chain);
      batch_.pose.store(posture.twist[b], 3 * b + 2, chain);
      batch_.joints.store(posture.joint[b].x, 3 * b, chain);
      batch_.joints.store(posture.joint[b].y, 3 * b + 1, chain);
      batch_.joints.store(posture.joint[b].z, 3 * b + 2, chain);
    }
    batch_.outcome.store(error, 0, chain);
    batch_.outcome.store(iterations, 1, chain);
    batch_.outcome.store(stop, 2, chain);
  }

  const Model& model_;
  const Options& options_;
  Batch& batch_;

 private:
  void bend(Posture<F, N>& posture, const Mask<F>& mask, const Vec3<F>& target, F& error) const {
    Posture<F, N> arc = posture;
    for (int b = 0; b < bones(); ++b) {
      const BoneModel& bone = model_.bone[b];
      if (!bone.turns) continue;
      const F amount(0.05f - (b == 0 ? 0.025f * float(bones() - 1) : 0.0f));
      Vec3<F> xy = stereographic(model_.bone[b], posture.d[b]);
      (bone.kind == LimitKind::hinge ? xy.y : xy.x) = (bone.kind == LimitKind::hinge ? xy.y : xy.x) + amount;
      arc.d[b] = clampSwing(bone, directionOf(xy.x, xy.y));
    }
    forward(model_, arc);
    for (int b = 0; b < bones(); ++b) {
      posture.d[b] = select(mask, arc.d[b], posture.d[b]);
      posture.joint[b] = select(mask, arc.joint[b], posture.joint[b]);
    }
    error = select(mask, length(target - posture.joint[bones() - 1]), error);
  }
};

}  // namespace skitter::baseline
