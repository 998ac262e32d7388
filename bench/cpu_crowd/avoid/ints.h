#pragma once

#include <cstdint>
#include <cstring>

#include "bench/cpu_crowd/lanes.h"

// Whole numbers beside the lane types: distances are compared in them, exactly.
namespace skitter::cpu_avoid {

using namespace cpu_crowd;
using baseline::select;

using RawWholes = uint32_t __attribute__((vector_size(4 * kLanes), may_alias));

// Modulo 2^32, as the compiler's vectors of unsigned numbers are.
struct IntLanes {
  RawWholes v;
  IntLanes() = default;
  IntLanes(RawWholes raw) : v(raw) {}
  IntLanes(int32_t one) : v(static_cast<uint32_t>(one) - RawWholes{}) {}
};
inline IntLanes operator+(IntLanes a, IntLanes b) { return a.v + b.v; }
inline IntLanes operator-(IntLanes a, IntLanes b) { return a.v - b.v; }
inline IntLanes operator*(IntLanes a, IntLanes b) { return a.v * b.v; }
inline IntLanes operator^(IntLanes a, IntLanes b) { return a.v ^ b.v; }

template <class F>
struct IntsOf {
  using Type = int32_t;
};
template <>
struct IntsOf<Lanes> {
  using Type = IntLanes;
};
template <class F>
using Ints = typename IntsOf<F>::Type;

inline float toFloats(int32_t a) { return static_cast<float>(a); }
inline Lanes toFloats(IntLanes a) { return __builtin_convertvector((RawInts)a.v, RawFloats); }

// Those of a V that lie one after another from `from` on.
template <class V, class T>
V load(const T* from) {
  V values;
  std::memcpy(&values, from, sizeof values);
  return values;
}

// table[at] of each lane.
inline float lookUp(const float* table, int32_t at) { return table[at]; }
inline int32_t lookUp(const int32_t* table, int32_t at) { return table[at]; }
inline Lanes lookUp(const float* table, IntLanes at) {
#if defined(__AVX512F__) && defined(__AVX512VL__)
  return (RawFloats)_mm512_i32gather_ps((__m512i)at.v, table, 4);
#elif defined(__AVX2__)
  return (RawFloats)_mm256_i32gather_ps(table, (__m256i)at.v, 4);
#else
  RawFloats found;
  for (int i = 0; i < kLanes; ++i) found[i] = table[at.v[i]];
  return found;
#endif
}
inline IntLanes lookUp(const int32_t* table, IntLanes at) {
#if defined(__AVX512F__) && defined(__AVX512VL__)
  return (RawWholes)_mm512_i32gather_epi32((__m512i)at.v, table, 4);
#elif defined(__AVX2__)
  return (RawWholes)_mm256_i32gather_epi32(table, (__m256i)at.v, 4);
#else
  RawWholes found;
  for (int i = 0; i < kLanes; ++i) found[i] = static_cast<uint32_t>(table[at.v[i]]);
  return found;
#endif
}

// Whether a < b, of numbers from 0 to 2^32 - 1.
inline bool isBelow(int32_t a, int32_t b) { return static_cast<uint32_t>(a) < static_cast<uint32_t>(b); }
inline LaneMask isBelow(IntLanes a, IntLanes b) {
#if defined(__AVX512F__) && defined(__AVX512VL__)
  return {_mm512_cmplt_epu32_mask((__m512i)a.v, (__m512i)b.v)};
#else
  return {(RawInts)(a.v < b.v)};
#endif
}

// The lanes in which a <= b, a bit each; of numbers from 0 to 2^32 - 1.
inline uint64_t atMost(IntLanes a, IntLanes b) {
#if defined(__AVX512F__) && defined(__AVX512VL__)
  return _mm512_cmple_epu32_mask((__m512i)a.v, (__m512i)b.v);
#else
  return bits(LaneMask{(RawInts)(a.v <= b.v)});
#endif
}

// The lanes of the set, one after another from `to` on, where there is room for a whole register.
inline void storeSet(int32_t* to, uint64_t set, IntLanes values) {
#if defined(__AVX512F__) && defined(__AVX512VL__)
  // Zen 4 takes ten times as long to compress into memory as to compress and store.
  _mm512_storeu_si512(to, _mm512_maskz_compress_epi32(static_cast<__mmask16>(set), (__m512i)values.v));
#else
  for (; set != 0; set &= set - 1) *to++ = static_cast<int32_t>(values.v[__builtin_ctzll(set)]);
#endif
}

// 0, 1, 2 and so on.
inline IntLanes countUp() {
  RawWholes numbers{};
  for (int i = 0; i < kLanes; ++i) numbers[i] = static_cast<uint32_t>(i);
  return numbers;
}

}  // namespace skitter::cpu_avoid
