#ifndef SPLAT_GLSL
#define SPLAT_GLSL
// A pixel of splats holds a number: 16 bits of depth above 16 bits of colour, or of a shadow's strength. The nearest
// splat has the greatest number. 0 is no splat.

const float NEAR_PLANE = 0.05;  // metres: depth is that over the distance ahead (render/composition.cpp)
// Depth from here to 1, by its exponent and 12 bits of its mantissa: to 2.4e-4 of the
// distance, a fifth of a pixel.
const float LEAST_DEPTH = 1.0 / 65536.0;
const int DEPTH_SHIFT = 11, LOW_BITS = 16;
const vec3 COLOUR_STEPS = vec3(31.0, 63.0, 31.0);  // of roots
const float SHADE_STEPS = 65535.0;

uint packedDepth(float depth) {
  uint bits = floatBitsToUint(clamp(depth, 1.001 * LEAST_DEPTH, 0.9999)) - floatBitsToUint(LEAST_DEPTH);
  return bits >> DEPTH_SHIFT << LOW_BITS;
}
float depthOf(uint splat) { return uintBitsToFloat((splat >> LOW_BITS << DEPTH_SHIFT) + floatBitsToUint(LEAST_DEPTH)); }

uint packedColour(vec3 root) {
  uvec3 c = uvec3(clamp(root, 0.0, 1.0) * COLOUR_STEPS + 0.5);
  return c.x << 11 | c.y << 5 | c.z;
}
vec3 rootOf(uint splat) { return vec3(splat >> 11 & 31u, splat >> 5 & 63u, splat & 31u) / COLOUR_STEPS; }

uint packedShade(float strength) { return uint(strength * SHADE_STEPS); }
float shadeOf(uint splat) { return float(splat & 65535u) / SHADE_STEPS; }

#endif
