#ifndef NOISE_GLSL
#define NOISE_GLSL

// Turns the world into the noise's own axes, so that its lattice shows neither in level ground nor in a wall.
const mat3 NOISE_AXES = mat3(0.1415, -0.5751, 0.8057, -0.3286, -0.7951, -0.5098, 0.9338, -0.1926, -0.3015);

// -1..1
float latticeValue(uint h) {
  return float(int((h ^ h >> 15) * 0x2C1B3C6Du)) * (1.0 / 2147483648.0);
}

// Value noise in -1..1 and its gradient (value, d/dx, d/dy, d/dz). It is a function of the place in space, so
// that it lies on a wall as it does on level ground.
vec4 noise(vec3 p) {
  vec3 cell = floor(p), f = p - cell;
  uvec3 low = uvec3(ivec3(cell)) * uvec3(0x9E3779B1u, 0x85EBCA77u, 0xC2B2AE3Du);
  uvec3 high = low + uvec3(0x9E3779B1u, 0x85EBCA77u, 0xC2B2AE3Du);
  uint ll = low.x + low.y, hl = high.x + low.y, lh = low.x + high.y, hh = high.x + high.y;
  vec4 near = vec4(latticeValue(ll + low.z), latticeValue(hl + low.z), latticeValue(lh + low.z),
                   latticeValue(hh + low.z));
  vec4 alongZ = vec4(latticeValue(ll + high.z), latticeValue(hl + high.z), latticeValue(lh + high.z),
                     latticeValue(hh + high.z)) - near;
  vec3 s = f * f * (3.0 - 2.0 * f), slope = 6.0 * f * (1.0 - f);
  vec4 level = near + alongZ * s.z;
  vec2 alongY = level.zw - level.xy, row = level.xy + alongY * s.y;
  vec2 rowZ = mix(alongZ.xy, alongZ.zw, s.y);
  float alongX = row.y - row.x;
  return vec4(row.x + alongX * s.x,
              slope * vec3(alongX, mix(alongY.x, alongY.y, s.x), mix(rowZ.x, rowZ.y, s.x)));
}

// Detail as long as a pixel is smaller than it.
float visible(float wavelength, float footprint) {
  return clamp(2.0 - 5.0 * footprint / wavelength, 0.0, 1.0);
}

#endif
