#pragma once

#include "bench/cpu_crowd/leg_solver.h"

namespace skitter::cpu_crowd {

template <class F>
void stream(BonePose<F>* to, const Quaternion<F>& rotation, const Vec3<F>& position) {
  stream(&to->rotation.x, rotation.x);
  stream(&to->rotation.y, rotation.y);
  stream(&to->rotation.z, rotation.z);
  stream(&to->rotation.w, rotation.w);
  stream(&to->position.x, position.x);
  stream(&to->position.y, position.y);
  stream(&to->position.z, position.z);
}

// `poses`: the leg's bones, padded to as many as the longest leg has.
template <class F, int N>
[[gnu::flatten]] void pose(const LegModel& leg, int padded, const Agent<F>& a, const Mat3<F>& r,
                           const Chain<F, kBones<N>>& chain, BonePose<F>* poses) {
  Quaternion<F> q = a.orientation;
  Vec3<F> p = r * broadcast<F>(leg.root);
  const int n = boneCountOf<N>(leg);
  for (int i = 0; i < n; ++i) {
    const BoneModel& bone = leg.bones[i];
    const F x = chain.x[i], y = chain.y[i], scale = rsqrt(x * x + y * y + 1.0f);
    const Vec3<F> axis = (broadcast<F>(bone.restY) * x - broadcast<F>(bone.restX) * y) * scale;
    q = product(q, {axis.x, axis.y, axis.z, scale});
    stream(poses + i, q, p);
    p = p + rotated(q, bone.rest) * (bone.length * leg.reach);
  }
  for (int i = n; i < padded; ++i) stream(poses + i, q, p);
}

}  // namespace skitter::cpu_crowd
