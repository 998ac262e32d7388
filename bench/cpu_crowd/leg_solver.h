#pragma once

#include "bench/cpu_baseline/normal.h"
#include "bench/cpu_crowd/layout.h"
#include "bench/cpu_crowd/rig.h"

// docs/stages/ik.md, for cones. Directions stay stereographic, so no step needs a sine or a cosine. Only the
// columns need the bones' frames; where the tip alone is asked for it is carried from foot to root as one
// vector, a third of the work.
namespace skitter::cpu_crowd {

template <int N>
int boneCountOf(const LegModel& leg) {
  return N > 0 ? N : int(leg.bones.size());
}
inline constexpr int kMostBones = int(skitter::Leg::maxBones);
template <int N>
inline constexpr int kBones = N > 0 ? N : kMostBones;

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

// The tip from the directions alone.
template <class F, int N>
Vec3<F> tipOf(const LegModel& leg, const Directions<F, N>& d) {
  Vec3<F> v{F(0), F(0), F(0)};
#pragma GCC unroll 4
  for (int i = boneCountOf<N>(leg) - 1; i >= 0; --i) {
    const BoneModel& bone = leg.bones[i];
    v.z = v.z + bone.length;
    const F t = d.k[i] * (v.z - d.x[i] * v.x - d.y[i] * v.y);
    v = broadcast<F>(bone.carry) * Vec3<F>{v.x + t * d.x[i], v.y + t * d.y[i], t - v.z};
  }
  return v;
}

// Forward kinematics: visit(i, A_i, p_i) for each bone from the root.
template <int N, class F, class Visit>
void walk(const LegModel& leg, const Directions<F, N>& d, const Visit& visit) {
  Mat3<F> a = broadcast<F>(leg.bones[0].carry);
  Vec3<F> p{F(0), F(0), F(0)};
  const int n = boneCountOf<N>(leg);
#pragma GCC unroll 4
  for (int i = 0; i < n; ++i) {
    visit(i, a, p);
    if (i + 1 == n) break;
    const Vec3<F> w = (a.x * d.x[i] + a.y * d.y[i] + a.z) * d.k[i];
    const Mat3<F> f{a.x - w * d.x[i], a.y - w * d.y[i], w - a.z}, c = broadcast<F>(leg.bones[i + 1].carry);
    p = p + f.z * leg.bones[i].length;
    a = {f * c.x, f * c.y, f * c.z};
  }
}

// (X, Y) within a cone, of a direction given as n (d.x, d.y), n (1 + d.z), n > 0.
template <class F, int N>
void setClamped(const BoneModel& bone, const F& x, const F& y, const F& below, const F& inverseN, int i,
                Directions<F, N>& to) {
  // Beyond the cone |(x, y)| / edge is more than what is below.
  const F s2 = x * x + y * y, scale = rsqrt(larger(below * below, s2 * bone.inverseEdgeSquared));
  const F k = below * inverseN;
  to.x[i] = x * scale;
  to.y[i] = y * scale;
  to.k[i] = larger(k, bone.leastK);
  // Straight against the rest direction, k nearly 0, every way is as good.
  if (!any(k < F(1e-6f))) return;
  const auto against = (s2 * (inverseN * inverseN) < F(1e-6f)) & (k < F(1));
  to.x[i] = select(against, F(bone.edge), to.x[i]);
  to.y[i] = select(against, F(0), to.y[i]);
}

// The chart of a step (x, y) from bone i's direction in `from`.
template <class F, int N>
void turn(const BoneModel& bone, const Directions<F, N>& from, int i, const F& x, const F& y,
          Directions<F, N>& to) {
  const F m = from.k[i] - from.k[i] * (from.x[i] * x + from.y[i] * y);
  const F n2 = x * x + y * y + 1.0f, inverseN = rsqrt(n2);
  setClamped(bone, m * from.x[i] + x, m * from.y[i] + y, n2 * inverseN + (m - 1.0f), inverseN, i, to);
}

// What a step is made of, a bone: its columns, the step, and the share of the direction by which it is pulled
// to rest.
template <class F, int N>
struct Steps {
  Vec3<F> columnX[kBones<N>], columnY[kBones<N>];
  F x[kBones<N>], y[kBones<N>], pull[kBones<N>];
};

// Bones held at their cone: the way out of it, a unit vector.
template <class F, int N>
struct Held {
  Mask<F> held[kBones<N>];
  F outX[kBones<N>], outY[kBones<N>];

