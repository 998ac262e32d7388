#pragma once

#include "bench/cpu_crowd/layout.h"
#include "bench/cpu_crowd/rig.h"

// docs/stages.md, ik, for cones, in stereographic directions: no sine, no cosine, no square root where a
// direction is turned. Only the columns need the joints' frames; where the tip alone is asked for, it is
// carried from foot to root as one vector, a third of the work.
namespace skitter::cpu_crowd {

template <int N>
int boneCountOf(const LegModel& leg) {
  return N > 0 ? N : int(leg.bones.size());
}
inline constexpr int kMostBones = 15;
template <int N>
inline constexpr int kBones = N > 0 ? N : kMostBones;

// Symmetric 3 x 3.
template <class F>
struct Symmetric {
  F xx, xy, xz, yy, yz, zz;

  void add(const Vec3<F>& c) {
    xx = xx + c.x * c.x;
    xy = xy + c.x * c.y;
    xz = xz + c.x * c.z;
    yy = yy + c.y * c.y;
    yz = yz + c.y * c.z;
    zz = zz + c.z * c.z;
  }
  Symmetric inverse() const {
    const F a = yy * zz - yz * yz, b = yz * xz - xy * zz, c = xy * yz - xz * yy;
    const F k = reciprocal(xx * a + xy * b + xz * c);
    return {k * a, k * b, k * c, k * (xx * zz - xz * xz), k * (xy * xz - xx * yz), k * (xx * yy - xy * xy)};
  }
  Vec3<F> operator*(const Vec3<F>& v) const {
    return {xx * v.x + xy * v.y + xz * v.z, xy * v.x + yy * v.y + yz * v.z, xz * v.x + yz * v.y + zz * v.z};
  }
};

// Directions (X, Y), and 2 / (1 + X^2 + Y^2).
template <class F, int N>
struct Directions {
  F x[kBones<N>], y[kBones<N>], k[kBones<N>];

