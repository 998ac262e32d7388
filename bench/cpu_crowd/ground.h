#pragma once

#include "bench/cpu_crowd/layout.h"
#include "bench/cpu_crowd/rig.h"

namespace skitter::cpu_crowd {

// Heights at the corners of a cell, and the cell of column i and row j, both whole numbers.
template <class F>
struct Corners {
  F h00, h10, h01, h11;
};

inline Corners<float> cornersOf(const Terrain& t, float i, float j) {
  const float* h = t.heights.data() + size_t(j) * size_t(t.columns) + size_t(i);
  return {h[0], h[1], h[t.columns], h[t.columns + 1]};
}
#if defined(__AVX512F__) && defined(__AVX512VL__)
// Two neighbours at a time: gathers take as long as there are elements.
inline Corners<Lanes> cornersOf(const Terrain& t, Lanes i, Lanes j) {
  const __m512i at = _mm512_add_epi32(
      _mm512_mullo_epi32(_mm512_cvttps_epi32(j.v), _mm512_set1_epi32(t.columns)), _mm512_cvttps_epi32(i.v));
  const __m256i low = _mm512_castsi512_si256(at), high = _mm512_extracti64x4_epi64(at, 1);
  const __m512i even = _mm512_setr_epi32(0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30);
  const __m512i odd = _mm512_add_epi32(even, _mm512_set1_epi32(1));
  const auto row = [&](const float* h, Lanes& left, Lanes& right) {
    const __m512 a = _mm512_castpd_ps(_mm512_i32gather_pd(low, h, 4));
    const __m512 b = _mm512_castpd_ps(_mm512_i32gather_pd(high, h, 4));
    left = _mm512_permutex2var_ps(a, even, b);
    right = _mm512_permutex2var_ps(a, odd, b);
  };
  Corners<Lanes> corners;
  row(t.heights.data(), corners.h00, corners.h10);
  row(t.heights.data() + t.columns, corners.h01, corners.h11);
  return corners;
}
#else
inline Corners<Lanes> cornersOf(const Terrain& t, Lanes i, Lanes j) {
  Corners<Lanes> all;
  for (int k = 0; k < kLanes; ++k) copyLane<float, Lanes>(cornersOf(t, i.v[k], j.v[k]), 0, all, k);
  return all;
}
#endif
template <class V>
Corners<Pair<V>> cornersOf(const Terrain& t, Pair<V> i, Pair<V> j) {
  const Corners<V> a = cornersOf(t, i.a, j.a), b = cornersOf(t, i.b, j.b);
  return {{a.h00, b.h00}, {a.h10, b.h10}, {a.h01, b.h01}, {a.h11, b.h11}};
}

template <class F>
struct Ground {
  F height, slopeX, slopeZ;
};

// docs/stages.md, heightAt; x and z in the world, metres.
template <class F>
Ground<F> groundAt(const Terrain& t, const F& x, const F& z) {
  const F u = clamp((x - t.originX) * t.inverseSpacingX, 0, float(t.columns - 1));
  const F v = clamp((z - t.originZ) * t.inverseSpacingZ, 0, float(t.rows - 1));
  const F i = smaller(roundDown(u), float(t.columns - 2)), j = smaller(roundDown(v), float(t.rows - 2));
  const F a = u - i, b = v - j;
  const Corners<F> c = cornersOf(t, i, j);
  const F g0 = c.h10 - c.h00, g1 = c.h11 - c.h01;
  const F h0 = c.h00 + g0 * a, h1 = c.h01 + g1 * a;
  return {mix(h0, h1, b), mix(g0, g1, b) * t.inverseSpacingX, (h1 - h0) * t.inverseSpacingZ};
}

}  // namespace skitter::cpu_crowd
