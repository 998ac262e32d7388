#ifndef HASH_GLSL
#define HASH_GLSL

uint hashed(uvec2 p) {
  uint h = p.x * 0x9E3779B1u ^ p.y * 0x85EBCA77u;
  h ^= h >> 15;
  h *= 0x2C1B3C6Du;
  h ^= h >> 13;
  return h;
}
float unitOf(uint h) { return float(h >> 8) * (1.0 / 16777216.0); }

#endif