  void set(int i, const F& newX, const F& newY) {
    x[i] = newX;
    y[i] = newY;
    k[i] = reciprocal(newX * newX + newY * newY + 1.0f) * 2.0f;
  }
};

template <class F>
Mat3<F> broadcast(const Mat3<float>& m) {
  return {broadcast<F>(m.x), broadcast<F>(m.y), broadcast<F>(m.z)};
}

// The tip from the directions alone.
template <class F, int N>
Vec3<F> tipOf(const LegModel& leg, const Directions<F, N>& d) {
  Vec3<F> v{F(0), F(0), F(0)};
  for (int i = boneCountOf<N>(leg) - 1; i >= 0; --i) {
    const BoneModel& bone = leg.bones[i];
    v.z = v.z + bone.length;
    const F t = d.k[i] * (v.z - d.x[i] * v.x - d.y[i] * v.y);
    v = broadcast<F>(bone.carry) * Vec3<F>{v.x + t * d.x[i], v.y + t * d.y[i], t - v.z};
  }
  return v;
}

// What forward kinematics leave for the columns: where each bone starts, and what it turns about as its
// direction goes the way of X, and of Y.
template <class F, int N>
struct Kinematics {
  Vec3<F> joint[kBones<N>], aboutX[kBones<N>], aboutY[kBones<N>], tip;
};

template <class F, int N>
void forward(const LegModel& leg, const Directions<F, N>& d, Kinematics<F, N>& kinematics) {
  Mat3<F> a = broadcast<F>(leg.bones[0].carry);
  Vec3<F> p{F(0), F(0), F(0)};
  const int n = boneCountOf<N>(leg);
  for (int i = 0; i < n; ++i) {
    kinematics.joint[i] = p;
    kinematics.aboutX[i] = a.y - a.z * d.y[i];
    kinematics.aboutY[i] = a.z * d.x[i] - a.x;
    const Vec3<F> w = (a.x * d.x[i] + a.y * d.y[i] + a.z) * d.k[i];
    const Mat3<F> f{a.x - w * d.x[i], a.y - w * d.y[i], w - a.z};
    p = p + f.z * leg.bones[i].length;
    if (i + 1 == n) break;
    const Mat3<F> c = broadcast<F>(leg.bones[i + 1].carry);
    a = {f * c.x, f * c.y, f * c.z};
  }
  kinematics.tip = p;
}

// (X, Y) within a cone, of a direction given as n (d.x, d.y), n (1 + d.z).
template <class F, int N>
void setClamped(const BoneModel& bone, const F& x, const F& y, const F& below, const F& n, int i,
                Directions<F, N>& to) {
  const F s2 = x * x + y * y;
  const auto outside = below * below * (bone.edge * bone.edge) < s2;
  const F inside = reciprocal(larger(below, 1e-6f));
  if (!any(outside)) return to.set(i, x * inside, y * inside);
  const F scale = select(outside, rsqrt(larger(s2, 1e-20f)) * bone.edge, inside);
  // Straight against the rest direction every way is as good.
  const auto against = outside & (s2 < n * n * 1e-6f) & (below < n);
  to.set(i, select(against, F(bone.edge), x * scale), select(against, F(0), y * scale));
}

// The chart of a step (x, y) from bone i's direction in `from`.
template <class F, int N>
void turn(const BoneModel& bone, const Directions<F, N>& from, int i, const F& x, const F& y,
          Directions<F, N>& to) {
  const F m = from.k[i] - from.k[i] * (from.x[i] * x + from.y[i] * y);
  const F n2 = x * x + y * y + 1.0f, n = n2 * rsqrt(n2);
  setClamped(bone, m * from.x[i] + x, m * from.y[i] + y, n + m - 1.0f, n, i, to);
}

template <class F>
struct Tuning {
  F pull;  // toward rest, a step
  float tolerance;
  int chords;
};

// One damped step with an active set of limits, and its chord steps, from `d`. On return `d`, `tip` and
// `error` are the new ones where they are better.
template <class F, int N>
[[gnu::flatten]] void activeSet(const LegModel& leg, const Vec3<F>& target, const Tuning<F>& tuning,
                                const Kinematics<F, N>& at, Directions<F, N>& d, Vec3<F>& tip, F& error,
                                F& damping) {
  constexpr int kMost = kBones<N>;
  const int n = boneCountOf<N>(leg);
  Vec3<F> columnX[kMost], columnY[kMost], e = target - at.tip;
  const F e2 = dot(e, e), mu = (smaller(e2, 0.25f) * 0.25f + 1e-5f) * damping;
  Symmetric<F> m{mu, F(0), F(0), mu, F(0), mu};
  e = e * smaller(F(1), rsqrt(larger(e2, 1e-20f)) * 0.5f);
  F pull[kMost];  // a share of the direction
  for (int i = 0; i < n; ++i) {
    const BoneModel& bone = leg.bones[i];
    const Vec3<F> r = at.tip - at.joint[i];
    columnX[i] = cross(at.aboutX[i], r);
    columnY[i] = cross(at.aboutY[i], r);
    m.add(columnX[i]);
    m.add(columnY[i]);
    pull[i] = d.k[i] * (tuning.pull * -bone.stiffness);
    e = e - (columnX[i] * d.x[i] + columnY[i] * d.y[i]) * pull[i];
  }
  Symmetric<F> inverse = m.inverse();
  Vec3<F> lambda = inverse * e;

  // Radially outward a bone has so much room; what is held there leaves the others to do the rest.
  F outX[kMost], outY[kMost], sine[kMost], end[kMost];
  Mask<F> held[kMost];
  F over[kMost], cosine[kMost];
  for (int i = 0; i < n; ++i) {
    const F s2 = d.x[i] * d.x[i] + d.y[i] * d.y[i], size = rsqrt(larger(s2, 1e-20f)), edge(leg.bones[i].edge);
    const auto atRest = s2 < F(1e-13f);
    outX[i] = select(atRest, F(1), d.x[i] * size);
    outY[i] = select(atRest, F(0), d.y[i] * size);
    // tan(alpha - theta) = sine / cosine by half tangents; unlimited near a right angle and beyond.
    const F s = s2 * size, to = edge - s, rest = edge * s + 1.0f;
    sine[i] = to * rest * 2.0f;
    cosine[i] = rest * rest - to * to;
    over[i] = (rest * rest + to * to) * 0.1f;
    held[i] = F(1) < F(0);
    end[i] = F(0);
  }
  for (int pass = 1; pass < 3; ++pass) {
    auto more = F(1) < F(0);
    for (int i = 0; i < n; ++i) {
      const F across = outX[i] * dot(columnX[i], lambda) + outY[i] * dot(columnY[i], lambda);
      const F z = pull[i] * (outX[i] * d.x[i] + outY[i] * d.y[i]);
      const auto leaves = (!held[i]) & (over[i] <= cosine[i]) & (sine[i] < (z + across) * cosine[i]);
      if (!any(leaves)) continue;
      const F room = sine[i] * reciprocal(cosine[i]);
      const Vec3<F> column = columnX[i] * outX[i] + columnY[i] * outY[i];
      const F taken = select(leaves, F(1), F(0));
      const Vec3<F> gone = column * taken;
      m.xx = m.xx - gone.x * column.x;
      m.xy = m.xy - gone.x * column.y;
      m.xz = m.xz - gone.x * column.z;
      m.yy = m.yy - gone.y * column.y;
      m.yz = m.yz - gone.y * column.z;
      m.zz = m.zz - gone.z * column.z;
      e = e - gone * (room - z);
      end[i] = select(leaves, room, end[i]);
      held[i] = held[i] | leaves;
      more = more | leaves;
    }
    if (!any(more)) break;
    inverse = m.inverse();
    lambda = inverse * e;
  }

  F x[kMost], y[kMost];
  Directions<F, N> trial;
  for (int i = 0; i < n; ++i) {
    x[i] = pull[i] * d.x[i] + dot(columnX[i], lambda);
    y[i] = pull[i] * d.y[i] + dot(columnY[i], lambda);
    const F back = select(held[i], end[i] - (outX[i] * x[i] + outY[i] * y[i]), F(0));
    x[i] = x[i] + back * outX[i];
    y[i] = y[i] + back * outY[i];
    turn(leg.bones[i], d, i, x[i], y[i], trial);
  }
  Vec3<F> reached = tipOf(leg, trial);
  for (int chord = 0; chord < tuning.chords; ++chord) {
    lambda = inverse * (target - reached);
    for (int i = 0; i < n; ++i) {
      const F moreX = dot(columnX[i], lambda), moreY = dot(columnY[i], lambda);
      const F back = select(held[i], outX[i] * moreX + outY[i] * moreY, F(0));
      x[i] = x[i] + moreX - back * outX[i];
      y[i] = y[i] + moreY - back * outY[i];
      turn(leg.bones[i], d, i, x[i], y[i], trial);
    }
    reached = tipOf(leg, trial);
  }

  const F after = length(target - reached);
  const auto kept = (after <= error * 1.0001f) | (after <= F(tuning.tolerance));
  for (int i = 0; i < n; ++i) {
    d.x[i] = select(kept, trial.x[i], d.x[i]);
    d.y[i] = select(kept, trial.y[i], d.y[i]);
  }
  tip = select(kept, reached, at.tip);
  error = select(kept, after, error);
  damping = select(kept, larger(damping * 0.1f, 1), smaller(damping * 16.0f, 4096));
}

template <class F, int N>
Directions<F, N> directionsOf(const LegModel& leg, const Chain<F, kBones<N>>& chain) {
  Directions<F, N> d;
  for (int i = 0; i < boneCountOf<N>(leg); ++i) d.set(i, chain.x[i], chain.y[i]);
  return d;
}

template <class F>
Vec3<F> targetOf(const LegModel& leg, const Mat3<F>& r, const Foot<F>& foot) {
  return (transposedTimes(r, foot.target) - broadcast<F>(leg.root)) * (1 / leg.reach);
}

template <class F, int N>
void store(const LegModel& leg, const Mat3<F>& r, const Directions<F, N>& d, const Vec3<F>& tip,
           const F& error, Chain<F, kBones<N>>& chain) {
  for (int i = 0; i < boneCountOf<N>(leg); ++i) {
    chain.x[i] = d.x[i];
    chain.y[i] = d.y[i];
  }
  chain.tip = r * (broadcast<F>(leg.root) + tip * leg.reach);
  chain.error = error * leg.reach;
}

// A straight chain with its target nearer on the same line would never bend.
template <class F, int N>
Mask<F> deadlocked(const LegModel& leg, const Vec3<F>& target, const Kinematics<F, N>& at) {
  const F tip2 = dot(at.tip, at.tip);
  F off(0);
  for (int i = 1; i < boneCountOf<N>(leg); ++i) {
    const Vec3<F> away = cross(at.tip, at.joint[i]);
    off = larger(off, dot(away, away));
  }
  return (off < tip2 * 1e-6f) & (dot(target, target) < tip2 * (0.999f * 0.999f));
}

template <class F>
Mask<F> finite(const Vec3<F>& v) {
  const Vec3<F> zero = v - v;
  return zero.x + zero.y + zero.z <= F(0);
}

// Step 3 alone, for the legs of a block that need no more. `rare` is told which lanes need more, before
// anything is written; what is written there is of no use.
template <class F, int N, class Rare>
[[gnu::flatten]] void ikQuick(const World& world, const LegModel& leg, const Mat3<F>& r, const Foot<F>& foot,
                              Chain<F, kBones<N>>& chain, const Rare& rare) {
  Directions<F, N> d = directionsOf<F, N>(leg, chain);
  Kinematics<F, N> at;
  forward(leg, d, at);
  const Vec3<F> target = targetOf(leg, r, foot);
  F error = length(target - at.tip);
  const auto usual = finite(target) & !deadlocked(leg, target, at) & (error <= F(world.q.approachError));
  if (any(!usual)) rare(bits(!usual));
  chain.before = error * leg.reach;
  const F pull = select(error < F(world.q.pullError), F(world.chords > 0 ? world.q.restPull : 0), F(0));
  Vec3<F> tip;
  activeSet(leg, target, {pull, world.q.ikTolerance, world.chords}, at, d, tip, error, chain.damping);
  store(leg, r, d, tip, error, chain);
}

// ---- the rare legs, all steps

template <int N>
void bend(const LegModel& leg, Directions<float, N>& d) {
  const int n = boneCountOf<N>(leg);
  for (int i = 0; i < n; ++i) {
    const float x = d.x[i] + (i == 0 ? -0.025f * float(n - 1) : 0.05f), y = d.y[i],
                k = 2 / (1 + x * x + y * y);
    setClamped(leg.bones[i], k * x, k * y, k, 1.0f, i, d);
  }
}

template <int N>
void fabrik(const LegModel& leg, const Vec3<float>& target, Directions<float, N>& d,
            Kinematics<float, N>& at) {
  const int n = boneCountOf<N>(leg);
  Vec3<float> q[kBones<N>], end = target;
  for (int i = n - 1; i >= 0; --i) {
    q[i] = end;
    end = placeToward(end, at.joint[i], leg.bones[i].length);
  }
  Mat3<float> f{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  Vec3<float> p{0, 0, 0};
  for (int i = 0; i < n; ++i) {
    const BoneModel& bone = leg.bones[i];
    const Mat3<float> a{f * bone.carry.x, f * bone.carry.y, f * bone.carry.z};
    const Vec3<float> v = q[i] - p, u = transposedTimes(a, normalized(v));
    if (length(v) >= 1e-6f) setClamped(bone, u.x, u.y, 1 + u.z, 1.0f, i, d);
    const Vec3<float> w = (a.x * d.x[i] + a.y * d.y[i] + a.z) * d.k[i];
    f = {a.x - w * d.x[i], a.y - w * d.y[i], w - a.z};
    p = p + f.z * bone.length;
  }
  forward(leg, d, at);
}

// A target that is not finite leaves the pose as it is.
template <int N>
void ikWhole(const World& world, const LegModel& leg, const Mat3<float>& r, const Foot<float>& foot,
             Chain<float, kBones<N>>& chain) {
  Directions<float, N> d = directionsOf<float, N>(leg, chain);
  Kinematics<float, N> at;
  forward(leg, d, at);
  const Vec3<float> target = targetOf(leg, r, foot);
  chain.before = 0;
  if (!finite(target)) return store(leg, r, d, at.tip, 0.0f, chain);
  float error = length(target - at.tip);
  chain.before = error * leg.reach;
  if (deadlocked(leg, target, at)) {
    bend(leg, d);
    forward(leg, d, at);
    error = length(target - at.tip);
  }
  Directions<float, N> trial = d;
  Kinematics<float, N> trialAt = at;
  for (int i = 0; i < world.approach && error > world.q.approachError; ++i) {
    fabrik(leg, target, trial, trialAt);
    const float e = length(target - trialAt.tip);
    if (!(e < error)) continue;
    d = trial;
    at = trialAt;
    error = e;
  }
  const float pull = world.chords > 0 && error < world.q.pullError ? world.q.restPull : 0;
  Vec3<float> tip;
  activeSet(leg, target, {pull, world.q.ikTolerance, world.chords}, at, d, tip, error, chain.damping);
  store(leg, r, d, tip, error, chain);
}

}  // namespace skitter::cpu_crowd
