#pragma once

#include <cmath>
#include <cstdint>

#if defined(__AVX2__)
// GCC 12 takes the header's own "any value" for a value that was forgotten (GCC bug 105593).
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wuninitialized"
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#include <immintrin.h>
#pragma GCC diagnostic pop
#endif

// The types that a solver is written over: `float` is one chain, `Lanes` as many chains as a register holds
// floats, `Pair<V>` two independent V whose operations alternate, so that one's latency hides the other's.
// The compiler's own vectors carry the arithmetic: they have operators that it contracts to fused
// multiply-adds, need no library, and every machine has them; only what has no operator is an intrinsic.
namespace skitter::baseline {

// ---- one chain

inline float rsqrt(float x) { return 1 / std::sqrt(x); }
inline float squareRoot(float x) { return std::sqrt(x); }
inline float roundDown(float x) { return std::floor(x); }
inline float absolute(float x) { return std::fabs(x); }
inline float smaller(float a, float b) { return a < b ? a : b; }
inline float larger(float a, float b) { return a > b ? a : b; }
inline float select(bool mask, float yes, float no) { return mask ? yes : no; }
inline uint64_t bits(bool mask) { return mask; }

// ---- one register of chains

#if defined(__AVX512F__) && defined(__AVX512VL__)
inline constexpr int kLanes = 16;
#elif defined(__AVX2__)
inline constexpr int kLanes = 8;
#else
inline constexpr int kLanes = 4;
#endif

using RawFloats = float __attribute__((vector_size(4 * kLanes), may_alias));
using RawInts = int32_t __attribute__((vector_size(4 * kLanes), may_alias));

struct Lanes {
  RawFloats v;
  Lanes() = default;
  Lanes(RawFloats raw) : v(raw) {}
  Lanes(float one) : v(one - RawFloats{}) {}
};

inline Lanes operator+(Lanes a, Lanes b) { return a.v + b.v; }
inline Lanes operator-(Lanes a, Lanes b) { return a.v - b.v; }
inline Lanes operator*(Lanes a, Lanes b) { return a.v * b.v; }
inline Lanes operator/(Lanes a, Lanes b) { return a.v / b.v; }
inline Lanes operator-(Lanes a) { return -a.v; }
inline Lanes absolute(Lanes a) { return (RawFloats)((RawInts)a.v & 0x7fffffff); }

// The estimate has 11 to 14 bits; Newton's step doubles them.
inline Lanes refineRsqrt(Lanes x, Lanes y) { return y * (Lanes(1.5f) - (x * Lanes(0.5f)) * (y * y)); }

#if defined(__AVX512F__) && defined(__AVX512VL__)
struct LaneMask {
  __mmask16 m;
};
inline LaneMask operator<(Lanes a, Lanes b) { return {_mm512_cmp_ps_mask(a.v, b.v, _CMP_LT_OQ)}; }
inline LaneMask operator<=(Lanes a, Lanes b) { return {_mm512_cmp_ps_mask(a.v, b.v, _CMP_LE_OQ)}; }
inline LaneMask operator&(LaneMask a, LaneMask b) { return {_kand_mask16(a.m, b.m)}; }
inline LaneMask operator|(LaneMask a, LaneMask b) { return {_kor_mask16(a.m, b.m)}; }
inline LaneMask operator!(LaneMask a) { return {_knot_mask16(a.m)}; }
inline Lanes select(LaneMask m, Lanes yes, Lanes no) { return _mm512_mask_blend_ps(m.m, no.v, yes.v); }
inline uint64_t bits(LaneMask m) { return m.m; }
inline Lanes smaller(Lanes a, Lanes b) { return _mm512_min_ps(a.v, b.v); }
inline Lanes larger(Lanes a, Lanes b) { return _mm512_max_ps(a.v, b.v); }
inline Lanes rsqrt(Lanes x) { return refineRsqrt(x, _mm512_rsqrt14_ps(x.v)); }
inline Lanes roundDown(Lanes x) {
  return _mm512_roundscale_ps(x.v, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC);
}
#else
struct LaneMask {
  RawInts m;
};
inline LaneMask operator<(Lanes a, Lanes b) { return {a.v < b.v}; }
inline LaneMask operator<=(Lanes a, Lanes b) { return {a.v <= b.v}; }
inline LaneMask operator&(LaneMask a, LaneMask b) { return {a.m & b.m}; }
inline LaneMask operator|(LaneMask a, LaneMask b) { return {a.m | b.m}; }
inline LaneMask operator!(LaneMask a) { return {~a.m}; }
#if defined(__AVX2__)
inline Lanes select(LaneMask m, Lanes yes, Lanes no) { return _mm256_blendv_ps(no.v, yes.v, (__m256)m.m); }
inline uint64_t bits(LaneMask m) { return unsigned(_mm256_movemask_ps((__m256)m.m)); }
inline Lanes smaller(Lanes a, Lanes b) { return _mm256_min_ps(a.v, b.v); }
inline Lanes larger(Lanes a, Lanes b) { return _mm256_max_ps(a.v, b.v); }
inline Lanes rsqrt(Lanes x) { return refineRsqrt(x, _mm256_rsqrt_ps(x.v)); }
inline Lanes roundDown(Lanes x) { return _mm256_floor_ps(x.v); }
#else
inline Lanes select(LaneMask m, Lanes yes, Lanes no) { return m.m ? yes.v : no.v; }
inline uint64_t bits(LaneMask m) {
  uint64_t all = 0;
  for (int i = 0; i < kLanes; ++i) all |= uint64_t(m.m[i] & 1) << i;
  return all;
}
inline Lanes smaller(Lanes a, Lanes b) { return a.v < b.v ? a.v : b.v; }
inline Lanes larger(Lanes a, Lanes b) { return a.v > b.v ? a.v : b.v; }
inline Lanes rsqrt(Lanes x) {
  RawFloats y;
  for (int i = 0; i < kLanes; ++i) y[i] = 1 / std::sqrt(x.v[i]);
  return y;
}
inline Lanes roundDown(Lanes x) {
  RawFloats y;
  for (int i = 0; i < kLanes; ++i) y[i] = std::floor(x.v[i]);
  return y;
}
#endif
#endif

inline Lanes squareRoot(Lanes x) { return x * rsqrt(larger(x, 1e-30f)); }

// ---- two of them

template <class V>
struct Pair;
template <class V>
struct PairMask;

template <class V>
struct MaskOf {
  using Type = bool;
};
template <>
struct MaskOf<Lanes> {
  using Type = LaneMask;
};
template <class V>
struct MaskOf<Pair<V>> {
  using Type = PairMask<V>;
};

// What comparing two V gives.
template <class V>
using Mask = typename MaskOf<V>::Type;

// Chains in a V.
template <class V>
inline constexpr int kWidth = sizeof(V) / sizeof(float);

template <class V>
struct PairMask {
  Mask<V> a, b;
  friend PairMask operator&(PairMask x, PairMask y) { return {x.a & y.a, x.b & y.b}; }
  friend PairMask operator|(PairMask x, PairMask y) { return {x.a | y.a, x.b | y.b}; }
  friend PairMask operator!(PairMask x) { return {!x.a, !x.b}; }
  friend uint64_t bits(PairMask x) { return bits(x.a) | bits(x.b) << kWidth<V>; }
};

template <class V>
struct Pair {
  V a, b;
  Pair() = default;
  Pair(V first, V second) : a(first), b(second) {}
  Pair(float one) : a(one), b(one) {}