  // What a held bone may not do of a step.
  F blocked(int i, const F& x, const F& y) const { return select(held[i], outX[i] * x + outY[i] * y, F(0)); }
};

// The lanes in which a step may end at its cone. Half the angle left has a tangent of at least (edge - t) /
// (1 + edge^2), t that of half the angle from rest, and (edge - t)^2 is at least what its tangent (as a
// function of t^2) at 0.95 edge is.
template <class F>
Mask<F> mayMeetLimit(const BoneModel& bone, const F& dx, const F& dy, const F& x, const F& y) {
  constexpr float kNear = 0.95f;
  const float edge2 = bone.edge * bone.edge, scale = 1 / (bone.leastK * bone.leastK);
  return F(edge2 * (1 - kNear)) <= (x * x + y * y) * scale + (dx * dx + dy * dy) * (1 / kNear - 1);
}

// Holds the bones that leave their room and hands what they cannot do to the others. Of the damped system
// `m`, its inverse and `e` what is left of them are returned.
template <class F, int N>
void holdAtLimits(const LegModel& leg, const Directions<F, N>& d, Normal<F> m, Vec3<F> e, Steps<F, N>& steps,
                  Normal<F>& inverse, Held<F, N>& held) {
  constexpr int kMost = kBones<N>;
  const int n = boneCountOf<N>(leg);
  F room[kMost];
  Mask<F> limited[kMost];
  for (int i = 0; i < n; ++i) {
    const F s2 = d.x[i] * d.x[i] + d.y[i] * d.y[i], size = rsqrt(larger(s2, 1e-20f)), edge(leg.bones[i].edge);
    const auto atRest = s2 < F(1e-13f);
    held.outX[i] = select(atRest, F(1), d.x[i] * size);
    held.outY[i] = select(atRest, F(0), d.y[i] * size);
    held.held[i] = F(1) < F(0);
    // tan(alpha - theta) by half tangents; unlimited near a right angle and beyond.
    const F s = s2 * size, to = edge - s, over = edge * s + 1.0f, cosine = over * over - to * to;
    limited[i] = (over * over + to * to) * 0.1f <= cosine;
    room[i] = to * over * 2.0f * reciprocal(cosine);
  }
  for (int pass = 1; pass < 3; ++pass) {
    auto more = F(1) < F(0);
    for (int i = 0; i < n; ++i) {
      const F across = held.outX[i] * steps.x[i] + held.outY[i] * steps.y[i];
      const auto leaves = (!held.held[i]) & limited[i] & (room[i] < across);
      if (!any(leaves)) continue;
      const Vec3<F> column = steps.columnX[i] * held.outX[i] + steps.columnY[i] * held.outY[i];
      const Vec3<F> gone = column * select(leaves, F(1), F(0));
      m.remove(gone, column);
      e = e - gone * (room[i] - steps.pull[i] * (held.outX[i] * d.x[i] + held.outY[i] * d.y[i]));
      held.held[i] = held.held[i] | leaves;
      more = more | leaves;
    }
    if (!any(more)) return;
    inverse = m.inverse();
    const Vec3<F> lambda = inverse * e;
    for (int i = 0; i < n; ++i) {
      const F x = steps.pull[i] * d.x[i] + dot(steps.columnX[i], lambda);
      const F y = steps.pull[i] * d.y[i] + dot(steps.columnY[i], lambda);
      const F back = held.blocked(i, x, y) - select(held.held[i], room[i], F(0));
      steps.x[i] = x - back * held.outX[i];
      steps.y[i] = y - back * held.outY[i];
    }
  }
}

template <class F>
struct Tuning {
  F pull;  // toward rest, a step
  float tolerance;
  int chords;
};

// One damped step with an active set of limits, and its chord steps, from `d`, whose tip and error are given.
// On return all are the new ones where they are better, which is where the mask says so.
template <class F, int N>
[[gnu::flatten]] Mask<F> activeSet(const LegModel& leg, const Vec3<F>& target, const Tuning<F>& tuning,
                                   float damping, Directions<F, N>& d, Vec3<F>& tip, F& error) {
  const int n = boneCountOf<N>(leg);
  Steps<F, N> steps;
  Vec3<F> e = target - tip;
  const F e2 = dot(e, e), mu = (smaller(e2, 0.25f) * 0.25f + 1e-5f) * damping;
  Normal<F> m{mu, F(0), F(0), mu, F(0), mu};
  if (any(F(0.25f) < e2)) e = e * smaller(F(1), rsqrt(larger(e2, 1e-20f)) * 0.5f);
  walk<N>(leg, d, [&](int i, const Mat3<F>& a, const Vec3<F>& p) {
    // What the bone turns about as its direction goes the ways of X and of Y.
    const Vec3<F> aboutX = a.y - a.z * d.y[i], aboutY = a.z * d.x[i] - a.x, r = tip - p;
    steps.columnX[i] = cross(aboutX, r);
    steps.columnY[i] = cross(aboutY, r);
    m.add(steps.columnX[i]);
    m.add(steps.columnY[i]);
    steps.pull[i] = d.k[i] * (tuning.pull * -leg.bones[i].stiffness);
    e = e - (steps.columnX[i] * d.x[i] + steps.columnY[i] * d.y[i]) * steps.pull[i];
  });
  Normal<F> inverse = m.inverse();
  const Vec3<F> lambda = inverse * e;
  auto near = F(1) < F(0);
#pragma GCC unroll 4
  for (int i = 0; i < n; ++i) {
    steps.x[i] = steps.pull[i] * d.x[i] + dot(steps.columnX[i], lambda);
    steps.y[i] = steps.pull[i] * d.y[i] + dot(steps.columnY[i], lambda);
    near = near | mayMeetLimit(leg.bones[i], d.x[i], d.y[i], steps.x[i], steps.y[i]);
  }
  const bool holds = any(near);
  Held<F, N> held;
  if (holds) holdAtLimits(leg, d, m, e, steps, inverse, held);

  Directions<F, N> trial;
#pragma GCC unroll 4
  for (int i = 0; i < n; ++i) turn(leg.bones[i], d, i, steps.x[i], steps.y[i], trial);
  Vec3<F> reached = tipOf(leg, trial);
  for (int chord = 0; chord < tuning.chords; ++chord) {
    const Vec3<F> left = inverse * (target - reached);
#pragma GCC unroll 4
    for (int i = 0; i < n; ++i) {
      F x = dot(steps.columnX[i], left), y = dot(steps.columnY[i], left);
      if (holds) {
        const F back = held.blocked(i, x, y);
        x = x - back * held.outX[i];
        y = y - back * held.outY[i];
      }
      steps.x[i] = steps.x[i] + x;
      steps.y[i] = steps.y[i] + y;
      turn(leg.bones[i], d, i, steps.x[i], steps.y[i], trial);
    }
    reached = tipOf(leg, trial);
  }

  const F after = length(target - reached);
  const auto kept = (after <= error * 1.0001f) | (after <= F(tuning.tolerance));
#pragma GCC unroll 4
  for (int i = 0; i < n; ++i) {
    d.x[i] = select(kept, trial.x[i], d.x[i]);
    d.y[i] = select(kept, trial.y[i], d.y[i]);
  }
  tip = select(kept, reached, tip);
  error = select(kept, after, error);
  return kept;
}

template <class F, int N>
Directions<F, N> directionsOf(const LegModel& leg, const Chain<F, kBones<N>>& chain) {
  Directions<F, N> d;
  const int n = boneCountOf<N>(leg);
#pragma GCC unroll 4
  for (int i = 0; i < n; ++i) d.set(i, chain.x[i], chain.y[i]);
  return d;
}

template <class F>
Vec3<F> targetOf(const LegModel& leg, const Mat3<F>& r, const Foot<F>& foot) {
  return (transposedTimes(r, foot.target) - broadcast<F>(leg.root)) * (1 / leg.reach);
}

template <class F, int N>
void store(const LegModel& leg, const Directions<F, N>& d, const Vec3<F>& tip, const F& error,
           Chain<F, kBones<N>>& chain) {
  const int n = boneCountOf<N>(leg);
#pragma GCC unroll 4
  for (int i = 0; i < n; ++i) {
    chain.x[i] = d.x[i];
    chain.y[i] = d.y[i];
  }
  chain.tip = tip;
  chain.error = error;
}

// A straight chain with its target nearer on the same line would never bend. Few are straight, and their
// first joint tells.
template <class F, int N>
Mask<F> deadlocked(const LegModel& leg, const Vec3<F>& target, const Directions<F, N>& d,
                   const Vec3<F>& tip) {
  const F tip2 = dot(tip, tip);
  const auto onLine = [&](const Vec3<F>& joint) {
    const Vec3<F> away = cross(tip, joint);
    return dot(away, away) < tip2 * 1e-6f;
  };
  const Vec3<F> first =
      broadcast<F>(leg.bones[0].carry) * Vec3<F>{d.k[0] * d.x[0], d.k[0] * d.y[0], d.k[0] - 1.0f};
  auto stuck = dot(target, target) < tip2 * (0.999f * 0.999f);
  if (boneCountOf<N>(leg) > 1) stuck = stuck & onLine(first * leg.bones[0].length);
  if (!any(stuck)) return stuck;
  walk<N>(leg, d, [&](int i, const Mat3<F>&, const Vec3<F>& p) {
    if (i > 1) stuck = stuck & onLine(p);
  });
  return stuck;
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
  const Vec3<F> target = targetOf(leg, r, foot);
  Vec3<F> tip = chain.tip;
  F error = length(target - tip);
  auto usual = finite(target) & !deadlocked(leg, target, d, tip) & (error <= F(world.q.approachError));
  const F pull = select(error < F(world.q.pullError), F(world.chords > 0 ? world.q.restPull : 0), F(0));
  usual = usual & activeSet(leg, target, {pull, world.q.ikTolerance, world.chords}, 1.0f, d, tip, error);
  if (any(!usual)) rare(bits(!usual));
  store(leg, d, tip, error, chain);
}

// ---- the rare legs, all steps

template <int N>
void bend(const LegModel& leg, Directions<float, N>& d) {
  const int n = boneCountOf<N>(leg);
#pragma GCC unroll 4
  for (int i = 0; i < n; ++i) {
    const float x = d.x[i] + (i == 0 ? -0.025f * float(n - 1) : 0.05f), y = d.y[i],
                k = 2 / (1 + x * x + y * y);
    setClamped(leg.bones[i], k * x, k * y, k, 1.0f, i, d);
  }
}

template <int N>
void fabrik(const LegModel& leg, const Vec3<float>& target, Directions<float, N>& d) {
  Vec3<float> q[kBones<N>], end = target;  // q: where bone i should end
  walk<N>(leg, d, [&](int i, const Mat3<float>&, const Vec3<float>& p) { q[i] = p; });
  for (int i = boneCountOf<N>(leg) - 1; i >= 0; --i) {
    const Vec3<float> joint = q[i];
    q[i] = end;
    end = placeToward(end, joint, leg.bones[i].length);
  }
  // Each bone is turned before the walk goes on along it.
  walk<N>(leg, d, [&](int i, const Mat3<float>& a, const Vec3<float>& p) {
    const Vec3<float> v = q[i] - p, u = transposedTimes(a, normalized(v));
    if (length(v) >= 1e-6f) setClamped(leg.bones[i], u.x, u.y, 1 + u.z, 1.0f, i, d);
  });
}

// A target that is not finite leaves the pose as it is.
template <int N>
void ikWhole(const World& world, const LegModel& leg, const Mat3<float>& r, const Foot<float>& foot,
             Chain<float, kBones<N>>& chain) {
  Directions<float, N> d = directionsOf<float, N>(leg, chain);
  Vec3<float> tip = chain.tip;
  const Vec3<float> target = targetOf(leg, r, foot);
  if (!finite(target)) return store(leg, d, tip, 0.0f, chain);
  float error = length(target - tip);
  if (deadlocked(leg, target, d, tip)) {
    bend(leg, d);
    tip = tipOf(leg, d);
    error = length(target - tip);
  }
  Directions<float, N> trial = d;
  for (int i = 0; i < world.approach && error > world.q.approachError; ++i) {
    fabrik(leg, target, trial);
    const Vec3<float> reached = tipOf(leg, trial);
    const float e = length(target - reached);
    if (!(e < error)) continue;
    d = trial;
    tip = reached;
    error = e;
  }
  const float pull = world.chords > 0 && error < world.q.pullError ? world.q.restPull : 0;
  // If the step leads away, a short one in its place.
  const Tuning<float> tuning{pull, world.q.ikTolerance, world.chords};
  if (!activeSet(leg, target, tuning, 1.0f, d, tip, error))
    activeSet(leg, target, tuning, 256.0f, d, tip, error);
  store(leg, d, tip, error, chain);
}

}  // namespace skitter::cpu_crowd
