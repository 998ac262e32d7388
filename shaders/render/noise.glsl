#ifndef NOISE_GLSL
#define NOISE_GLSL

uint hashed(uvec2 p) {
  uint h = p.x * 0x9E3779B1u ^ p.y * 0x85EBCA77u;
  h ^= h >> 15;
  h *= 0x2C1B3C6Du;
  h ^= h >> 13;
  return h;
}
float unitOf(uint h) { return float(h >> 8) * (1.0 / 16777216.0); }

// Value noise in -1..1 and its gradient (value, d/dx, d/dy).
vec3 noise(vec2 p) {
  vec2 cell = floor(p), f = p - cell;
  uvec2 i = uvec2(ivec2(cell));
  float a = unitOf(hashed(i)), b = unitOf(hashed(i + uvec2(1, 0)));
  float c = unitOf(hashed(i + uvec2(0, 1))), d = unitOf(hashed(i + uvec2(1, 1)));
  vec2 s = f * f * (3.0 - 2.0 * f), slope = 6.0 * f * (1.0 - f);
  float k = a - b - c + d;
  return vec3(2.0 * (a + (b - a) * s.x + (c - a) * s.y + k * s.x * s.y) - 1.0,
              2.0 * slope * vec2(b - a + k * s.y, c - a + k * s.x));
}

#endif