  friend Pair operator+(Pair x, Pair y) { return {x.a + y.a, x.b + y.b}; }
  friend Pair operator-(Pair x, Pair y) { return {x.a - y.a, x.b - y.b}; }
  friend Pair operator*(Pair x, Pair y) { return {x.a * y.a, x.b * y.b}; }
  friend Pair operator/(Pair x, Pair y) { return {x.a / y.a, x.b / y.b}; }
  friend Pair operator-(Pair x) { return {-x.a, -x.b}; }
  friend PairMask<V> operator<(Pair x, Pair y) { return {x.a < y.a, x.b < y.b}; }
  friend PairMask<V> operator<=(Pair x, Pair y) { return {x.a <= y.a, x.b <= y.b}; }
  friend Pair absolute(Pair x) { return {absolute(x.a), absolute(x.b)}; }
  friend Pair rsqrt(Pair x) { return {rsqrt(x.a), rsqrt(x.b)}; }
  friend Pair squareRoot(Pair x) { return {squareRoot(x.a), squareRoot(x.b)}; }
  friend Pair roundDown(Pair x) { return {roundDown(x.a), roundDown(x.b)}; }
  friend Pair smaller(Pair x, Pair y) { return {smaller(x.a, y.a), smaller(x.b, y.b)}; }
  friend Pair larger(Pair x, Pair y) { return {larger(x.a, y.a), larger(x.b, y.b)}; }
  friend Pair select(PairMask<V> mask, Pair yes, Pair no) {
    return {select(mask.a, yes.a, no.a), select(mask.b, yes.b, no.b)};
  }
};

template <class V>
bool any(V mask) {
  return bits(mask) != 0;
}

// One chain's value among those in `values`; `values` lies in memory.
template <class V>
float& lane(V& values, int i) {
  return reinterpret_cast<float*>(&values)[i];
}
template <class V>
float lane(const V& values, int i) {
  return reinterpret_cast<const float*>(&values)[i];
}

}  // namespace skitter::baseline
