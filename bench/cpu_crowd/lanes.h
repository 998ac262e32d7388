#pragma once

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

#include "bench/cpu_baseline/lane_vector.h"

namespace skitter::cpu_crowd {

// The lane types and their operations: F is float, Lanes or a Pair.
using namespace baseline;
using baseline::broadcast, baseline::dot, baseline::select;  // which have more overloads here

template <class F>
F reciprocal(const F& x) {
  return F(1) / x;
}
template <class F>
F clamp(const F& x, float low, float high) {
  return smaller(larger(x, low), high);
}
template <class F>
F mix(const F& a, const F& b, const F& share) {
  return a + (b - a) * share;
}
template <class F>
Vec3<F> mix(const Vec3<F>& a, const Vec3<F>& b, const F& share) {
  return a + (b - a) * share;
}

// 1 in the lanes of the set, else 0.
template <class F>
struct Flags {
  static F of(uint64_t set) {
    F flag;
    for (int i = 0; i < kWidth<F>; ++i) lane(flag, i) = float(set >> i & 1);
    return flag;
  }
};
#if defined(__AVX512F__) && defined(__AVX512VL__)
template <>
struct Flags<Lanes> {
  static Lanes of(uint64_t set) { return _mm512_maskz_mov_ps(__mmask16(set), Lanes(1).v); }
};
#endif
template <>
struct Flags<float> {
  static float of(uint64_t set) { return float(int(set & 1)); }
};
template <class V>
struct Flags<Pair<V>> {
  static Pair<V> of(uint64_t set) { return {Flags<V>::of(set), Flags<V>::of(set >> kWidth<V>)}; }
};
template <class F>
F flags(uint64_t set) {
  return Flags<F>::of(set);
}

// table[index] of each lane; indices are whole numbers.
inline float gather(const float* table, float index) { return table[size_t(index)]; }
inline Lanes gather(const float* table, Lanes index) {
#if defined(__AVX512F__) && defined(__AVX512VL__)
  return _mm512_i32gather_ps(_mm512_cvttps_epi32(index.v), table, 4);
#else
  Lanes found;
  for (int i = 0; i < kLanes; ++i) lane(found, i) = table[size_t(index.v[i])];
  return found;
#endif
}
template <class V>
Pair<V> gather(const float* table, const Pair<V>& index) {
  return {gather(table, index.a), gather(table, index.b)};
}

// Stores what is not read again soon past the caches, which then need not fetch the line. settleStreams()
// comes before another thread is told.
inline void stream(float* to, float value) { *to = value; }
inline void stream(Lanes* to, Lanes value) {
#if defined(__AVX512F__) && defined(__AVX512VL__)
  _mm512_stream_ps(reinterpret_cast<float*>(to), value.v);
#elif defined(__AVX2__)
  _mm256_stream_ps(reinterpret_cast<float*>(to), value.v);
#else
  *to = value;
#endif
}
inline void settleStreams() {
#if defined(__SSE__)
  _mm_sfence();
#endif
}
template <class V>
void stream(Pair<V>* to, const Pair<V>& value) {
  stream(&to->a, value.a);
  stream(&to->b, value.b);
}

// What lane i of `from` holds goes into lane j of `to`: structures of F alone, or of as many floats.
template <class F, class G, class From, class To>
void copyLane(const From& from, int i, To& to, int j) {
  constexpr size_t kRows = sizeof(From) / sizeof(F);
  static_assert(kRows == sizeof(To) / sizeof(G));
  const float* source = reinterpret_cast<const float*>(&from) + i;
  float* target = reinterpret_cast<float*>(&to) + j;
  for (size_t row = 0; row < kRows; ++row) target[row * kWidth<G>] = source[row * kWidth<F>];
}

}  // namespace skitter::cpu_crowd
