#ifndef SPLIT_MIX_GLSL
#define SPLIT_MIX_GLSL
// SplitMix64 (Steele, Lea and Flood 2014) by numbers of 32 bits, low half first: the same draws as
// engine/base/split_mix.h, on devices without integers of 64 bits.

uvec2 product64(uvec2 a, uvec2 b) {
  uint high, low;
  umulExtended(a.x, b.x, high, low);
  return uvec2(low, high + a.x * b.y + a.y * b.x);
}

// z ^ (z >> count), count less than 32.
uvec2 xorShifted(uvec2 z, int count) {
  return z ^ uvec2((z.x >> count) | (z.y << (32 - count)), z.y >> count);
}

// The nth draw, counted from 1, of a generator with this seed.
uvec2 splitMixDraw(uvec2 seed, uint n) {
  uint carry;
  uvec2 step = product64(uvec2(0x7F4A7C15u, 0x9E3779B9u), uvec2(n, 0u)), z;
  z.x = uaddCarry(seed.x, step.x, carry);
  z.y = seed.y + step.y + carry;
  z = product64(xorShifted(z, 30), uvec2(0x1CE4E5B9u, 0xBF58476Du));
  z = product64(xorShifted(z, 27), uvec2(0x133111EBu, 0x94D049BBu));
  return xorShifted(z, 31);
}

#endif
